/* Piercings and winding numbers of a small scene by brute force, in polynomials in epsilon. */
#include "tests/support/intersections/epsilon_oracle.h"

#include "tests/support/test.h"

#include <assert.h>
#include <stdlib.h>

/* The edge's points, then the triangle's. */
static void load_points(const grid_scene *s, surface_piercing piercing, grid_point out[5]) {
    const uint32_t *edge = s->mesh->edges[piercing.edge], *triangle = s->mesh->triangles[piercing.triangle];
    for (int i = 0; i < 5; i++) out[i] = grid_scene_point(s, i < 2 ? edge[i] : triangle[i - 2]);
}

static void orient_points(const grid_point p[5], int a, int b, int c, int d, epsilon_polynomial *out) {
    const grid_point corners[4] = {p[a], p[b], p[c], p[d]};
    grid_orient3d(corners, out);
}

static int side_of(const grid_point p[5], int a, int b, int c, int d) {
    epsilon_polynomial value;
    orient_points(p, a, b, c, d, &value);
    return epsilon_sign(&value);
}

bool piercing_oracle_happens(const grid_scene *s, surface_piercing piercing) {
    grid_point p[5];
    load_points(s, piercing, p);
    for (int i = 0; i < 5; i++) {
        for (int j = i + 1; j < 5; j++) {
            if (p[i].name == p[j].name) return false;
        }
    }
    if (side_of(p, 2, 3, 4, 0) == side_of(p, 2, 3, 4, 1)) return false;
    int turn = side_of(p, 0, 1, 2, 3);
    return turn == side_of(p, 0, 1, 3, 4) && turn == side_of(p, 0, 1, 4, 2);
}

/* The coefficients that count in the limit: those with the least power of all. */
static void find_limits(const epsilon_polynomial *values, int count, int64_t *out) {
    uint64_t least = UINT64_MAX;
    for (int i = 0; i < count; i++) {
        if (values[i].terms[0].power < least) least = values[i].terms[0].power;
    }
    for (int i = 0; i < count; i++)
        out[i] = values[i].terms[0].power == least ? llabs(values[i].terms[0].coefficient) : 0;
}

exact_piercing_point piercing_oracle_point(const grid_scene *s, surface_piercing piercing) {
    grid_point p[5];
    epsilon_polynomial values[3];
    int64_t weights[3];
    load_points(s, piercing, p);
    orient_points(p, 2, 3, 4, 1, &values[0]);
    orient_points(p, 2, 3, 4, 0, &values[1]);
    find_limits(values, 2, weights);
    exact_piercing_point at = {.s = weights[1], .s_sum = weights[0] + weights[1]};
    for (int k = 0; k < 3; k++) at.x[k] = weights[0] * p[0].x[k] + weights[1] * p[1].x[k];
    for (int i = 0; i < 3; i++) orient_points(p, 0, 1, 2 + (i + 1) % 3, 2 + (i + 2) % 3, &values[i]);
    find_limits(values, 3, weights);
    at.u = weights[1];
    at.v = weights[2];
    at.uv_sum = weights[0] + weights[1] + weights[2];
    return at;
}

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* A step has epsilon to this power, and the next one this power once more: less than anything that moves vertices. */
static const uint64_t STEP = UINT64_C(1) << (3 * WINDING_NAMES + 1);

static void subtract_points(const epsilon_point *from, const epsilon_point *to, epsilon_point *out) {
    for (int k = 0; k < 3; k++) {
        out->x[k].count = 0;
        epsilon_add(&out->x[k], &to->x[k], 1, 0);
        epsilon_add(&out->x[k], &from->x[k], -1, 0);
    }
}

/* corner + step (first - corner) + step^2 (second - corner) + step^3 normal */
static void find_point(const grid_scene *s, corner_side at, epsilon_point *out) {
    const uint32_t *triangle = s->mesh->triangles[at.triangle];
    epsilon_point corners[3], towards;
    for (uint32_t i = 0; i < 3; i++)
        epsilon_move(grid_scene_point(s, triangle[(at.corner + i) % 3]), &corners[i]);
    *out = corners[0];
    for (int i = 1; i < 3; i++) {
        int index = at.next ? i : 3 - i;
        subtract_points(&corners[0], &corners[index], &towards);
        for (int k = 0; k < 3; k++) epsilon_add(&out->x[k], &towards.x[k], 1, (uint64_t)i * STEP);
    }
    for (int k = 0; k < 3; k++) {
        epsilon_polynomial normal;
        epsilon_orient_along((const epsilon_point *const[3]){&corners[0], &corners[1], &corners[2]}, k,
                             &normal);
        epsilon_add(&out->x[k], &normal, 1, 3 * STEP);
    }
}

static int turn_of(const epsilon_point *a, const epsilon_point *b, const epsilon_point *c) {
    epsilon_polynomial value;
    epsilon_orient_along((const epsilon_point *const[3]){a, b, c}, 0, &value);
    return epsilon_sign(&value);
}

static int pass_of(const grid_scene *s, uint32_t triangle, const epsilon_point *point) {
    epsilon_point p[3];
    epsilon_polynomial side;
    for (int i = 0; i < 3; i++) epsilon_move(grid_scene_point(s, s->mesh->triangles[triangle][i]), &p[i]);
    int facing = turn_of(&p[0], &p[1], &p[2]);
    for (int i = 0; i < 3; i++) {
        if (turn_of(&p[i], &p[(i + 1) % 3], point) != facing) return 0;
    }
    epsilon_orient3d((const epsilon_point *const[4]){&p[0], &p[1], &p[2], point}, &side);
    return epsilon_sign(&side) != facing ? facing : 0;
}

int winding_oracle_number(const grid_scene *s, corner_side at, uint32_t object) {
    epsilon_point point;
    int number = 0;
    assert_true(s->vertex_count <= WINDING_NAMES);
    find_point(s, at, &point);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        if (cscd_mesh_vertex_object(s->mesh, s->mesh->triangles[t][0]) != object) continue;
        if (s->mesh->components[s->mesh->triangle_components[t]].closed_manifold)
            number += pass_of(s, t, &point);
    }
    return number;
}
