/* What waits in a detector that moves over to another mesh: neighbours in seams that tear, and what was uncovered before
 * the change but not seen. */
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* A triangle far away, and two panels at equal positions. In the changed mesh the triangle is gone, one vertex of the
 * first panel is two, this panel has one triangle more, and a point comes last. */
enum { SIDE = 4, PANEL = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1), VERTICES = 3 + 2 * PANEL };
enum { TORN = SIDE + 1, TORN_PANEL = PANEL + 4, NEW_VERTICES = TORN_PANEL + PANEL + 1 };
enum { FIRST = 1, SECOND = 1 + TRIANGLES }; /* triangles of the panels, in the old mesh */

typedef struct torn_panels {
    counting_allocator counter;
    rig rig;
    cscd_mesh_change *change;
    cscd_detector *detector;                    /* of the rig */
    uint32_t triangles[2][(TRIANGLES + 1) * 3]; /* of a panel, whole and torn */
    uint32_t seams[PANEL][2], ignored[TRIANGLES * TRIANGLES][2];
    double x0[VERTICES * 3], now[NEW_VERTICES * 3], moved[NEW_VERTICES * 3];
} torn_panels;

static torn_panels p;

static void list_triangles(void) {
    uint32_t count = 0;
    for (uint32_t v = 0; v + SIDE < PANEL; v++) {
        const uint32_t corners[6] = {v, v + SIDE, v + 1, v + 1, v + SIDE, v + SIDE + 1};
        if (v % SIDE + 1 == SIDE) continue;
        memcpy(p.triangles[0] + count, corners, sizeof corners);
        count += 6;
    }
    memcpy(p.triangles[1], p.triangles[0], sizeof p.triangles[0]);
    for (uint32_t k = 0; k < count / 2; k++)
        if (p.triangles[1][k] == TORN) p.triangles[1][k] = PANEL;
    for (uint32_t k = 0; k < 3; k++) p.triangles[1][count + k] = PANEL + 1 + k;
}

static void place_vertex(uint32_t v, double *out) {
    const double at[3] = {v / SIDE, v % SIDE, 0.1 * sin(v * 1.3)};
    memcpy(out, at, sizeof at);
}

static void place_vertices(void) {
    static const double far[4][3] = {{50, 0, 0}, {51, 0, 0}, {50, 1, 0}, {70, 0, 0}};
    memcpy(p.x0, far, sizeof(double[9]));
    for (uint32_t v = 0; v < 2 * PANEL; v++) place_vertex(v % PANEL, p.x0 + 3 * (3 + v));
    for (uint32_t v = 0; v < PANEL; v++) place_vertex(v, p.now + 3 * v);
    for (uint32_t v = 0; v < PANEL; v++) place_vertex(v, p.now + 3 * (TORN_PANEL + v));
    place_vertex(TORN, p.now + 3 * PANEL);
    memcpy(p.now + 3 * (PANEL + 1), far, sizeof(double[9]));
    memcpy(p.now + 3 * (NEW_VERTICES - 1), far[3], sizeof far[3]);
}

/* obstacles: the panels are. */
static void begin_panels(const cscd_detector_options *options, bool obstacles) {
    const uint32_t apart[3] = {0, 1, 2};
    list_triangles();
    place_vertices();
    for (uint32_t v = 0; v < PANEL; v++) {
        p.seams[v][0] = 3 + v;
        p.seams[v][1] = 3 + PANEL + v;
    }
    for (uint32_t i = 0; i < TRIANGLES * TRIANGLES; i++) {
        p.ignored[i][0] = FIRST + i / TRIANGLES;
        p.ignored[i][1] = SECOND + i % TRIANGLES;
    }
    cscd_object_desc descs[3] = {cscd_object_of_triangles(3, 1, apart),
                                 cscd_object_of_triangles(PANEL, TRIANGLES, p.triangles[0]),
                                 cscd_object_of_triangles(PANEL, TRIANGLES, p.triangles[0])};
    descs[1].obstacle = descs[2].obstacle = obstacles;
    p.counter = counting_allocator_start();
    p.rig = rig_of_objects(context_of(0, &p.counter), descs, 3, NULL, options);
    p.detector = p.rig.detector;
}

