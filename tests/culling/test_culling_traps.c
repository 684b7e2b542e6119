/* Culling by orientation in cases that are easily wrong: surfaces without an inside, degenerate first
 * contacts, starts that are not embedded, minimum separation. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static scene s; /* large; one test at a time */

static uint32_t add_vertex(double x, double y, double z) {
    double *p = s.x0 + (size_t)s.vertex_count * 3;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return s.vertex_count++;
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *t = s.triangles + (size_t)s.triangle_count++ * 3;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

static void keep_still(void) {
    memcpy(s.x1, s.x0, s.vertex_count * sizeof(double[3]));
}

static void move_to(uint32_t vertex, double x, double y, double z) {
    double *p = s.x1 + (size_t)vertex * 3;
    p[0] = x;
    p[1] = y;
    p[2] = z;
}

typedef struct trap_result {
    size_t count;
    double earliest;
    cscd_guarantee guarantee; /* of component 0 */
    cscd_counters counters;
} trap_result;

static trap_result run_trap(cscd_detector_options options, uint32_t k) {
    trap_result out = {.earliest = INFINITY};
    rig r = rig_create(&s, 1, NULL);
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts found;
    cscd_plan_options plan_options = cscd_plan_defaults();
    plan_options.method = k > 0 ? CSCD_METHOD_KMEANS : CSCD_METHOD_SINGLE;
    plan_options.k = k;
    assert_int_equal(plan_create_packed(r.mesh, s.x0, &plan_options, &plan), CSCD_OK);
    assert_int_equal(detector_create_here(r.mesh, plan, &options, &detector), CSCD_OK);
    assert_int_equal(step_packed(detector, s.x0, s.x1, &found), CSCD_OK);
    out.count = found.count;
    if (found.count > 0) out.earliest = found.items[0].toi;
    out.guarantee = cscd_detector_guarantee(detector, 0);
    out.counters = cscd_detector_counters(detector);
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    rig_destroy(&r);
    return out;
}

static cscd_detector_options with_mode(cscd_method method, cscd_mode mode) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = mode;
    return options;
}

/* Checks that mode all equals no culling, for the expected reason, and mode earliest has the same first contact, with one
 * region and several. */
static void check_first_contact(cscd_reason expected) {
    trap_result truth = run_trap(with_mode(CSCD_METHOD_NONE, CSCD_MODE_ALL), 0);
    for (uint32_t k = 0; k <= 4; k++) {
        trap_result all = run_trap(with_mode(CSCD_METHOD_AUTO, CSCD_MODE_ALL), k);
        trap_result earliest = run_trap(with_mode(CSCD_METHOD_AUTO, CSCD_MODE_EARLIEST), k);
        assert_int_equal(all.count, truth.count);
        assert_true(isinf(truth.earliest) == isinf(earliest.earliest));
        if (truth.count > 0) assert_true(fabs(earliest.earliest - truth.earliest) <= 1e-9);
        assert_true(earliest.count <= truth.count && all.guarantee.complete);
        assert_int_equal(all.guarantee.reason, expected);
        bool itself = expected != CSCD_REASON_CLEAN; /* it touches itself */
        assert_int_equal(earliest.guarantee.reason, itself ? CSCD_REASON_EARLIEST : CSCD_REASON_CLEAN);
    }
}

/* ---- surfaces without an inside -------------------------------------------------------------------- */

