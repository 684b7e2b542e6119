/* Small meshes with integer coordinates, so few of them that everything degenerates. */
#pragma once

#include "cscd/surface.h"
#include "runtime/intersections/named_surface.h"
#include "tests/support/intersections/epsilon_polynomial.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

/* What meshes a scene has. Those before the sheet are closed manifolds with an orientation. */
typedef enum grid_family {
    GRID_TWO_TETRAHEDRA, /* anywhere */
    GRID_TWO_BOXES,      /* axis-aligned */
    GRID_BOX_AND_OCTAHEDRON,
    GRID_OCTAHEDRON, /* with any corners, so that it crosses itself */
    GRID_TORUS,      /* the same */
    GRID_PILLOW,     /* two triangles with the same vertices, and an octahedron */
    GRID_SHEET,
    GRID_MOEBIUS_STRIP,
    GRID_KLEIN_BOTTLE, /* closed, without an orientation */
    GRID_SOUP,         /* any triangles of a few vertices */
    GRID_SEWN,         /* two sheets with a seam, whose vertices lie at one place */
    GRID_FAMILIES
} grid_family;

enum { GRID_OBJECTS = 2 };

typedef struct grid_scene {
    mesh_shape shapes[GRID_OBJECTS];
    uint32_t object_count, vertex_count;
    double positions[EPSILON_NAMES * 3];
    uint32_t names[EPSILON_NAMES];
    cscd_context *context;
    cscd_mesh *mesh;
    named_surface surface;
} grid_scene;

static inline bool grid_family_is_closed(grid_family family) {
    return family < GRID_SHEET;
}

/* Makes a scene, with its mesh; the same seed gives the same one. */
void grid_scene_make(grid_family family, uint64_t seed, grid_scene *out);
void grid_scene_free(grid_scene *s);

/* A vertex of the scene. */
grid_point grid_scene_point(const grid_scene *s, uint32_t vertex);

/* Writes all pairs of triangles that intersect, by trying each; room for as many as there are. Returns their number. */
size_t grid_scene_pairs(const grid_scene *s, cscd_intersection *out);