static void change_panels(void) {
    uint32_t origins[TORN_PANEL];
    for (uint32_t v = 0; v < TORN_PANEL; v++) origins[v] = v < PANEL ? v : UINT32_MAX;
    origins[PANEL] = TORN;
    const cscd_object_desc torn = cscd_object_of_triangles(TORN_PANEL, TRIANGLES + 1, p.triangles[1]);
    const cscd_object_desc point = cscd_object_of_points(1);
    const cscd_object_change list[3] = {{.object = 0},
                                        {.object = 1, .desc = &torn, .vertex_origins = origins},
                                        {.object = UINT32_MAX, .desc = &point}};
    expect_ok(cscd_mesh_change_create(p.rig.context, p.rig.mesh, list, 3, &p.change));
    expect_ok(cscd_detector_change_mesh(p.detector, p.change));
}

static void end_panels(void) {
    cscd_mesh_change_destroy(p.change);
    p.change = NULL;
    rig_destroy(&p.rig);
    assert_int_equal(p.counter.live, 0);
}

/* ---- what a detector says that leaves out as much, and for which nothing waits ----------------------------- */

typedef struct touching_pairs {
    size_t features, triangles;
} touching_pairs;

static cscd_detector *new_detector(const cscd_detector_options *options) {
    cscd_detector *made = NULL;
    expect_ok(detector_create_here(cscd_mesh_change_mesh(p.change), NULL, options, &made));
    return made;
}

static touching_pairs pairs_at_rest(cscd_detector *d) {
    cscd_contacts contacts;
    cscd_intersections crossing;
    expect_ok(step_packed(d, p.now, p.now, &contacts));
    expect_ok(check_packed(d, p.now, &crossing));
    return (touching_pairs){contacts.count, crossing.count};
}

/* All that touches waits, none is listed; after the panels have been apart it is as for the other detector. */
static void expect_waiting(cscd_detector *other) {
    touching_pairs touching = pairs_at_rest(other);
    cscd_contacts contacts, expected;
    cscd_intersections crossing;
    assert_true(touching.features > 0 && touching.triangles > 0);
    expect_ok(step_packed(p.detector, p.now, p.now, &contacts));
    assert_int_equal(contacts.count, 0);
    assert_int_equal(cscd_detector_waiting(p.detector).features, touching.features);
    expect_ok(check_packed(p.detector, p.now, &crossing));
    assert_int_equal(crossing.count, 0);
    assert_int_equal(cscd_detector_waiting(p.detector).triangles, touching.triangles);
    memcpy(p.moved, p.now, sizeof p.moved);
    for (uint32_t v = 0; v <= PANEL; v++) p.moved[3 * v + 2] += v == PANEL ? 2.0 : 1.0;
    expect_ok(step_packed(p.detector, p.moved, p.now, &contacts));
    expect_ok(step_packed(other, p.moved, p.now, &expected));
    assert_int_equal(cscd_detector_waiting(p.detector).features, 0);
    assert_int_equal(contacts.count, expected.count);
    assert_memory_equal(contacts.items, expected.items, expected.count * sizeof *expected.items);
    cscd_detector_destroy(other);
    end_panels();
}

/* ---- seams ------------------------------------------------------------------------------------------------- */

static void see_positions(void) {
    cscd_contacts contacts;
    expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
    assert_int_equal(contacts.count, 0);
}

static void begin_seen_panels(const cscd_detector_options *options) {
    begin_panels(options, false);
    see_positions();
}

/* In the changed mesh. */
static void list_new_seams(uint32_t (*seams)[2]) {
    for (uint32_t v = 0; v < PANEL; v++) {
        seams[v][0] = v;
        seams[v][1] = TORN_PANEL + v;
    }
}

/* The second vertex is sewn to nothing, and touches what the first one is sewn to, and its neighbours there. */
TEST(a_sewn_vertex_tears) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = p.seams[0];
    options.seam_count = PANEL;
    begin_seen_panels(&options);
    change_panels();
    uint32_t seams[PANEL][2];
    list_new_seams(seams);
    options.seams = seams[0];
    expect_waiting(new_detector(&options));
}

/* What is sewn to nothing waits already, because it was ignored before. */
TEST(what_waits_still_does_after_a_tear) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = p.seams[0];
    options.seam_count = TORN + 1;
    options.ignored = p.ignored[0];
    options.ignored_count = TRIANGLES * TRIANGLES;
    begin_seen_panels(&options);
    expect_ok(cscd_detector_set_ignored(p.detector, NULL, 0));
    see_positions();
    change_panels();
    uint32_t seams[PANEL][2];
    list_new_seams(seams);
    options.seams = seams[0];
    options.ignored = NULL;
    options.ignored_count = 0;
    expect_waiting(new_detector(&options));
}