/* Every triangle faces the centre, and yet the surface intersects itself because it winds around twice. */
TEST(pentagrammic_bipyramid) {
    scene_clear(&s);
    for (int i = 0; i < 5; i++) add_vertex(cos(4.0 * PI * i / 5.0), sin(4.0 * PI * i / 5.0), 0.0);
    uint32_t top = add_vertex(0, 0, 1), bottom = add_vertex(0, 0, -1);
    for (uint32_t i = 0; i < 5; i++) {
        add_triangle(top, i, (i + 1) % 5);
        add_triangle(bottom, (i + 1) % 5, i);
    }
    keep_still();
    for (uint32_t i = 0; i < s.vertex_count * 3; i++) s.x1[i] *= 1.1;
    cscd_detector_options vouched = with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST);
    vouched.start = CSCD_START_VOUCHED;
    trap_result trusting = run_trap(vouched, 0);
    assert_int_equal(trusting.counters.plus, s.triangle_count); /* otherwise this test tests nothing */
    check_first_contact(CSCD_REASON_CROSSING);
    assert_true(run_trap(with_mode(CSCD_METHOD_NONE, CSCD_MODE_ALL), 0).count > trusting.count);
}

/* An open sheet is rolled up about its axis. All triangles are S+, and its layers touch. */
TEST(rolled_sheet) {
    scene_clear(&s);
    scene_add_sheet(&s, 12.0, 2.0, 60, 6);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double *p = s.x0 + (size_t)v * 3, *q = s.x1 + (size_t)v * 3;
        double angle = p[0] * 1.0, wide = 1.0 + 0.05 * angle, narrow = 1.0 - 0.03 * angle, y = p[1];
        p[0] = wide * cos(angle);
        p[1] = wide * sin(angle);
        p[2] = y;
        q[0] = narrow * cos(angle);
        q[1] = narrow * sin(angle);
        q[2] = y;
    }
    assert_true(run_trap(with_mode(CSCD_METHOD_NONE, CSCD_MODE_ALL), 0).count > 0);
    check_first_contact(CSCD_REASON_SURFACE);
}

/* ---- degenerate first contacts --------------------------------------------------------------------- */

/* Adds a horseshoe: the polygon extruded along z. Corner i is vertex 2 i at z = 0 and vertex 2 i + 1 at z
 * = 4. */
static void add_horseshoe(void) {
    static const double corners[8][2] = {{0, 0}, {10, 0}, {10, 8}, {7, 8}, {7, 3}, {3, 3}, {3, 8}, {0, 8}};
    static const uint32_t cap[6][3] = {{0, 1, 5}, {1, 4, 5}, {1, 2, 4}, {2, 3, 4}, {0, 5, 7}, {5, 6, 7}};
    scene_clear(&s);
    for (int i = 0; i < 8; i++) {
        add_vertex(corners[i][0], corners[i][1], 0);
        add_vertex(corners[i][0], corners[i][1], 4);
    }
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t j = (i + 1) % 8;
        add_triangle(2 * i, 2 * j, 2 * j + 1);
        add_triangle(2 * i, 2 * j + 1, 2 * i + 1);
    }
    for (int i = 0; i < 6; i++) {
        add_triangle(2 * cap[i][0], 2 * cap[i][2], 2 * cap[i][1]);
        add_triangle(2 * cap[i][0] + 1, 2 * cap[i][1] + 1, 2 * cap[i][2] + 1);
    }
    keep_still();
}

/* The tip of one arm touches the edge of the other where its sides turn away from the detector point. */
TEST(vertex_meets_silhouette_edge) {
    add_horseshoe();
    move_to(2 * 3, -1, 8, 2);
    check_first_contact(CSCD_REASON_FINISHED);
    assert_true(fabs(run_trap(with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST), 0).earliest - 0.5) <= 1e-9);
}

/* The same tip passes beside the edge: there is no contact, and the detector proves it. */
TEST(vertex_misses_silhouette_edge) {
    add_horseshoe();
    move_to(2 * 3, 3.0 + 0x1p-40, 8, 2);
    check_first_contact(CSCD_REASON_CLEAN);
    assert_int_equal(run_trap(with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST), 0).count, 0);
}

