/* Random changes of seams, ignored pairs and rules on a live detector, against brute force and a list of what waits. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/object_scene.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SEQUENCES = NIGHTLY(2, 3), STEPS = 6, CHANGES_MAX = 3 * STEPS + 2 };

typedef enum distance_kind { TOUCHING, SEPARATED, THICK, DISTANCE_KINDS } distance_kind;

/* How much was compared. */
typedef struct waiting_tally {
    rules_tally steps;
    size_t waiting, triangles_waiting, let_go, touched, free, near, crossing, lines;
} waiting_tally;

typedef struct waiting_run {
    rig s, all; /* all: leaves nothing out but pairs of obstacles, and never culls */
    random_stream random;
    distance_kind kind;
    random_rules sets[CHANGES_MAX]; /* one after the other: what is former is still read */
    int set_count;
    left_out wanted;
    waiting_oracle oracle;
    oracle_list truth;
    waiting_tally *sum;
} waiting_run;

static const double separation_of_all = 0.043;

/* ---- changes ------------------------------------------------------------------------------------------- */

static void want_rules(waiting_run *q, const random_rules *set) {
    random_rules *added = &q->sets[q->set_count++];
    assert_true(q->set_count <= CHANGES_MAX);
    *added = *set;
    for (int i = 0; q->kind == SEPARATED && i < SCENE_OBJECTS * SCENE_OBJECTS; i++)
        if (added->distances[i] == 0.0) added->distances[i] = separation_of_all;
    q->wanted.rules = (oracle_rules){objects_of_vertices, SCENE_OBJECTS, added->distances};
}

static void change_rules(waiting_run *q) {
    random_rules set = q->sets[q->set_count - 1];
    uint32_t kind = q->kind == THICK ? 1 + stream_below(&q->random, 2) : 0;
    if (stream_below(&q->random, 3) == 0)
        random_rules_neutral(&set);
    else
        random_rules_make(&q->random, kind, &set);
    want_rules(q, &set);
    rules_set(q->s.detector, &set);
}

/* Two vertices of features that touch somewhere, or any two. */
static void pick_vertices(waiting_run *q, uint32_t out[2]) {
    do {
        for (int i = 0; i < 2; i++) out[i] = stream_below(&q->random, objects_joined.vertex_count);
        if (q->truth.count == 0 || stream_below(&q->random, 8) == 0) continue;
        const oracle_contact *c = &q->truth.items[stream_below(&q->random, (uint32_t)q->truth.count)];
        cscd_stencil at = cscd_mesh_stencil(q->s.mesh, c->kind, c->a, c->b, 0.0, 0.0);
        out[0] = at.vertices[0];
        out[1] = at.vertices[2 + stream_below(&q->random, 2)];
    } while (out[0] == out[1]);
}

static void change_seams(waiting_run *q) {
    q->wanted.seam_count =
        stream_below(&q->random, 3) == 0 ? 0 : stream_below(&q->random, LEFT_OUT_SEAMS_MAX);
    for (size_t i = 0; i < q->wanted.seam_count; i++) pick_vertices(q, q->wanted.seams[i]);
    expect_ok(cscd_detector_set_seams(q->s.detector, &q->wanted.seams[0][0], q->wanted.seam_count));
}

/* Triangles at two vertices. */
static void change_ignored(waiting_run *q) {
    q->wanted.ignored_count =
        stream_below(&q->random, 3) == 0 ? 0 : stream_below(&q->random, LEFT_OUT_IGNORED_MAX);
    for (size_t i = 0; i < q->wanted.ignored_count; i++) {
        uint32_t at[2], count;
        pick_vertices(q, at);
        for (int k = 0; k < 2; k++) {
            const uint32_t *star = cscd_mesh_vertex_triangles(q->s.mesh, at[k], &count);
            q->wanted.ignored[i][k] = count > 0 ? star[stream_below(&q->random, count)] : 0;
        }
    }
    expect_ok(cscd_detector_set_ignored(q->s.detector, &q->wanted.ignored[0][0], q->wanted.ignored_count));
}

static void change_something(waiting_run *q) {
    switch (stream_below(&q->random, 3)) {
    case 0:
        change_rules(q);
        break;
    case 1:
        change_seams(q);
        break;
    default:
        change_ignored(q);
    }
    waiting_oracle_change(&q->oracle, &q->wanted);
}

/* ---- calls --------------------------------------------------------------------------------------------- */

static void see_positions(waiting_run *q, const double *x, bool motion_starts) {
    size_t before = waiting_oracle_features(&q->oracle);
    waiting_oracle_see(&q->oracle, x, motion_starts);
    size_t after = waiting_oracle_features(&q->oracle);
    q->sum->waiting += after;
    q->sum->triangles_waiting += waiting_oracle_triangles(&q->oracle);
    q->sum->let_go += after < before ? before - after : 0;
}

