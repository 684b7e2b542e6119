/* The sign of the volume that closed components enclose, against exact integers: grids, flat bodies, bodies that are far from
 * the origin or an ulp thick, and bodies that enclose as much the one way as the other. */
#include "src/core/context.h"
#include "src/mesh/surface.h"
#include "tests/support/ccd/wide_numbers.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <string.h>

enum { ROUNDS = PACED(4000, 200) };

enum { VERTICES = 8 };

typedef struct volume_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    double x[VERTICES * 3];
    uint32_t list[SHAPE_TRIANGLES_MAX];
} volume_rig;

/* A cube, or a tetrahedron. */
static void make_rig(volume_rig *r, bool cube) {
    mesh_shape s = {0};
    if (cube)
        shape_add_cube(&s);
    else
        shape_add_tetrahedron(&s, 0, 1, 2, 3);
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, &s.triangles[0][0]);
    assert_int_equal(cscd_context_create(NULL, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, &desc, 1, &r->mesh), CSCD_OK);
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++) r->list[t] = t;
}

static void free_rig(volume_rig *r) {
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static int sign_by_integers(const volume_rig *r) {
    struct exact_integer sum = {0};
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++) {
        struct exact_integer p[3][3];
        for (int i = 0; i < 9; i++)
            p[i / 3][i % 3] = exact_from_double(r->x[r->mesh->triangles[t][i / 3] * 3 + (uint32_t)(i % 3)]);
        for (int k = 0; k < 3; k++) {
            struct exact_integer left = exact_multiply(&p[1][(k + 1) % 3], &p[2][(k + 2) % 3]);
            struct exact_integer right = exact_multiply(&p[1][(k + 2) % 3], &p[2][(k + 1) % 3]);
            struct exact_integer minor = exact_subtract(&left, &right);
            struct exact_integer product = exact_multiply(&p[0][k], &minor);
            sum = exact_add(&sum, &product);
        }
    }
    return sum.sign;
}

/* Returns the sign, whether the estimate decides or not. */
static int compare_sign(volume_rig *r) {
    volume_estimate estimate;
    int truth = sign_by_integers(r);
    volume_estimates_find(r->mesh, r->x, &estimate);
    assert_non_null(estimate.origin);
    if (volume_estimate_decides(&estimate))
        assert_int_equal((estimate.volume > 0.0) - (estimate.volume < 0.0), truth);
    assert_int_equal(volume_sign_exact(r->mesh, r->x, r->list, r->mesh->triangle_count), truth);
    return truth;
}

static double any_coordinate(random_stream *random, uint32_t family) {
    double grid = (double)stream_below(random, 4) - 1.0, unit = stream_between(random, -1.0, 1.0);
    switch (family) {
    case 0:
        return grid;
    case 1:
        return unit;
    case 2:
        return 0x1p52 + grid; /* far away */
    case 3:
        return 1.0 + grid * 0x1p-52; /* an ulp thick */
    case 4:
        return unit * ldexp(1.0, (int)stream_below(random, 599) - 299); /* any magnitude */
    case 5:
        return grid * 0x1p299;
    case 6:
        return grid * 0x1p-300;
    default:
        return 0.1 * grid; /* nearly on a grid */
    }
}

TEST(signs_are_those_of_integers) {
    uint32_t of_sign[3] = {0, 0, 0};
    for (int cube = 0; cube < 2; cube++) {
        volume_rig r;
        make_rig(&r, cube == 1);
        for (uint32_t round = 0; round < ROUNDS; round++) {
            random_stream random = stream_start(round);
            for (int i = 0; i < VERTICES * 3; i++) {
                r.x[i] = any_coordinate(&random, round % 8);
                if (fabs(r.x[i]) < 0x1p-300) r.x[i] = 0.0;
            }
            for (int i = 0; i < VERTICES && round % 5 == 1; i++)
                r.x[i * 3 + (int)(round % 3)] = r.x[0]; /* flat */
            of_sign[compare_sign(&r) + 1]++;
        }
        free_rig(&r);
    }
    for (int i = 0; i < 3; i++) assert_true(of_sign[i] > ROUNDS / 20);
}

/* Carries go through all limbs. */
TEST(sums_carry) {
    volume_rig r;
    make_rig(&r, false);
    static const double corners[] = {0, 0, 0, 0x1p300, 0, 0, 0, 0x1p300, 0, 0x1p-300, 0x1p-300, 0};
    for (int sign = -1; sign <= 1; sign++) {
        memcpy(r.x, corners, sizeof corners);
        r.x[11] = sign * 0x1p-300;
        int found = compare_sign(&r);
        assert_true(sign == 0 ? found == 0 : found != 0);
        r.x[11] = -r.x[11];
        assert_int_equal(compare_sign(&r), -found);
    }
    free_rig(&r);
}

/* A cube whose opposite halves are as large, one of them inside out: mirror symmetric, with its middle passing through
 * itself. */
TEST(what_encloses_nothing_has_no_sign) {
    volume_rig r;
    make_rig(&r, true);
    for (uint32_t v = 0; v < 8; v++) {
        double side = (v & 4) != 0 ? 1.0 : -1.0; /* the upper square is turned by half, so that sides cross */
        r.x[v * 3] = side * ((v & 1) != 0 ? 0.3 : -0.3);
        r.x[v * 3 + 1] = (v & 2) != 0 ? 0.7 : -0.7;
        r.x[v * 3 + 2] = side * 0.1;
    }
    assert_int_equal(compare_sign(&r), 0);
    r.x[0] = nextafter(r.x[0], 1.0);
    assert_int_not_equal(compare_sign(&r), 0);
    free_rig(&r);
}