/* An arm comes to lie flat on the other: all contacts are at one time, and all are degenerate. */
TEST(side_comes_to_lie_on_side) {
    add_horseshoe();
    move_to(2 * 3, 3, 8, 0);
    move_to(2 * 3 + 1, 3, 8, 4);
    check_first_contact(CSCD_REASON_FINISHED);
    add_horseshoe();
    move_to(2 * 3, 3, 8, 0);
    move_to(2 * 3 + 1, 3, 8, 4);
    move_to(2 * 4, 3.5, 3, 0);
    move_to(2 * 4 + 1, 3.5, 3, 4);
    check_first_contact(CSCD_REASON_FINISHED);
}

static uint32_t nearest_vertex(double x, double y, double z) {
    uint32_t nearest = 0;
    double least = INFINITY;
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        const double *p = s.x0 + (size_t)v * 3;
        double d = hypot(hypot(p[0] - x, p[1] - y), p[2] - z);
        if (d < least) {
            least = d;
            nearest = v;
        }
    }
    return nearest;
}

/* Three points of a sphere are pulled inwards and arrive at one point at the end. */
TEST(three_sheets_at_one_point) {
    static const double origin[3] = {0, 0, 0};
    scene_clear(&s);
    scene_add_sphere(&s, origin, 1.0, 9, 12);
    keep_still();
    for (int i = 0; i < 3; i++)
        move_to(nearest_vertex(cos(2.0 * PI * i / 3.0), sin(2.0 * PI * i / 3.0), 0.0), 0, 0, 0);
    check_first_contact(CSCD_REASON_FINISHED);
    assert_true(run_trap(with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST), 0).earliest > 1.0 - 1e-9);
}

/* ---- components ------------------------------------------------------------------------------------ */

/* The inner sphere grows through the outer one. Contacts between components are never culled. */
TEST(inner_grows_through_outer) {
    static const double origin[3] = {0, 0, 0};
    scene_clear(&s);
    scene_add_sphere(&s, origin, 1.0, 7, 9);
    uint32_t outer = s.vertex_count;
    scene_add_sphere(&s, origin, 0.5, 6, 8);
    keep_still();
    for (uint32_t i = outer * 3; i < s.vertex_count * 3; i++) s.x1[i] = 3.0 * s.x0[i];
    trap_result truth = run_trap(with_mode(CSCD_METHOD_NONE, CSCD_MODE_ALL), 0);
    assert_true(truth.count > 0);
    for (uint32_t k = 0; k <= 4; k++)
        assert_int_equal(run_trap(with_mode(CSCD_METHOD_AUTO, CSCD_MODE_EARLIEST), k).count, truth.count);
    check_first_contact(CSCD_REASON_CLEAN);
}

/* ---- minimum separation ---------------------------------------------------------------------------- */

/* The walls of a groove face the detector point and approach each other, so orientation proves nothing. */
TEST(groove_with_minimum_separation) {
    add_horseshoe();
    move_to(2 * 3, 3.5, 8, 0);
    move_to(2 * 3 + 1, 3.5, 8, 4);
    cscd_detector_options options = with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST);
    options.min_separation = 1.0;
    trap_result found = run_trap(options, 0);
    options.method = CSCD_METHOD_BRUTE;
    trap_result truth = run_trap(options, 0);
    assert_true(found.count > 0 && found.count == truth.count && found.earliest == truth.earliest);
    assert_int_equal(found.guarantee.reason, CSCD_REASON_EARLIEST);
    assert_true(!found.guarantee.complete && found.counters.plus == 0);
}

/* ---- starts ---------------------------------------------------------------------------------------- */

typedef struct chain {
    rig r;
    cscd_detector *detector;
    uint64_t checks;
} chain;

static void step_trap(chain *c, const double *start, const double *end, cscd_reason expected) {
    cscd_contacts found;
    assert_int_equal(step_packed(c->detector, start, end, &found), CSCD_OK);
    c->checks += cscd_detector_counters(c->detector).static_checks;
    assert_int_equal(cscd_detector_guarantee(c->detector, 0).reason, expected);
}

