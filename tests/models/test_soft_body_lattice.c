/* The lattice covers its surface and carries it along exactly, and the tetrahedra of its cells fit
 * together. */
#include "models/common/vec3.h"
#include "models/softbody/softbody.h"
#include "tests/support/models/bodies.h"
#include "tests/support/models/soft_fixture.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static const struct hung {
    body_kind kind;
    double spacing;
} cases[] = {{BODY_SPHERE, 0.35}, {BODY_TORUS, 0.2}, {BODY_FIGURE, 0.15}, {BODY_CHAIN, 0.15}};

enum { CASE_COUNT = sizeof cases / sizeof *cases };

static body surfaces[CASE_COUNT];
static lattice lattices[CASE_COUNT];

static lattice lattice_of(const body *b, double spacing) {
    return lattice_make(b->positions, b->vertex_count, b->triangles, b->triangle_count, spacing);
}

static int make_lattices(void **state) {
    (void)state;
    random_seed(5);
    for (int i = 0; i < CASE_COUNT; i++) {
        surfaces[i] = body_of(cases[i].kind, body_nearest_count(cases[i].kind, 600));
        lattices[i] = lattice_of(&surfaces[i], cases[i].spacing);
    }
    return 0;
}

static int free_lattices(void **state) {
    (void)state;
    for (int i = 0; i < CASE_COUNT; i++) {
        lattice_free(&lattices[i]);
        body_free(&surfaces[i]);
    }
    return 0;
}

/* Returns 0 inside a cell, else the distance along the axis on which it is largest. */
static double distance_to_cells(const lattice *l, const double p[3]) {
    double nearest = INFINITY;
    for (uint32_t cell = 0; cell < l->cell_count; cell++) {
        const double *low = l->rest + l->cells[cell][0] * 3;
        double off = 0.0;
        for (int k = 0; k < 3; k++) off = fmax(off, fmax(low[k] - p[k], p[k] - low[k] - l->spacing));
        nearest = fmin(nearest, off);
    }
    return nearest;
}

TEST(cells_are_cubes_of_the_grid) {
    for (int i = 0; i < CASE_COUNT; i++) {
        const lattice *l = &lattices[i];
        bool *used = body_allocate(l->node_count, sizeof *used);
        for (uint32_t c = 0; c < l->cell_count * 8; c++) {
            const double *low = l->rest + l->cells[c / 8][0] * 3,
                         *corner = l->rest + l->cells[c / 8][c % 8] * 3;
            for (int k = 0; k < 3; k++)
                assert_true(fabs(corner[k] - low[k] - (c >> k & 1) * l->spacing) < 1e-14);
            used[l->cells[c / 8][c % 8]] = true;
        }
        for (uint32_t n = 0; n < l->node_count; n++) {
            assert_true(used[n]);
            for (uint32_t m = 0; m < n; m++) {
                double apart[3];
                vec3_subtract(l->rest + n * 3, l->rest + m * 3, apart);
                assert_true(vec3_norm(apart) > 0.99 * l->spacing);
            }
        }
        free(used);
    }
}

/* The cube from -1 to 1 has two cells along each axis, from -2 to 2; with the finer spacing it has five,
 * from -1.25 to 1.25. */
TEST(counts_are_those_of_a_cube) {
    body cube = body_of(BODY_CUBE, body_least_count(BODY_CUBE));
    lattice coarse = lattice_of(&cube, 2.0), fine = lattice_of(&cube, 0.5);
    assert_int_equal(coarse.cell_count, 8);
    assert_int_equal(coarse.node_count, 27);
    assert_int_equal(fine.cell_count, 125);
    assert_int_equal(fine.node_count, 216);
    lattice_free(&coarse);
    lattice_free(&fine);
    body_free(&cube);
}

/* The surface is sampled at a quarter of the spacing: a cell that it only grazes may be left out. */
TEST(cells_cover_the_surface) {
    for (int i = 0; i < CASE_COUNT; i++) {
        const body *b = &surfaces[i];
        for (uint32_t t = 0; t < b->triangle_count; t++) {
            double weights[3] = {random_between(0.0, 1.0), random_between(0.0, 1.0),
                                 random_between(0.0, 1.0)};
            double sum = weights[0] + weights[1] + weights[2], p[3] = {0.0, 0.0, 0.0};
            for (int k = 0; k < 3; k++)
                vec3_add_scaled(p, weights[k] / sum, b->positions + b->triangles[t * 3 + (uint32_t)k] * 3);
            assert_true(distance_to_cells(&lattices[i], p) <= 0.25 * cases[i].spacing);
        }
    }
}

TEST(cells_fill_the_inside_only) {
    for (int i = 0; i < 500; i++) { /* the sphere has radius 1, the torus 1 and 0.35 */
        double p[3] = {random_unit(), random_unit(), random_unit()}, turn = 3.2 * random_unit();
        if (vec3_norm(p) > 1.0) continue;
        assert_true(distance_to_cells(&lattices[0], p) <= 0.0 || vec3_norm(p) > 0.9);
        double across = 1.0 + 0.3 * p[0];
        assert_true(
            distance_to_cells(&lattices[1], (double[3]){across * cos(turn), across * sin(turn), 0.0}) <= 0.0);
    }
    assert_true(distance_to_cells(&lattices[1], (double[3]){0.0, 0.0, 0.0}) > 0.2);
    assert_true(distance_to_cells(&lattices[0], (double[3]){1.0, 1.0, 1.0}) > 0.0);
}

