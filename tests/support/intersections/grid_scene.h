/* Small meshes with integer coordinates, so few of them that everything degenerates, how they are moved, and their
 * piercings and winding numbers by brute force: all by polynomials in epsilon. */
#pragma once

#include "cscd/surface.h"
#include "runtime/intersections/intersections.h"
#include "runtime/intersections/named_surface.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <stdint.h>

/* Polynomials in an infinitely small epsilon with integer coefficients: the moved coordinates of docs/theory/curves.md,
 * written out. They share nothing with src/mesh/symbolic.c but the definition. */
enum { EPSILON_TERMS = 1024, EPSILON_NAMES = 20 };

/* The sum of coefficient * epsilon^power, powers ascending, no coefficient 0. */
typedef struct epsilon_polynomial {
    int count;
    struct {
        uint64_t power;
        int64_t coefficient;
    } terms[EPSILON_TERMS];
} epsilon_polynomial;

/* A point with small integer coordinates, and a name below EPSILON_NAMES. */
typedef struct grid_point {
    int x[3];
    uint32_t name;
} grid_point;

/* A point whose coordinates are polynomials. */
typedef struct epsilon_point {
    epsilon_polynomial x[3];
} epsilon_point;

/* The moved point. */
void epsilon_move(grid_point p, epsilon_point *out);

/* Adds epsilon^power * factor * p to sum; the two are different. */
void epsilon_add(epsilon_polynomial *sum, const epsilon_polynomial *p, int factor, uint64_t power);

/* (b - a) x (c - a) . (d - a). */
void epsilon_orient3d(const epsilon_point *const p[4], epsilon_polynomial *out);

/* (b - a) x (c - a) in the projection along an axis. */
void epsilon_orient_along(const epsilon_point *const p[3], int axis, epsilon_polynomial *out);

/* The same of grid points, moved. */
void grid_orient3d(const grid_point p[4], epsilon_polynomial *out);
void grid_orient_along(const grid_point p[3], int axis, epsilon_polynomial *out);

/* The sign for all small enough epsilon > 0. */
int epsilon_sign(const epsilon_polynomial *p);

/* ---- scenes -------------------------------------------------------------------------------------------- */

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

/* ---- their curves -------------------------------------------------------------------------------------- */

enum { TRACED_PAIRS_MAX = 32 * 32 };

typedef struct traced_scene {
    grid_scene scene;
    curve_joiner joiner;
    cscd_intersection pairs[TRACED_PAIRS_MAX];
    cscd_curves curves;
} traced_scene;

void traced_scene_make(grid_family family, uint64_t seed, traced_scene *out);
void traced_scene_free(traced_scene *t);

/* ---- piercings by brute force -------------------------------------------------------------------------- */

/* Does the edge pass through the triangle, without a common vertex? */
bool piercing_oracle_happens(const grid_scene *s, surface_piercing piercing);

/* The limits of s, u, v and of the point: numerators and one denominator of each kind. */
typedef struct exact_piercing_point {
    int64_t s, s_sum;     /* s / s_sum */
    int64_t u, v, uv_sum; /* u / uv_sum, v / uv_sum */
    int64_t x[3];         /* x[k] / s_sum */
} exact_piercing_point;

exact_piercing_point piercing_oracle_point(const grid_scene *s, surface_piercing piercing);

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* So many vertices leave powers of epsilon for the point. */
enum { WINDING_NAMES = 14 };

/* The winding number of an object at the point, whose scene has no more vertices than that. */
int winding_oracle_number(const grid_scene *s, corner_side at, uint32_t object);