static chain start_chain(cscd_start start) {
    chain c = {.r = rig_create(&s, 1, NULL)};
    cscd_detector_options options = with_mode(CSCD_METHOD_SINGLE, CSCD_MODE_ALL);
    options.start = start;
    assert_int_equal(detector_create_here(c.r.mesh, NULL, &options, &c.detector), CSCD_OK);
    return c;
}

static void end_chain(chain *c) {
    cscd_detector_destroy(c->detector);
    rig_destroy(&c->r);
}

/* The proof is handed on from clean interval to clean interval, so there is one static check in all. */
TEST(one_check_while_clean) {
    static double frames[20][SCENE_VERTICES_MAX * 3];
    add_horseshoe();
    for (int i = 0; i < 20; i++) {
        for (uint32_t j = 0; j < s.vertex_count * 3; j++) frames[i][j] = s.x0[j] * (1.0 + 0.01 * i);
    }
    chain c = start_chain(CSCD_START_PROVE);
    for (int i = 0; i < 19; i++) step_trap(&c, frames[i], frames[i + 1], CSCD_REASON_CLEAN);
    assert_int_equal(c.checks, 1);
    end_chain(&c);
}

/* The detector's knowledge follows a contact, an intersection, and the separation after it. */
TEST(contact_and_recovery) {
    static double open[SCENE_VERTICES_MAX * 3], crossing[SCENE_VERTICES_MAX * 3];
    add_horseshoe();
    move_to(2 * 3, 1, 8, 2);
    memcpy(open, s.x0, sizeof open);
    memcpy(crossing, s.x1, sizeof crossing);
    chain c = start_chain(CSCD_START_PROVE);
    c.detector->known.starts.share_worth_it = 0.5;
    step_trap(&c, open, crossing, CSCD_REASON_FINISHED);
    step_trap(&c, crossing, crossing,
              CSCD_REASON_CROSSING); /* most triangles stay clean, and the rest are culled too */
    assert_true(cscd_detector_counters(c.detector).plus > 0);
    step_trap(&c, crossing, open, CSCD_REASON_CROSSING); /* every start is checked */
    step_trap(&c, open, open, CSCD_REASON_CLEAN);
    assert_int_equal(c.checks, 4);
    end_chain(&c);

    c = start_chain(CSCD_START_PROVE);
    step_trap(&c, open, crossing, CSCD_REASON_FINISHED);
    step_trap(&c, crossing, crossing, CSCD_REASON_CROSSING); /* too few are clean for culling to pay, */
    assert_int_equal(cscd_detector_counters(c.detector).plus, 0);
    step_trap(&c, crossing, open, CSCD_REASON_UNPROVEN); /* so the next check waits */
    step_trap(&c, open, open, CSCD_REASON_CLEAN);
    assert_int_equal(c.checks, 3);
    end_chain(&c);
}

TEST(without_a_proof_nothing_is_culled) {
    cscd_intersections found;
    add_horseshoe();
    chain c = start_chain(CSCD_START_UNKNOWN);
    step_trap(&c, s.x0, s.x1, CSCD_REASON_UNPROVEN);
    assert_int_equal(cscd_detector_counters(c.detector).plus, 0);
    assert_int_equal(check_packed(c.detector, s.x0, &found), CSCD_OK);
    step_trap(&c, s.x0, s.x1, CSCD_REASON_CLEAN);
    assert_true(cscd_detector_counters(c.detector).plus > 0);
    assert_int_equal(c.checks, 0);
    end_chain(&c);
    c = start_chain(CSCD_START_VOUCHED);
    step_trap(&c, s.x0, s.x1, CSCD_REASON_CLEAN);
    assert_int_equal(c.checks, 0);
    end_chain(&c);
}

/* A start that touches itself exactly is not embedded. */
TEST(touching_start) {
    add_horseshoe();
    double *tip = s.x0 + (size_t)2 * 3 * 3;
    tip[0] = 3;
    tip[2] = 2;
    keep_still();
    move_to(2 * 3, 7, 8, 0);
    check_first_contact(CSCD_REASON_CROSSING);
}
