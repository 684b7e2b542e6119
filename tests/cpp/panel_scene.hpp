/* A C++ program's scene: two wavy panels, whose particles are structs with floats, and a closed body. One panel passes
 * through the other. */
#pragma once

#include <cscd/cscd.hpp>

#include <cmath>
#include <cstring>
#include <vector>

struct vec3 {
    float x, y, z;
};

struct particle {
    float mass;
    vec3 position, velocity;
};

using triple = std::array<std::uint32_t, 3>;

struct panel_scene {
    std::uint32_t side;
    std::vector<triple> triangles;   /* of one panel */
    std::vector<particle> particles; /* of both; velocity is the motion of the interval */

    explicit panel_scene(std::uint32_t of_side) : side(of_side) {
        list_triangles();
        place_panel(0.0f, 0.0f, 0.0f);
        place_panel(0.31f, 2.0f, -3.0f);
    }
    std::uint32_t half() const {
        return side * side;
    }
    std::vector<cscd_object_desc> objects() const {
        const cscd_object_desc panel = cscd::object_of_triangles(half(), triangles);
        return {panel, panel};
    }
    std::vector<particle> moved() const {
        std::vector<particle> all = particles;
        for (particle &p : all) p.position.z += p.velocity.z;
        return all;
    }

  private:
    void list_triangles() {
        for (std::uint32_t i = 0; i + 1 < side; i++) {
            for (std::uint32_t j = 0; j + 1 < side; j++) {
                const std::uint32_t k = i * side + j;
                triangles.push_back({k, k + side, k + 1});
                triangles.push_back({k + 1, k + side, k + side + 1});
            }
        }
    }
    void place_panel(float shift, float z, float velocity) {
        for (std::uint32_t i = 0; i < side; i++) {
            for (std::uint32_t j = 0; j < side; j++) {
                const float wave = 0.3f * std::sin(1.7f * static_cast<float>(i) + static_cast<float>(j));
                particles.push_back(
                    {1.0f,
                     {static_cast<float>(i) + shift, static_cast<float>(j) + 0.6f * shift, z + wave},
                     {0.0f, 0.0f, velocity}});
            }
        }
    }
};

/* The packed floats of a scene's positions. */
inline std::vector<float> packed(const std::vector<particle> &particles) {
    std::vector<float> all;
    for (const particle &p : particles) all.insert(all.end(), {p.position.x, p.position.y, p.position.z});
    return all;
}

/* Two tetrahedra, one above the other, as two components of one object. */
inline const std::vector<triple> body_triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3},
                                                {4, 6, 5}, {4, 5, 7}, {5, 6, 7}, {6, 4, 7}};
inline const std::vector<double> body_positions{0, 0, 0,  4, 0, 0,  0, 4, 0,  0, 0, 4,
                                                1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};

/* Of two lists: the same pairs at the same times. */
inline bool same_contacts(cscd::span<const cscd_contact> a, cscd::span<const cscd_contact> b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); i++) {
        if (a[i].kind != b[i].kind || a[i].a != b[i].a || a[i].b != b[i].b) return false;
        if (std::memcmp(&a[i].toi, &b[i].toi, sizeof a[i].toi) != 0) return false;
    }
    return true;
}
