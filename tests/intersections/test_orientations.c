/* Components that are inside out, alone, beside and in each other: which are taken as turned around, by hand. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */

static void turn_body(body_rig *r, uint32_t body) {
    body_rig_turn(r, r->bodies[body].first_triangle, r->bodies[body].triangle_count);
}

/* Adds a cube, or a box, to what will be a body. */
static void add_cube(double x, double y, double z, double size) {
    const double low[3] = {x, y, z}, sizes[3] = {size, size, size};
    body_rig_add_box(&rig, low, sizes);
}

enum { CUBE = 12 }; /* triangles */

static double greatest_depth(const body_rig *r) {
    double most = -1.0;
    for (size_t i = 0; i < r->found.depths->count; i++) most = fmax(most, r->found.depths->items[i].depth);
    return most;
}

/* ---- two objects --------------------------------------------------------------------------------------- */

typedef struct placing {
    int axis;
    bool mirrored;
    double scale;
} placing;

static placing placing_of(int round) {
    static const double scales[] = {1.0, 0x1p-90, 0x1p80, 1e-3, 1e6};
    return (placing){round % 3, round % 2 == 1, scales[round % 5]};
}

/* Two cubes, of which each may be inside out. */
static void make_two(double offset, double size, int inverted, placing at) {
    body_rig_begin(&rig);
    add_cube(0, 0, 0, 1);
    body_rig_end_body(&rig);
    add_cube(offset, offset, offset, size);
    body_rig_end_body(&rig);
    body_rig_place(&rig, at.axis, at.mirrored, at.scale);
    for (uint32_t i = 0; i < 2; i++) {
        if ((inverted >> i & 1) != 0) turn_body(&rig, i);
    }
    body_rig_create(&rig, NULL, 2);
    body_rig_find(&rig);
}

TEST(crossing_cubes_have_one_depth) {
    for (int round = 0; round < 30; round++) {
        placing at = placing_of(round);
        for (int inverted = 0; inverted < 4; inverted++) {
            make_two(0.5, 1, inverted, at);
            assert_true(fabs(greatest_depth(&rig) / at.scale - 0.5) < 1e-12);
            cscd_overlap both = body_rig_overlap(&rig, 0, 1);
            assert_true(fabs(both.volume / (at.scale * at.scale * at.scale) - 0.125) < 1e-12);
            assert_true(fabs(both.area_a / (at.scale * at.scale) - 0.75) < 1e-12);
            assert_true(fabs(both.area_b / (at.scale * at.scale) - 0.75) < 1e-12);
            for (uint32_t i = 0; i < 2; i++)
                assert_int_equal(body_rig_is_turned(&rig, i), (inverted >> i & 1) != 0);
            assert_int_equal(rig.found.patches->turned != NULL, inverted != 0);
        }
    }
}

TEST(a_cube_within_another) {
    for (int round = 0; round < 30; round++) {
        placing at = placing_of(round);
        for (int inverted = 0; inverted < 4; inverted++) {
            make_two(0.25, 0.5, inverted, at);
            assert_int_equal(rig.found.count, 0);
            assert_int_equal(rig.found.depths->vertex_count, 8);
            for (size_t i = 0; i < 8; i++)
                assert_true(fabs(rig.found.depths->items[i].depth / at.scale - 0.25) < 1e-12);
        }
    }
}

TEST(as_given_it_encloses_nothing) {
    make_two(0.5, 1, 2, placing_of(0));
    rig.orientation = CSCD_ORIENTATION_AS_GIVEN;
    body_rig_find(&rig);
    assert_null(rig.found.patches->turned);
    for (size_t i = 0; i < rig.found.depths->count; i++)
        assert_int_equal(rig.found.depths->items[i].body, 0); /* the one that is not */
    rig.orientation = (cscd_orientation)3;
    assert_int_equal(body_rig_try(&rig), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(rig.context), "unknown orientation 3");
    rig.orientation = CSCD_ORIENTATION_BY_OBJECT;
    body_rig_find(&rig);
    assert_true(body_rig_is_turned(&rig, 1));
}

/* A box on the floor of another one: where the depth is 0, the direction is that of the normal outwards. */
TEST(directions_are_outwards) {
    for (int inverted = 0; inverted < 4; inverted++) {
        body_rig_begin(&rig);
        const double low[3] = {-1, -1, -1}, size[3] = {4, 4, 1};
        body_rig_box(&rig, low, size);
        add_cube(0, 0, 0, 1);
        body_rig_end_body(&rig);
        for (uint32_t i = 0; i < 2; i++) {
            if ((inverted >> i & 1) != 0) turn_body(&rig, i);
        }
        body_rig_find_all(&rig);
        assert_true(rig.found.depths->count > 0);
        for (size_t i = 0; i < rig.found.depths->count; i++) {
            const cscd_depth *d = &rig.found.depths->items[i];
            assert_true(d->depth == 0.0 && d->direction[2] == (d->body == 0 ? 1.0 : -1.0));
        }
    }
}

