/* Seams whose vertices do not belong together are refused: equal ones at once, distant ones when the detector first
 * sees positions. */
#include "cscd/cscd.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* Two triangles in parallel planes; the vertices 0 and 3, 1 and 4 are to be sewn together. */
typedef struct sewn_panels {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_line_search *line;
} sewn_panels;

enum { STEP, CHECK, NEAR, MAX_STEP, BEGIN_LINE, CALLS };

static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5}, sewn[] = {0, 3, 1, 4};

/* The panels lie `gap` above each other; the edges at 0 and 3 have the length 1. */
static void place_panels(double gap, double x[18]) {
    const double flat[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 0};
    memcpy(x, flat, sizeof flat);
    for (int v = 3; v < 6; v++) x[3 * v + 2] = gap;
}

static sewn_panels sew_panels(const cscd_detector_options *options) {
    sewn_panels p;
    const cscd_object_desc object = cscd_object_of_triangles(6, 2, triangles);
    assert_int_equal(cscd_context_create(NULL, &p.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(p.context, &object, 1, &p.mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(p.context, p.mesh, NULL, options, &p.detector), CSCD_OK);
    assert_int_equal(cscd_line_search_create(p.detector, &p.line), CSCD_OK);
    return p;
}

static void free_panels(sewn_panels *p) {
    cscd_line_search_destroy(p->line);
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    cscd_context_destroy(p->context);
}

static cscd_status see_positions(const sewn_panels *p, int call, const double *positions) {
    const cscd_view *x = CSCD_DOUBLES(positions, 6);
    cscd_contacts contacts;
    cscd_intersections intersections;
    cscd_proximities near;
    cscd_free_step step;
    switch (call) {
    case STEP:
        return cscd_detector_step(p->detector, x, x, &contacts);
    case CHECK:
        return cscd_detector_check(p->detector, x, &intersections);
    case NEAR:
        return cscd_detector_find_near(p->detector, x, 0.5, CSCD_NEAR_PAIRS, &near);
    case MAX_STEP:
        return cscd_detector_max_step(p->detector, x, x, NULL, &step);
    default:
        return cscd_line_search_begin(p->line, x, x, 0.5);
    }
}

static cscd_detector_options options_sewn(void) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = sewn;
    options.seam_count = 2;
    return options;
}

static void expect_refusal(const sewn_panels *p, int call, double gap, const char *sentence) {
    double x[18];
    place_panels(gap, x);
    assert_int_equal(see_positions(p, call, x), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(p->context), sentence));
}

/* Whatever call sees positions first refuses seams that gape wider than an edge, as often as they do. Seams that
 * have been seen near each other may be pulled apart. */
TEST(distant_vertices_are_named_at_first_sight) {
    cscd_detector_options options = options_sewn();
    for (int first = 0; first < CALLS; first++) {
        for (int second = 0; second < CALLS; second++) {
            double x[18];
            sewn_panels p = sew_panels(&options);
            for (int i = 0; i < 2; i++)
                expect_refusal(
                    &p, first, 1.25,
                    "pair 0 of seams joins the vertices 0 and 3, which are 1.25 apart at the first "
                    "positions, farther than the longest edge at them, 1: check the indices");
            expect_refusal(&p, second, 28.0, "which are 28 apart");
            place_panels(1.0, x);
            assert_int_equal(see_positions(&p, second, x), CSCD_OK);
            place_panels(28.0, x);
            assert_int_equal(see_positions(&p, first, x), CSCD_OK);
            free_panels(&p);
        }
    }
}

/* Pairs are checked one by one, each by its own edges: the second one gapes where the first does not. */
TEST(the_first_distant_pair_is_named) {
    const uint32_t ends[] = {0, 3, 2, 5};
    cscd_detector_options options = options_sewn();
    options.seams = ends;
    sewn_panels p = sew_panels(&options);
    double x[18];
    place_panels(0.0, x);
    expect_refusal(&p, STEP, 0.0, "pair 1 of seams joins the vertices 2 and 5, which are 2 apart");
    x[3 * 2 + 1] = x[3 * 5 + 1] = 0.5;
    assert_int_equal(see_positions(&p, STEP, x), CSCD_OK);
    free_panels(&p);
}

/* The triangle of either end, the first or the second, may be the small one. */
TEST(the_longest_edge_of_both_ends_counts) {
    cscd_detector_options options = options_sewn();
    options.seam_count = 1;
    for (int small = 0; small < 2; small++) {
        double x[18];
        sewn_panels p = sew_panels(&options);
        place_panels(0.5, x);
        for (int v = 3 * small; v < 3 * small + 3; v++) {
            for (int k = 0; k < 2; k++) x[3 * v + k] *= 0.25;
        }
        assert_int_equal(see_positions(&p, STEP, x), CSCD_OK);
        free_panels(&p);
    }
}

/* The caller says what is far: farther than any edge, nearer, or nothing. */
TEST(the_reach_of_seams) {
    double x[18];
    cscd_detector_options options = options_sewn();
    options.seam_reach = 28.0;
    sewn_panels p = sew_panels(&options);
    expect_refusal(&p, STEP, 28.5,
                   "which are 28.5 apart at the first positions, farther than seam_reach, 28");
    place_panels(28.0, x);
    assert_int_equal(see_positions(&p, STEP, x), CSCD_OK);
    free_panels(&p);
    options.seam_reach = 0.001;
    p = sew_panels(&options);
    expect_refusal(&p, CHECK, 0.002, "farther than seam_reach, 0.001");
    free_panels(&p);
    options.seam_reach = (double)INFINITY;
    p = sew_panels(&options);
    place_panels(1e80, x);
    assert_int_equal(see_positions(&p, NEAR, x), CSCD_OK);
    free_panels(&p);
}

TEST(equal_vertices_are_refused) {
    const uint32_t same[] = {0, 3, 4, 4};
    cscd_detector_options options = options_sewn();
    sewn_panels p = sew_panels(&options);
    cscd_detector *none = NULL;
    options.seams = same;
    assert_int_equal(cscd_detector_create(p.context, p.mesh, NULL, &options, &none), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(p.context),
                        "pair 1 of seams has vertex 4 twice, expected two vertices; leave it out");
    assert_null(none);
    free_panels(&p);
}