/* ---- uncovered before the change, and not seen since ------------------------------------------------------- */

static void expect_remembered(void) {
    change_panels();
    expect_waiting(new_detector(NULL));
}

TEST(opened_seams_are_remembered) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = p.seams[0];
    options.seam_count = PANEL;
    begin_seen_panels(&options);
    expect_ok(cscd_detector_set_seams(p.detector, NULL, 0));
    expect_remembered();
}

TEST(ignored_pairs_are_remembered) {
    cscd_detector_options options = cscd_detector_defaults();
    options.ignored = p.ignored[0];
    options.ignored_count = TRIANGLES * TRIANGLES;
    begin_seen_panels(&options);
    expect_ok(cscd_detector_set_ignored(p.detector, NULL, 0));
    expect_remembered();
}

TEST(rules_are_remembered) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_object_rule rules[3];
    for (int i = 0; i < 3; i++) rules[i] = cscd_object_rule_default();
    rules[1].category = 2;
    rules[2].mask = ~(uint64_t)2;
    options.rules = rules;
    options.rule_count = 3;
    begin_seen_panels(&options);
    expect_ok(cscd_detector_set_rules(p.detector, NULL, 0, NULL, 0));
    expect_remembered();
}

/* The first panel is an obstacle no more. */
TEST(freed_obstacles_wait) {
    cscd_object_rule rules[3];
    cscd_detector_options options = cscd_detector_defaults();
    for (int i = 0; i < 3; i++) rules[i] = cscd_object_rule_default();
    rules[0].category = 2;
    options.rules = rules;
    options.rule_count = 3;
    for (int with_rules = 0; with_rules < 2; with_rules++) {
        begin_panels(with_rules == 1 ? &options : NULL, true);
        see_positions();
        change_panels();
        expect_waiting(new_detector(NULL));
    }
}

/* ---- ignored pairs whose triangles change their order ------------------------------------------------------ */

TEST(reversed_triangles_stay_ignored) {
    enum { BOTH = 2 * TRIANGLES };
    uint32_t triangles[2][BOTH][3], origins[BOTH];
    cscd_detector_options options = cscd_detector_defaults();
    cscd_mesh_change *change = NULL;
    cscd_contacts contacts;
    cscd_intersections crossing;
    begin_panels(NULL, false);
    for (uint32_t t = 0; t < BOTH; t++) {
        origins[t] = BOTH - 1 - t;
        for (uint32_t k = 0; k < 3; k++)
            triangles[0][t][k] = triangles[1][BOTH - 1 - t][k] =
                p.triangles[0][t % TRIANGLES * 3 + k] + (t < TRIANGLES ? 0 : PANEL);
    }
    for (uint32_t i = 0; i < TRIANGLES * TRIANGLES; i++) {
        p.ignored[i][0] = i / TRIANGLES;
        p.ignored[i][1] = TRIANGLES + i % TRIANGLES;
    }
    const cscd_object_desc before = cscd_object_of_triangles(2 * PANEL, BOTH, triangles[0][0]);
    const cscd_object_desc after = cscd_object_of_triangles(2 * PANEL, BOTH, triangles[1][0]);
    const cscd_object_change reversed = {.object = 0, .desc = &after, .triangle_origins = origins};
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    options.ignored = p.ignored[0];
    options.ignored_count = TRIANGLES * TRIANGLES;
    expect_ok(cscd_mesh_create(p.rig.context, &before, 1, &mesh));
    expect_ok(detector_create_here(mesh, NULL, &options, &detector));
    expect_ok(cscd_mesh_change_create(p.rig.context, mesh, &reversed, 1, &change));
    expect_ok(cscd_detector_change_mesh(detector, change));
    expect_ok(step_packed(detector, p.x0 + 9, p.x0 + 9, &contacts));
    assert_true(contacts.count == 0 && cscd_detector_waiting(detector).features == 0);
    expect_ok(check_packed(detector, p.x0 + 9, &crossing));
    assert_true(crossing.count == 0 && cscd_detector_waiting(detector).triangles == 0);
    cscd_detector_destroy(detector);
    cscd_mesh_change_destroy(change);
    cscd_mesh_destroy(mesh);
    end_panels();
}
