/* Winding numbers of a small scene by brute force: a ray along x, and the point off a corner written out in powers of
 * epsilon. */
#include "tests/support/intersections/winding_oracle.h"

#include "tests/support/test.h"

#include <assert.h>

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