/* ---- components of one object --------------------------------------------------------------------------- */

/* What crosses another component, or lies beside it, is a body of its own. Some corners of the second cube lie in the first
 * one, all of the third lies in its box, and the fourth is beside them. */
TEST(what_is_not_within_stands_alone) {
    for (int inverted = 0; inverted < 16; inverted++) {
        body_rig_begin(&rig);
        add_cube(0, 0, 0, 2);
        add_cube(1, 1, 1, 2);
        const double low[3] = {0.5, 0.5, -0.5}, size[3] = {0.25, 0.25, 3};
        body_rig_add_box(&rig, low, size);
        add_cube(5, 0, 0, 1);
        body_rig_end_body(&rig);
        for (uint32_t i = 0; i < 4; i++) {
            if ((inverted >> i & 1) != 0) body_rig_turn(&rig, i * CUBE, CUBE);
        }
        body_rig_find_all(&rig);
        for (uint32_t i = 0; i < 4; i++)
            assert_int_equal(body_rig_is_turned(&rig, i), (inverted >> i & 1) != 0);
        cscd_overlap own = body_rig_overlap(&rig, 0, 0);
        assert_true(fabs(own.volume - (1.0 + 0.25 * 0.25 * 2.0)) < 1e-12 && own.area_b == 0.0);
    }
}

/* ---- no volume ----------------------------------------------------------------------------------------- */

/* A cube that is flat or at one place is as given, and takes nothing away from the others. */
TEST(what_is_collapsed_is_as_given) {
    for (int round = 0; round < 12; round++) {
        make_two(0.5, 1, 1, placing_of(0));
        uint32_t first = rig.bodies[1].first_vertex;
        for (uint32_t v = first; v < first + 8; v++) {
            for (int k = 0; k < 3; k++) {
                if (round / 3 == 3 || k == round % 3) rig.all.x0[v * 3 + (uint32_t)k] = 0.1 * (round + 1);
            }
        }
        body_rig_find(&rig);
        assert_true(body_rig_is_turned(&rig, 0) && !body_rig_is_turned(&rig, 1));
    }
}

/* A scale that goes to -1 over time: the volume turns at 0, the depth stays. */
TEST(a_scale_that_goes_negative) {
    make_two(0.5, 1, 0, placing_of(0));
    double given[8];
    for (uint32_t v = 0; v < 8; v++) given[v] = rig.all.x0[v * 3] - 0.5;
    for (int step = 8; step >= -8; step--) {
        for (uint32_t v = 0; v < 8; v++) rig.all.x0[v * 3] = 0.5 + step / 8.0 * given[v];
        body_rig_find(&rig);
        assert_int_equal(body_rig_is_turned(&rig, 0), step < 0);
        double half = 0.5 * fabs(step / 8.0);
        if (step != 0) assert_true(fabs(body_rig_overlap(&rig, 0, 1).volume - 0.25 * half) < 1e-12);
        if (step != 0) assert_true(fabs(greatest_depth(&rig) - fmin(half, 0.5)) < 1e-12);
    }
}

/* ---- rounding -------------------------------------------------------------------------------------------- */

/* Three rows whose determinant is 1, of large integers, by adding rows to each other. */
static void make_rows(random_stream *random, double rows[3][3]) {
    for (int i = 0; i < 9; i++) rows[i / 3][i % 3] = i % 4 == 0;
    for (double most = 0.0; most < 0x1p24;) {
        const uint32_t i = stream_below(random, 3), j = (i + 1 + stream_below(random, 2)) % 3;
        const double times = (double)stream_below(random, 7) - 3.0;
        for (int k = 0; k < 3; k++) {
            rows[i][k] += times * rows[j][k];
            most = fmax(most, fabs(rows[i][k]));
        }
    }
}

/* Tetrahedra of a volume of 1/6 with edges of millions: rounded, the volume is anything, and only the exact sign tells which of
 * them are inside out. */
TEST(the_sign_is_exact) {
    static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    random_stream random = stream_start(51);
    for (int round = 0; round < 100; round++) {
        double rows[3][3];
        make_rows(&random, rows);
        body_rig_begin(&rig);
        memset(rig.all.x0, 0, 3 * sizeof *rig.all.x0);
        memcpy(rig.all.x0 + 3, rows, sizeof rows);
        memcpy(rig.all.triangles, triangles, sizeof triangles);
        rig.all.vertex_count = rig.all.triangle_count = 4;
        body_rig_end_body(&rig);
        if (round % 2 == 1) turn_body(&rig, 0);
        body_rig_create(&rig, NULL, 1);
        body_rig_find(&rig);
        assert_int_equal(body_rig_is_turned(&rig, 0), round % 2);
    }
}

AROUND_EACH(NULL, body_rigs_free)
