/* Plans of the published method: the bodies of the thesis, and the steps that are ours. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static uint32_t regions_of(const body *b, uint64_t ours) {
    cscd_mesh *mesh = body_mesh(b, 1);
    cscd_plan_options options = cscd_plan_defaults();
    cscd_plan *plan = NULL;
    options.method = CSCD_METHOD_PUBLISHED;
    options.ours = ours;
    assert_int_equal(plan_create_packed(mesh, b->positions, &options, &plan), CSCD_OK);
    const uint32_t count = cscd_plan_region_count(plan);
    assert_int_equal(cscd_plan_method(plan), CSCD_METHOD_PUBLISHED);
    assert_true(cscd_plan_capacitance(plan, 0) > 0.0);
    cscd_plan_destroy(plan);
    body_mesh_destroy(mesh);
    return count;
}

/* The thesis has 3, 2 and 5 on meshes of its own. */
TEST(bodies_of_the_thesis) {
    static const struct {
        body_kind kind;
        uint32_t least, most;
    } expected[] = {{BODY_PAWN, 3, 3}, {BODY_DUMBBELL, 2, 3}, {BODY_FIGURE, 4, 7}, {BODY_SPHERE, 1, 1}};
    for (int i = 0; i < 4; i++) {
        body b = body_of(expected[i].kind, 2000);
        const uint32_t count = regions_of(&b, CSCD_OURS_CHARGE);
        print_message("  %s: %u regions\n", body_kind_name(expected[i].kind), count);
        assert_true(count >= expected[i].least && count <= expected[i].most);
        body_free(&b);
    }
}

/* No loop parts a torus, so that all of it is one region; ours has several, and so has ours within the published method. */
TEST(a_torus_stays_whole) {
    body torus = body_of(BODY_TORUS, body_nearest_count(BODY_TORUS, 800));
    const uint64_t cuts = CSCD_OURS_CHARGE | CSCD_OURS_RANKS | CSCD_OURS_CUTS;
    assert_int_equal(regions_of(&torus, CSCD_OURS_CHARGE), 1);
    assert_int_equal(regions_of(&torus, CSCD_OURS_CHARGE | CSCD_OURS_RANKS), 1);
    assert_true(regions_of(&torus, cuts) > 1);
    assert_true(regions_of(&torus, cuts | CSCD_OURS_POINTS) > 1);
    torus.triangle_count--; /* what is open is left whole */
    assert_int_equal(regions_of(&torus, CSCD_OURS_CHARGE), 1);
    body_free(&torus);
}

/* Points of regions by our cuts are their centroids, unless they are to be ours. */
TEST(points_are_centroids) {
    body b = body_of(BODY_DUMBBELL, 600);
    cscd_mesh *mesh = body_mesh(&b, 1);
    double shares[2];
    for (int ours = 0; ours < 2; ours++) {
        cscd_plan_options options = cscd_plan_defaults();
        cscd_plan *plan = NULL, *usual = NULL;
        options.method = CSCD_METHOD_PUBLISHED;
        options.ours = CSCD_OURS_CHARGE | CSCD_OURS_RANKS | CSCD_OURS_CUTS | (ours ? CSCD_OURS_POINTS : 0);
        assert_int_equal(plan_create_packed(mesh, b.positions, &options, &plan), CSCD_OK);
        assert_int_equal(plan_create_packed(mesh, b.positions, NULL, &usual), CSCD_OK);
        const cscd_region region = cscd_plan_region(plan, 0), same = cscd_plan_region(usual, 0);
        assert_int_equal(cscd_plan_region_count(plan), cscd_plan_region_count(usual));
        assert_int_equal(region.triangle_count, same.triangle_count);
        shares[ours] = memcmp(region.detector_point, same.detector_point, sizeof(double[3])) == 0;
        cscd_plan_destroy(plan);
        cscd_plan_destroy(usual);
    }
    assert_true(shares[0] == 0.0 && shares[1] == 1.0);
    body_mesh_destroy(mesh);
    body_free(&b);
}

TEST(steps_that_need_others) {
    static const struct {
        cscd_method method;
        uint64_t ours;
        const char *sentence;
    } refused[] = {{CSCD_METHOD_CHARGE, CSCD_OURS_CHARGE, "method charge"},
                   {CSCD_METHOD_PUBLISHED, 1u << 20, "CSCD_OURS_"},
                   {CSCD_METHOD_PUBLISHED, CSCD_OURS_CUTS, "needs CSCD_OURS_RANKS"},
                   {CSCD_METHOD_PUBLISHED, CSCD_OURS_POINTS | CSCD_OURS_RANKS, "needs CSCD_OURS_CUTS"}};
    body b = body_of(BODY_DUMBBELL, 150);
    cscd_mesh *mesh = body_mesh(&b, 1);
    for (int i = 0; i < 4; i++) {
        cscd_plan_options options = cscd_plan_defaults();
        cscd_plan *plan = NULL;
        options.method = refused[i].method;
        options.ours = refused[i].ours;
        expect_invalid(mesh->context, plan_create_packed(mesh, b.positions, &options, &plan),
                       refused[i].sentence);
    }
    const double bad[] = {-0.1, 1.1, NAN};
    for (int i = 0; i < 3; i++) {
        cscd_plan_options options = cscd_plan_defaults();
        cscd_plan *plan = NULL;
        options.growing = bad[i];
        expect_invalid(mesh->context, plan_create_packed(mesh, b.positions, &options, &plan), "growing");
    }
    body_mesh_destroy(mesh);
    body_free(&b);
}
