/* Mode earliest where three sheets come together: the pair of the outer two is culled, and only the contacts with the
 * middle one uncover it. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* A hook: its outline in x and z, counter-clockwise, is drawn along y in rings. The place of the base that rises, the
 * underside of the arm, which stays, and the place of the arm's top that falls are at x = 3. */
enum { OUTLINE = 13, RINGS = 9, RISES = 3, FALLS = 10 };

static const double outline[OUTLINE][2] = {{0, 0}, {6, 0}, {6, 1}, {3, 1}, {1, 1}, {1, 2}, {2, 2},
                                           {4, 2}, {6, 2}, {6, 3}, {3, 3}, {1, 3}, {0, 3}};

/* Corners of the outline that cut it into triangles. */
static const uint32_t cap[OUTLINE - 2][3] = {{0, 1, 2},  {0, 2, 3},   {0, 3, 4},  {0, 4, 5},
                                             {0, 5, 12}, {5, 11, 12}, {5, 6, 11}, {6, 10, 11},
                                             {6, 7, 10}, {7, 9, 10},  {7, 8, 9}};

static scene s; /* large; one test at a time */

static void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *t = s.triangles + (size_t)s.triangle_count++ * 3;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

static uint32_t vertex_of(uint32_t ring, uint32_t corner) {
    return ring * OUTLINE + corner;
}

static void make_hook(void) {
    scene_clear(&s);
    for (uint32_t r = 0; r < RINGS; r++) {
        for (uint32_t i = 0; i < OUTLINE; i++) {
            const double p[3] = {outline[i][0], 0.75 * r, outline[i][1]};
            memcpy(s.x0 + (size_t)s.vertex_count++ * 3, p, sizeof p);
        }
    }
    for (uint32_t r = 0; r + 1 < RINGS; r++) {
        for (uint32_t i = 0; i < OUTLINE; i++) {
            uint32_t next = (i + 1) % OUTLINE;
            add_triangle(vertex_of(r, i), vertex_of(r, next), vertex_of(r + 1, next));
            add_triangle(vertex_of(r, i), vertex_of(r + 1, next), vertex_of(r + 1, i));
        }
    }
    for (uint32_t i = 0; i < OUTLINE - 2; i++) {
        add_triangle(vertex_of(0, cap[i][0]), vertex_of(0, cap[i][2]), vertex_of(0, cap[i][1]));
        add_triangle(vertex_of(RINGS - 1, cap[i][0]), vertex_of(RINGS - 1, cap[i][1]),
                     vertex_of(RINGS - 1, cap[i][2]));
    }
    memcpy(s.x1, s.x0, s.vertex_count * sizeof(double[3]));
}

/* Lets a vertex pass through the underside of the arm, z = 2, at this time. */
static void pass_through(uint32_t vertex, double time) {
    double z = s.x0[(size_t)vertex * 3 + 2];
    s.x1[(size_t)vertex * 3 + 2] = z + (2.0 - z) / time;
}

/* One region, whose detector point is far below: what looks upwards is PLUS. */
static cscd_plan *plan_from_below(const cscd_mesh *mesh) {
    static const double below[3] = {3, 3, -1000};
    uint32_t *regions = calloc(s.triangle_count, sizeof *regions);
    cscd_plan *plan = NULL;
    const cscd_plan_parts parts = {CSCD_METHOD_SINGLE, 1, regions, below, NULL, NULL, NULL};
    assert_int_equal(plan_from_parts_packed(mesh, s.x0, &parts, &plan), CSCD_OK);
    free(regions);
    return plan;
}

typedef struct earliest_outcome {
    rig r;
    cscd_contacts contacts;
} earliest_outcome;

static earliest_outcome run_earliest(cscd_method method, uint32_t threads, size_t longest) {
    earliest_outcome out = {.r = rig_create(&s, threads, NULL)};
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.mode = CSCD_MODE_EARLIEST;
    options.longest_list = longest;
    cscd_plan *plan = plan_from_below(out.r.mesh);
    cscd_detector_destroy(out.r.detector);
    assert_int_equal(detector_create_here(out.r.mesh, plan, &options, &out.r.detector), CSCD_OK);
    cscd_plan_destroy(plan);
    assert_int_equal(step_packed(out.r.detector, s.x0, s.x1, &out.contacts), CSCD_OK);
    return out;
}

static bool is_between(const cscd_contact *contact, uint32_t a, uint32_t b) {
    bool found[2] = {false, false};
    for (int i = 0; i < 4; i++) {
        found[0] |= contact->vertices[i] == a;
        found[1] |= contact->vertices[i] == b;
    }
    return found[0] && found[1];
}

/* Checks that the list is that of brute force for any number of threads and with a cap. Returns how many of its contacts
 * are between two vertices. */
static uint32_t check_lists(uint32_t a, uint32_t b) {
    uint32_t between = 0;
    earliest_outcome truth = run_earliest(CSCD_METHOD_BRUTE, 1, 0);
    for (uint32_t i = 0; i < 6; i++) {
        earliest_outcome found =
            run_earliest(i < 5 ? CSCD_METHOD_SINGLE : CSCD_METHOD_NONE, 1 + i % 3, i > 2 ? 5000 : 0);
        assert_int_equal(found.contacts.count, truth.contacts.count);
        assert_memory_equal(found.contacts.items, truth.contacts.items,
                            truth.contacts.count * sizeof(cscd_contact));
        cscd_guarantee g = cscd_detector_guarantee(found.r.detector, 0);
        assert_true(!g.complete && g.reason == CSCD_REASON_EARLIEST);
        if (i < 5) assert_true(cscd_detector_counters(found.r.detector).plus > 0);
        rig_destroy(&found.r);
    }
    for (size_t i = 0; i < truth.contacts.count; i++) between += is_between(&truth.contacts.items[i], a, b);
    rig_destroy(&truth.r);
    return between;
}

/* ---- tests --------------------------------------------------------------------------------------------- */

TEST(three_sheets_at_once) {
    make_hook();
    pass_through(vertex_of(4, RISES), 0.5);
    pass_through(vertex_of(4, FALLS), 0.5);
    assert_true(check_lists(vertex_of(4, RISES), vertex_of(4, FALLS)) > 0);
}

/* The three come together half of a billionth after the first contact, which is elsewhere. */
TEST(three_sheets_after_the_first) {
    make_hook();
    pass_through(vertex_of(2, FALLS), 0.5);
    pass_through(vertex_of(6, RISES), 0.5 + 0.5e-9);
    pass_through(vertex_of(6, FALLS), 0.5 + 0.5e-9);
    assert_true(check_lists(vertex_of(6, RISES), vertex_of(6, FALLS)) > 0);
}

/* Two billionths after the first are too late. */
TEST(three_sheets_too_late) {
    make_hook();
    pass_through(vertex_of(2, FALLS), 0.5);
    pass_through(vertex_of(6, RISES), 0.5 + 2.5e-9);
    pass_through(vertex_of(6, FALLS), 0.5 + 2.5e-9);
    assert_int_equal(check_lists(vertex_of(6, RISES), vertex_of(6, FALLS)), 0);
}
