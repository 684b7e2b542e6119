/* The scene: two panels of cloth, sewn together along a seam and held at their far sides, a ball that falls on them, and a
 * floor that sways. All particles are structs with floats, in one array. */
#pragma once

#include "models/panels/vec3.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace panels {

struct particle {
    vec3 position, velocity, rest;
    float inverse_mass; /* 0: it is held, or belongs to the floor */
};

using triple = std::array<std::uint32_t, 3>;
using pair = std::array<std::uint32_t, 2>;

/* What one object is made of, by its own vertices. */
struct object {
    std::vector<vec3> points;
    std::vector<triple> triangles;
};

/* A length that is kept. */
struct spring {
    std::uint32_t a, b;
    float length;
};

enum object_name : std::uint32_t { LEFT_PANEL, RIGHT_PANEL, BALL, FLOOR, OBJECTS };

/* In metres; cloth and what is near it keep this distance. */
constexpr float separation = 0.01f;

struct scene {
    std::array<object, OBJECTS> objects;
    std::array<std::uint32_t, OBJECTS + 1> first; /* vertex of each object; and their number */
    std::vector<particle> particles;
    std::vector<pair> seams;
    std::vector<spring> springs;  /* of the panels */
    std::vector<vec3> ball_shape; /* seen from its centre */
};

/* side: squares along a panel's side. */
scene make_scene(std::uint32_t side);

/* What a tear has done to a panel. */
struct tear {
    std::vector<std::uint32_t> origins; /* which vertex of the panel each one was */
    std::vector<pair> sides;            /* vertices of the panel that were one: towards -y, and towards y */
};

/* Tears the right panel in its middle, from the seam two thirds of the way to its held side. Its vertices are more then,
 * and the caller places the particles anew. */
tear tear_panel(scene &s);

/* Numbers the vertices of all objects, and makes the springs of the panels from the particles' rest. */
void number_vertices(scene &s);
void make_springs(scene &s);

/* How far the floor is from its place after so many seconds. */
vec3 floor_sway(float seconds);

} // namespace panels