static void compare_check(waiting_run *q) {
    cscd_intersections found;
    see_positions(q, objects_motion.x0, true);
    expect_ok(check_packed(q->s.detector, objects_motion.x0, &found));
    waiting_oracle_intersections(&q->oracle, objects_motion.x0, &q->truth);
    assert_int_equal(cscd_detector_waiting(q->s.detector).triangles, waiting_oracle_triangles(&q->oracle));
    assert_int_equal(found.count, q->truth.count);
    for (size_t i = 0; i < found.count; i++) {
        assert_int_equal(found.items[i].a, q->truth.items[i].a);
        assert_int_equal(found.items[i].b, q->truth.items[i].b);
    }
    q->sum->crossing += found.count;
    q->truth.count = 0;
}

/* The list is that without exclusions, without what is left out. Nobody is let go. */
static void compare_near(waiting_run *q, const double *x, const cscd_proximities *found) {
    cscd_proximities all;
    size_t next = 0;
    expect_ok(find_near_packed(q->all.detector, x, 0.06, &all));
    for (size_t i = 0; i < all.count; i++) {
        const cscd_proximity *t = &all.items[i];
        if (waiting_oracle_covers(&q->oracle, t->kind, t->a, t->b, x)) continue;
        assert_true(next < found->count);
        expect_alike_but_separation(&found->items[next++], t);
    }
    assert_int_equal(next, found->count);
    assert_int_equal(cscd_detector_waiting(q->s.detector).features, waiting_oracle_features(&q->oracle));
    q->sum->near += found->count;
}

static void find_near(waiting_run *q, const double *x) {
    cscd_proximities found;
    see_positions(q, x, false);
    expect_ok(find_near_packed(q->s.detector, x, 0.06, &found));
    compare_near(q, x, &found);
}

static void compare_step(waiting_run *q) {
    cscd_contacts found;
    see_positions(q, objects_motion.x0, true);
    oracle_find_by_rules(&objects_motion, &q->oracle.now.what.rules, &q->truth);
    waiting_oracle_filter(&q->oracle, &q->truth);
    expect_ok(step_packed(q->s.detector, objects_motion.x0, objects_motion.x1, &found));
    expect_one_number(q->s.detector, "objects at random");
    rules_rig_compare(&q->s, &q->truth, &found, &q->sum->steps);
    assert_int_equal(cscd_detector_waiting(q->s.detector).features, waiting_oracle_features(&q->oracle));
    for (uint32_t t = 0; t < objects_joined.triangle_count; t++)
        q->sum->steps.culled += cscd_detector_orientation(q->s.detector, t) != 0;
}

/* Nothing touches on the way that is not left out; at distance 0 a step is refused where something touches at x0. */
static void check_free(waiting_run *q, cscd_status status, const double *reached) {
    static scene way;
    assert_true(status == CSCD_OK || status == CSCD_IN_CONTACT);
    assert_int_equal(cscd_detector_waiting(q->s.detector).features, waiting_oracle_features(&q->oracle));
    memcpy(&way, &objects_motion, sizeof way);
    memcpy(way.x1, status == CSCD_OK ? reached : way.x0, way.vertex_count * sizeof(double[3]));
    oracle_list touching = {0};
    random_rules none = q->sets[q->set_count - 1];
    for (int i = 0; i < SCENE_OBJECTS * SCENE_OBJECTS; i++)
        none.distances[i] = none.distances[i] < 0.0 ? -1.0 : 0.0;
    oracle_find_by_rules(&way, &(oracle_rules){objects_of_vertices, SCENE_OBJECTS, none.distances},
                         &touching);
    waiting_oracle_filter(&q->oracle, &touching);
    assert_int_equal(touching.count > 0, status == CSCD_IN_CONTACT);
    q->sum->free += status == CSCD_OK;
    q->sum->touched += status == CSCD_IN_CONTACT;
    oracle_free(&touching);
}

static void compare_max_step(waiting_run *q) {
    static double reached[SCENE_VERTICES_MAX * 3];
    cscd_free_step step;
    see_positions(q, objects_motion.x0, true);
    cscd_status status = max_step_packed(q->s.detector, objects_motion.x0, objects_motion.x1, reached, &step);
    check_free(q, status, reached);
}

/* Changes between the calls of a line hold at its start, too. */
static void compare_line(waiting_run *q) {
    static double reached[SCENE_VERTICES_MAX * 3];
    cscd_free_step step;
    cscd_proximities found;
    cscd_line_search *line;
    expect_ok(cscd_line_search_create(q->s.detector, &line));
    see_positions(q, objects_motion.x0, true);
    expect_ok(line_begin_packed(line, objects_motion.x0, objects_motion.x1, 0.06));
    if (stream_below(&q->random, 2) == 0) {
        (stream_below(&q->random, 2) == 0 ? change_seams : change_ignored)(q);
        waiting_oracle_change(&q->oracle, &q->wanted);
        see_positions(q, objects_motion.x0, false);
    }
    cscd_status status = line_max_step_packed(line, 1.0, reached, &step);
    check_free(q, status, reached);
    expect_ok(cscd_line_search_find_near(line, 1.0, 0.06, CSCD_NEAR_PAIRS, &found));
    expect_ok(line_positions_packed(line, 1.0, reached));
    compare_near(q, reached, &found);
    cscd_line_search_destroy(line);
    q->sum->lines++;
}

