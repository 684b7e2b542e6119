/* All piercings of a small scene, by trying each edge with each triangle, in polynomials. */
#include "tests/support/intersections/piercing_oracle.h"

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