TEST(vertices_lie_in_their_cells) {
    for (int i = 0; i < CASE_COUNT; i++) {
        const lattice *l = &lattices[i];
        assert_int_equal(l->vertex_count, surfaces[i].vertex_count);
        for (uint32_t v = 0; v < l->vertex_count; v++) {
            double sum = 0.0;
            assert_true(l->vertex_cells[v] < l->cell_count);
            for (int k = 0; k < 8; k++) {
                assert_true(l->vertex_shares[v][k] >= 0.0);
                sum += l->vertex_shares[v][k];
            }
            assert_true(fabs(sum - 1.0) < 1e-15 * 4.0);
        }
    }
}

TEST(vertices_follow_affine_maps) {
    double maps[3][3][3] = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
                            {{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}},
                            {{1.3, 0.4, -0.2}, {-0.7, 0.6, 0.1}, {0.3, 0.9, 1.8}}};
    const double offsets[3][3] = {{0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}, {-4.0, 0.3, 7.0}};
    for (int i = 0; i < CASE_COUNT * 3; i++) {
        const lattice *l = &lattices[i / 3];
        double *nodes = body_allocate(l->node_count, 3 * sizeof *nodes);
        double *placed = body_allocate(l->vertex_count, 3 * sizeof *placed);
        double *expected = body_allocate(l->vertex_count, 3 * sizeof *expected), alone[3];
        affine_map(maps[i % 3], offsets[i % 3], l->rest, l->node_count, nodes);
        affine_map(maps[i % 3], offsets[i % 3], surfaces[i / 3].positions, l->vertex_count, expected);
        lattice_place_vertices(l, nodes, placed);
        assert_true(largest_distance(placed, expected, l->vertex_count) < 1e-14 * (i % 3 == 0 ? 1.0 : 10.0));
        lattice_place_vertex(l, nodes, 7, alone);
        assert_memory_equal(alone, placed + 21, sizeof alone);
        free(nodes);
        free(placed);
        free(expected);
    }
}

/* ---- tetrahedra ---- */

TEST(volumes_add_up) {
    const material rubber = {.density = 1.0, .young = 100.0, .poisson = 0.4};
    for (int i = 0; i < CASE_COUNT; i++) {
        const lattice *l = &lattices[i];
        tetrahedron *tetrahedra = tetrahedra_make(l, &rubber);
        double cube = l->spacing * l->spacing * l->spacing;
        for (uint32_t cell = 0; cell < l->cell_count; cell++) {
            double sum = 0.0;
            for (uint32_t k = 0; k < 5; k++) {
                assert_true(tetrahedra[cell * 5 + k].volume > 0.16 * cube);
                sum += tetrahedra[cell * 5 + k].volume;
            }
            assert_true(fabs(sum - cube) < 1e-13 * cube);
        }
        free(tetrahedra);
    }
}

/* A face of 3 or 4 ascending nodes; a missing fourth is UINT32_MAX. */
typedef struct face {
    uint32_t nodes[4];
} face;

static int compare_nodes(const void *left, const void *right) {
    uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

static int compare_faces(const void *left, const void *right) {
    const face *a = left, *b = right;
    for (int k = 0; k < 4; k++) {
        if (a->nodes[k] != b->nodes[k]) return a->nodes[k] < b->nodes[k] ? -1 : 1;
    }
    return 0;
}

/* Returns how many faces belong to one cell or tetrahedron only, and fails if one belongs to three. */
static uint32_t outer_faces(face *faces, uint32_t count) {
    uint32_t outer = 0;
    for (uint32_t i = 0; i < count; i++) qsort(faces[i].nodes, 4, sizeof *faces[i].nodes, compare_nodes);
    qsort(faces, count, sizeof *faces, compare_faces);
    for (uint32_t i = 0, same; i < count; i += same) {
        for (same = 1; i + same < count && compare_faces(&faces[i], &faces[i + same]) == 0;) same++;
        assert_in_range(same, 1, 2);
        outer += same == 1;
    }
    return outer;
}

static uint32_t outer_cell_faces(const lattice *l) {
    static const uint8_t sides[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                                        {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 3, 5, 7}};
    face *faces = body_allocate((size_t)l->cell_count * 6, sizeof *faces);
    for (uint32_t i = 0; i < l->cell_count * 6; i++) {
        for (int k = 0; k < 4; k++) faces[i].nodes[k] = l->cells[i / 6][sides[i % 6][k]];
    }
    uint32_t outer = outer_faces(faces, l->cell_count * 6);
    free(faces);
    return outer;
}

static uint32_t outer_tetrahedron_faces(const lattice *l) {
    const material rubber = {.density = 1.0, .young = 100.0, .poisson = 0.4};
    tetrahedron *tetrahedra = tetrahedra_make(l, &rubber);
    face *faces = body_allocate((size_t)l->cell_count * 20, sizeof *faces);
    for (uint32_t i = 0; i < l->cell_count * 20; i++) {
        memcpy(faces[i].nodes, tetrahedra[i / 4].nodes, sizeof faces[i].nodes);
        faces[i].nodes[i % 4] = UINT32_MAX;
    }
    uint32_t outer = outer_faces(faces, l->cell_count * 20);
    free(faces);
    free(tetrahedra);
    return outer;
}

/* If two cells cut their common square along different diagonals, its four triangles would all be outer
 * ones. */
TEST(diagonals_of_neighbours_match) {
    for (int i = 0; i < CASE_COUNT; i++)
        assert_int_equal(outer_tetrahedron_faces(&lattices[i]), 2 * outer_cell_faces(&lattices[i]));
}

AROUND_ALL(make_lattices, free_lattices)