/* ---- sequences ----------------------------------------------------------------------------------------- */

/* Coordinates that are multiples of one number make features touch at rest. */
static void snap_scene(void) {
    for (uint32_t i = 0; i < objects_joined.vertex_count * 3; i++) {
        objects_joined.x0[i] = round(objects_joined.x0[i] * 8.0) / 8.0;
        objects_joined.x1[i] = round(objects_joined.x1[i] * 8.0) / 8.0;
    }
}

static void next_motion(random_stream *random, double *at) {
    static const double ends[] = {0.25, 0.5, 1.0};
    double end = stream_below(random, 4) == 0 ? *at : ends[stream_below(random, 3)];
    object_scene_go(*at, end);
    *at = stream_below(random, 4) == 0 ? 0.0 : end;
}

static void run_calls(waiting_run *q) {
    double at = 0.0;
    for (int step = 0; step < STEPS; step++) {
        uint32_t changes = stream_below(&q->random, 4);
        for (uint32_t i = 0; i < changes && i < 2; i++) change_something(q);
        next_motion(&q->random, &at);
        if (stream_below(&q->random, 4) == 0) find_near(q, objects_motion.x0);
        if (stream_below(&q->random, 3) == 0) compare_check(q);
        switch (stream_below(&q->random, 4)) {
        case 0:
            compare_max_step(q);
            break;
        case 1:
            compare_line(q);
            break;
        default:
            compare_step(q);
        }
        if (stream_below(&q->random, 4) == 0) find_near(q, objects_motion.x1);
    }
}

static void run_sequence(uint64_t seed, distance_kind kind, cscd_detector_options options, uint32_t threads,
                         waiting_tally *sum) {
    static waiting_run q; /* large */
    random_rules set;
    memset(&q, 0, sizeof q);
    q.random = stream_start(seed);
    q.kind = kind;
    q.sum = sum;
    object_scene_make(&q.random);
    if (kind == TOUCHING) snap_scene();
    if (kind == SEPARATED) options.min_separation = separation_of_all;
    options.seam_reach = (double)INFINITY;
    memset(set.obstacles, 0, sizeof set.obstacles);
    random_rules_neutral(&set);
    const cscd_detector_options defaults = cscd_detector_defaults();
    q.all = rules_rig(&set, &defaults, 1);
    for (int i = 0; i < SCENE_OBJECTS; i++) set.obstacles[i] = stream_below(&q.random, 4) == 0;
    random_rules_neutral(&set);
    want_rules(&q, &set);
    q.s = rules_rig(&set, &options, threads);
    q.oracle = waiting_oracle_start(q.s.mesh, &objects_joined, &q.wanted);
    run_calls(&q);
    waiting_oracle_free(&q.oracle);
    oracle_free(&q.truth);
    rig_destroy(&q.s);
    rig_destroy(&q.all);
}

static waiting_tally run_method(cscd_method method, cscd_mode mode, int sequences, uint64_t seed) {
    waiting_tally sum = {.waiting = 0};
    for (int i = 0; i < sequences; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = method;
        options.mode = mode;
        options.volume = i % 2 == 0 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
        run_sequence(seed + (uint64_t)i, (distance_kind)(i % DISTANCE_KINDS), options, 1 + (uint32_t)i % 3,
                     &sum);
    }
    print_message("  %s, %s: %zu contacts, %zu waiting, %zu let go, %zu triangle pairs waiting, %zu culled, "
                  "%zu later, %zu free, %zu touched, %zu near, %zu crossing\n",
                  cscd_method_name(method), cscd_name(CSCD_MODES, mode), sum.steps.contacts, sum.waiting,
                  sum.let_go, sum.triangles_waiting, sum.steps.culled, sum.steps.later, sum.free, sum.touched,
                  sum.near, sum.crossing);
    assert_true(sum.waiting > 100 && sum.triangles_waiting > 20);
    return sum;
}

TEST(without_culling) {
    waiting_tally none = run_method(CSCD_METHOD_NONE, CSCD_MODE_ALL, 2 * SEQUENCES, 0);
    run_method(CSCD_METHOD_BRUTE, CSCD_MODE_ALL, SEQUENCES, 100);
    run_method(method_or_none(CSCD_METHOD_ICCD), CSCD_MODE_ALL, SEQUENCES, 200);
    assert_true(none.let_go > 100 && none.free > 0 && none.touched > 0 && none.lines > 0 && none.near > 0 &&
                none.crossing > 0);
}

TEST(with_culling) {
    waiting_tally single = run_method(CSCD_METHOD_SINGLE, CSCD_MODE_ALL, 3 * SEQUENCES, 300);
    waiting_tally kmeans = run_method(CSCD_METHOD_KMEANS, CSCD_MODE_ALL, SEQUENCES, 400);
    run_method(CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST, 2 * SEQUENCES, 500);
    assert_true(single.let_go > 100 && single.steps.culled > 0 && kmeans.steps.culled > 0);
}
