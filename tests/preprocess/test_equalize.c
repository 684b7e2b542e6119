/* Equalized densities are ranks, by component. */
#include "preprocess/regions/regions.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static cscd_context *context;
static size_t bytes_at_start;

static int open_context(void **state) {
    (void)state;
    if (cscd_context_create(NULL, &context) != CSCD_OK) return -1;
    bytes_at_start = cscd_context_describe(context).bytes;
    return 0;
}

static int close_context(void **state) {
    (void)state;
    bool leaked = cscd_context_describe(context).bytes != bytes_at_start;
    cscd_context_destroy(context);
    return leaked ? -1 : 0;
}

static cscd_mesh *mesh_of(const mesh_shape *s) {
    cscd_mesh *mesh = NULL;
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles[0]);
    expect_ok(cscd_mesh_create(context, &desc, 1, &mesh));
    return mesh;
}

/* Triangle i is joined to i - 1 and i + 1. */
static cscd_mesh *strip_mesh(uint32_t triangle_count) {
    mesh_shape s = {0};
    for (uint32_t i = 0; i < triangle_count; i++)
        shape_add_triangle(&s, i, i % 2 == 0 ? i + 1 : i + 2, i % 2 == 0 ? i + 2 : i + 1);
    return mesh_of(&s);
}

static void assert_doubles(const double *found, const double *expected, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) assert_true(found[i] == expected[i]);
}

TEST(ranks_of_densities) {
    cscd_mesh *mesh = strip_mesh(8);
    const double density[8] = {3.0, -0.5, 1e300, -1e-300, 0.0, -1e300, 1e-320, 2.0};
    const double expected[8] = {7 / 8.0, 2 / 8.0, 8 / 8.0, 3 / 8.0, 4 / 8.0, 1 / 8.0, 5 / 8.0, 6 / 8.0};
    double found[8];
    expect_ok(equalize(mesh, density, found));
    assert_doubles(found, expected, 8);
    cscd_mesh_destroy(mesh);
}

TEST(ties_go_by_index) {
    cscd_mesh *mesh = strip_mesh(6);
    double found[6];
    const double same[6] = {1, 1, 1, 1, 1, 1}, zeros[6] = {0.0, -0.0, 1.0, 0.0, -1.0, -0.0};
    const double ascending[6] = {1 / 6.0, 2 / 6.0, 3 / 6.0, 4 / 6.0, 5 / 6.0, 6 / 6.0};
    const double of_zeros[6] = {2 / 6.0, 3 / 6.0, 6 / 6.0, 4 / 6.0, 1 / 6.0, 5 / 6.0};
    expect_ok(equalize(mesh, same, found));
    assert_doubles(found, ascending, 6);
    expect_ok(equalize(mesh, zeros, found));
    assert_doubles(found, of_zeros, 6);
    cscd_mesh_destroy(mesh);
}

/* Noise beyond 24 bits does not change the order; a difference in the 23rd bit does. */
TEST(rounded_to_24_bits) {
    cscd_mesh *mesh = strip_mesh(3);
    double found[3];
    for (int exponent = -1000; exponent <= 1000; exponent += 100) {
        double unit = ldexp(1.0, exponent);
        const double noisy[3] = {unit * (1 + 0x1p-40), unit, unit * (1 + 0x1p-30)};
        const double clear[3] = {unit * (1 + 0x1p-22), unit, unit * (1 + 0x1p-23)};
        const double by_index[3] = {1 / 3.0, 2 / 3.0, 1.0}, by_value[3] = {1.0, 1 / 3.0, 2 / 3.0};
        expect_ok(equalize(mesh, noisy, found));
        assert_doubles(found, by_index, 3);
        expect_ok(equalize(mesh, clear, found));
        assert_doubles(found, by_value, 3);
    }
    cscd_mesh_destroy(mesh);
}

/* An inner component with hardly any charge is not all low, nor does it change the outer one's ranks. */
TEST(each_component_on_its_own) {
    mesh_shape s = {0};
    shape_add_tetrahedron(&s, 0, 1, 2, 3);
    shape_add_tetrahedron(&s, 4, 5, 6, 7);
    cscd_mesh *mesh = mesh_of(&s);
    const double density[2][8] = {
        {4, 3, 2, 1, 1e-9, 2e-9, -1e-9, 3e-9},
        {4, 3, 2, 1, 1.5, 2.5, -1e-9, 3.5}}; /* far from those of the other, and among them */
    const double expected[8] = {1.0, 0.75, 0.5, 0.25, 0.5, 0.75, 0.25, 1.0};
    for (int i = 0; i < 2; i++) {
        double found[8];
        expect_ok(equalize(mesh, density[i], found));
        assert_doubles(found, expected, 8);
    }
    cscd_mesh_destroy(mesh);
}

TEST(not_finite_is_refused) {
    cscd_mesh *mesh = strip_mesh(4);
    const double bad[3] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double density[4] = {1, 2, bad[i], 4}, found[4] = {-7, -7, -7, -7};
        expect_invalid(context, equalize(mesh, density, found), "triangle 2");
        for (int j = 0; j < 4; j++) assert_true(found[j] == -7);
    }
    cscd_mesh_destroy(mesh);
}

AROUND_ALL(open_context, close_context)
