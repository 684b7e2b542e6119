/* Components that are collapsed at a moment: every method, at any number of threads and over whole sequences, equals brute
 * force that leaves out the same pairs; what is certified has been looked at; time and memory stay linear. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/mesh/predicates.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

enum { SEQUENCES = NIGHTLY(4, 10) };

enum { PART_COUNT = 4, FRAME_COUNT = 6 };

static scene play; /* large; one test at a time; x0 and x1 are those of the present interval */
static double rest[SCENE_VERTICES_MAX * 3], frames[FRAME_COUNT][SCENE_VERTICES_MAX * 3];
static uint32_t part_ends[PART_COUNT];
static bool collapsed[SCENE_VERTICES_MAX];

/* ---- scenes -------------------------------------------------------------------------------------------- */

/* What becomes of a part in a frame. All but the last three collapse it. */
typedef enum part_pose {
    POSE_POINT,
    POSE_LINE_ALONG_AXIS,
    POSE_LINE_ASKEW,
    POSE_FLAT, /* in a plane, where triangles keep an area, but those that are seen from the edge */
    POSE_HALF, /* half of the vertices at one place: most triangles there have no area, others do */
    POSE_SHOWN,
    POSE_COUNT
} part_pose;

static void make_parts(random_stream *random) {
    scene_clear(&play);
    for (int i = 0; i < PART_COUNT; i++) {
        if (i == 2)
            scene_add_sheet(&play, 1.0, 1.0, 2, 2);
        else
            scene_add_sphere(&play, (double[3]){0, 0, 0}, 1.0, 3 + i % 2, 3 + (int)stream_below(random, 3));
        part_ends[i] = play.vertex_count;
    }
    memcpy(rest, play.x0, sizeof rest);
}

static void pose_part(random_stream *random, int part, double *x) {
    part_pose pose = (part_pose)stream_below(random, POSE_COUNT + 3);
    uint32_t begin = part == 0 ? 0 : part_ends[part - 1], axis = stream_below(random, 3);
    double place[3], size = stream_below(random, 2) == 0 ? 1.0 : 0.75;
    for (int k = 0; k < 3; k++) place[k] = 0.5 * stream_below(random, 4);
    for (uint32_t v = begin; v < part_ends[part]; v++) {
        const double *r = rest + (size_t)v * 3;
        for (uint32_t k = 0; k < 3; k++) {
            double along = r[k] * size;
            if (pose == POSE_POINT || (pose == POSE_HALF && v % 2 == 0)) along = 0.0;
            if (pose == POSE_LINE_ALONG_AXIS && k != axis) along = 0.0;
            if (pose == POSE_LINE_ASKEW) along = r[axis] * (k == 0 ? 1.0 : k == 1 ? 0.5 : -0.25);
            if (pose == POSE_FLAT && k == axis) along = 0.0;
            x[(size_t)v * 3 + k] = place[k] + along;
        }
    }
}

static void make_frames(uint64_t seed) {
    random_stream random = stream_start(seed);
    make_parts(&random);
    for (int f = 0; f < FRAME_COUNT; f++)
        for (int part = 0; part < PART_COUNT; part++) pose_part(&random, part, frames[f]);
}

static void take_interval(int f) {
    memcpy(play.x0, frames[f], sizeof play.x0);
    memcpy(play.x1, frames[f + 1], sizeof play.x1);
}

/* ---- against brute force ------------------------------------------------------------------------------- */

typedef struct collapse_tally {
    size_t intervals, collapsed, contacts, pairs;
} collapse_tally;

static uint32_t count_collapsed(const cscd_detector *detector) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < cscd_mesh_component_count(cscd_detector_mesh(detector)); c++)
        count += cscd_detector_collapsed(detector, c);
    return count;
}

/* As the moment that is in `collapsed` has them. */
static void expect_collapsed(const rig *r) {
    for (uint32_t t = 0; t < play.triangle_count; t++)
        assert_true(cscd_detector_collapsed(r->detector, cscd_mesh_triangle_component(r->mesh, t)) ==
                    collapsed[play.triangles[t * 3]]);
}

static void check_interval(const rig *r, const oracle_list *truth, collapse_tally *sum) {
    cscd_contacts found = rig_step(r, &play);
    oracle_expect(truth, &found);
    collapsed_oracle_at_ends(&play, NULL, collapsed);
    expect_collapsed(r);
    for (uint32_t t = 0; t < play.triangle_count; t++) {
        cscd_guarantee g = cscd_detector_guarantee(r->detector, cscd_mesh_triangle_component(r->mesh, t));
        assert_true((g.reason == CSCD_REASON_COLLAPSED) == collapsed[play.triangles[t * 3]]);
        if (g.reason == CSCD_REASON_COLLAPSED) assert_false(g.complete);
    }
    sum->intervals++;
    sum->collapsed += count_collapsed(r->detector) > 0;
    sum->contacts += found.count;
}

static void check_moment(const rig *r, const double *x, collapse_tally *sum) {
    cscd_intersections found;
    size_t next = 0;
    collapsed_oracle(&play, x, NULL, collapsed);
    expect_ok(check_packed(r->detector, x, &found));
    for (uint32_t a = 0; a < play.triangle_count; a++) {
        for (uint32_t b = a + 1; b < play.triangle_count; b++) {
            const uint32_t *s = play.triangles + (size_t)a * 3, *t = play.triangles + (size_t)b * 3;
            if (collapsed[s[0]] || collapsed[t[0]] || !triangles_intersect(s, t, x)) continue;
            assert_true(next < found.count);
            assert_true(found.items[next].a == a && found.items[next].b == b);
            next++;
        }
    }
    assert_int_equal(next, found.count);
    expect_collapsed(r);
    assert_int_equal(found.collapsed, count_collapsed(r->detector));
    sum->pairs += next;
}

enum { PLAYER_COUNT = 5 };

/* A detector for each method, which plays the whole sequence. In the trees of ICCD components are mixed. */
static void make_players(uint64_t seed, rig players[PLAYER_COUNT]) {
    const cscd_method methods[PLAYER_COUNT] = {CSCD_METHOD_AUTO, CSCD_METHOD_SINGLE, CSCD_METHOD_NONE,
                                               CSCD_METHOD_BRUTE, method_or_none(CSCD_METHOD_ICCD)};
    for (uint32_t i = 0; i < PLAYER_COUNT; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[i];
        options.coherence = i == 1 ? CSCD_COHERENCE_OFF : CSCD_COHERENCE_AUTO;
        players[i] = rig_create(&play, 1 + (uint32_t)(seed + i) % 4, &options);
    }
}

/* Some check the start of each interval, others leave it to the step. */
static void play_sequence(uint64_t seed, collapse_tally *sum) {
    oracle_list truth = {0};
    rig players[PLAYER_COUNT];
    make_frames(seed);
    make_players(seed, players);
    for (int f = 0; f + 1 < FRAME_COUNT; f++) {
        take_interval(f);
        oracle_find(&play, &truth);
        for (uint32_t i = 0; i < PLAYER_COUNT; i++) {
            if ((seed + i) % 2 == 0) check_moment(&players[i], frames[f], sum);
            check_interval(&players[i], &truth, sum);
        }
    }
    for (int i = 0; i < PLAYER_COUNT; i++) rig_destroy(&players[i]);
    oracle_free(&truth);
}

TEST(methods_equal_brute_force) {
    collapse_tally sum = {0};
    for (uint64_t seed = 0; seed < SEQUENCES; seed++) play_sequence(seed, &sum);
    print_message("  %zu intervals, %zu with collapsed components; %zu contacts, %zu pairs\n", sum.intervals,
                  sum.collapsed, sum.contacts, sum.pairs);
    assert_true(sum.collapsed > sum.intervals / 3 && sum.collapsed < sum.intervals);
    assert_true(sum.contacts > 1000 && sum.pairs > 100);
}

/* A step whose list is too long says how many are collapsed, as one does that lists all. */
TEST(too_long_lists_say_it_too) {
    size_t checked = 0;
    for (uint64_t seed = 0; seed < SEQUENCES; seed++) {
        make_frames(seed);
        for (int f = 0; f + 1 < FRAME_COUNT; f++) {
            take_interval(f);
            rig r = rig_create(&play, 1 + (uint32_t)f % 2, NULL);
            const cscd_contacts found = rig_step(&r, &play);
            const size_t count = found.count;
            const uint32_t hidden = count_collapsed(r.detector);
            cscd_contacts capped;
            if (count > 1 && hidden > 0) {
                expect_ok(cscd_detector_set_longest_list(r.detector, count - 1));
                assert_int_equal(step_packed(r.detector, play.x0, play.x1, &capped), CSCD_LIST_TOO_LONG);
                assert_true(capped.count == count && capped.items == NULL);
                assert_int_equal(count_collapsed(r.detector), hidden);
                checked++;
            }
            rig_destroy(&r);
        }
    }
    assert_true(checked >= SEQUENCES);
}

/* ---- what is certified --------------------------------------------------------------------------------- */

/* A ball that shrinks to a point, or to a line, does not get there, and the way that is certified has no contact of any
 * pair. */
TEST(certified_steps_see_all) {
    for (int line = 0; line < 2; line++) {
        cscd_free_step step;
        double reached[SCENE_VERTICES_MAX * 3];
        scene_clear(&play);
        scene_add_sphere(&play, (double[3]){0, 0, 0}, 1.0, 4, 6);
        for (uint32_t i = 0; i < play.vertex_count * 3; i++)
            play.x1[i] = line == 1 && i % 3 == 0 ? play.x0[i] : 0.0;
        rig r = rig_create(&play, 2, NULL);
        expect_ok(max_step_packed(r.detector, play.x0, play.x1, reached, &step));
        assert_true(step.limited && step.fraction > 0.5 && step.fraction <= 0.8);
        collapsed_oracle(&play, reached, NULL, collapsed);
        assert_false(collapsed[0]);
        assert_int_equal(max_step_packed(r.detector, play.x1, play.x0, reached, &step), CSCD_IN_CONTACT);
        rig_destroy(&r);
    }
}

/* ---- wires ----------------------------------------------------------------------------------------------- */

/* Triangles (a, b, b') whose b' a seam joins to b are wires, and no surface that could collapse: two that cross themselves
 * are seen as ever. Without the seam they are collapsed. */
TEST(wires_do_not_collapse) {
    static const uint32_t triangles[] = {0, 1, 4, 2, 3, 5}, seams[] = {1, 4, 3, 5};
    static const double x0[] = {-1, 0, 0, 1, 0, 0, 0, -1, 1, 0, 1, 1, 1, 0, 0, 0, 1, 1};
    static const double x1[] = {-1, 0, 0, 1, 0, 0, 0, -1, -1, 0, 1, -1, 1, 0, 0, 0, 1, -1};
    scene_clear(&play);
    play.vertex_count = 6;
    play.triangle_count = 2;
    memcpy(play.triangles, triangles, sizeof triangles);
    memcpy(play.x0, x0, sizeof x0);
    memcpy(play.x1, x1, sizeof x1);
    for (int sewn = 0; sewn < 2; sewn++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = sewn == 1 ? seams : NULL;
        options.seam_count = sewn == 1 ? 2 : 0;
        rig r = rig_create(&play, 1, &options);
        cscd_contacts found = rig_step(&r, &play);
        assert_int_equal(count_collapsed(r.detector), sewn == 1 ? 0 : 2);
        assert_int_equal(found.count > 0, sewn);
        expect_ok(cscd_detector_set_seams(r.detector, sewn == 1 ? NULL : seams, sewn == 1 ? 0 : 2));
        rig_step(&r, &play);
        assert_int_equal(count_collapsed(r.detector), sewn == 1 ? 2 : 0);
        rig_destroy(&r);
    }
}

/* ---- inside ---------------------------------------------------------------------------------------------- */

/* A ball that is hidden at the centre of another one is not inside it, as it is when it is shown. */
TEST(what_is_hidden_is_in_nothing) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.overlaps = options.depths = true;
    scene_clear(&play);
    scene_add_sphere(&play, (double[3]){0, 0, 0}, 2.0, 6, 8);
    uint32_t first = play.vertex_count;
    scene_add_sphere(&play, (double[3]){0, 0, 0}, 0.5, 6, 8);
    rig r = rig_create(&play, 1, NULL);
    for (int hidden = 0; hidden < 2; hidden++) {
        cscd_intersections found;
        size_t inside = 0;
        for (uint32_t i = first * 3; hidden == 1 && i < play.vertex_count * 3; i++) play.x0[i] = 0.25;
        expect_ok(find_intersections_packed(r.detector, play.x0, &options, &found));
        for (size_t i = 0; i < found.patches->count; i++) {
            const cscd_patch *patch = &found.patches->items[i];
            for (uint32_t k = 0; k < patch->winding_count; k++)
                inside +=
                    found.patches->windings[patch->first_winding + k].number != 0 && patch->component == 1;
        }
        assert_int_equal(found.collapsed, hidden);
        assert_int_equal(inside > 0, !hidden);
        assert_int_equal(found.depths->count > 0, !hidden);
    }
    rig_destroy(&r);
}

/* A clone says of the last moment what the detector says. */
TEST(clones_say_the_same) {
    cscd_detector *clone;
    cscd_intersections moment;
    scene_clear(&play);
    scene_add_sphere(&play, (double[3]){0, 0, 0}, 1.0, 4, 6);
    rig r = rig_create(&play, 1, NULL);
    memset(play.x1, 0, sizeof play.x1);
    expect_ok(check_packed(r.detector, play.x1, &moment));
    expect_ok(cscd_detector_clone(r.context, r.detector, &clone));
    assert_true(cscd_detector_collapsed(clone, 0) && !cscd_detector_collapsed(clone, 1));
    cscd_contacts found;
    expect_ok(step_packed(clone, play.x0, play.x1, &found));
    assert_true(count_collapsed(clone) == 1 && found.count == 0);
    cscd_detector_destroy(clone);
    rig_destroy(&r);
}

/* ---- cost ------------------------------------------------------------------------------------------------ */

/* Two balls of 1,824 triangles in all, which are both hidden at the origin, cost no more pairs of boxes than when they are
 * shown apart. */
TEST(costs_no_pairs) {
    scene_clear(&play);
    scene_add_sphere(&play, (double[3]){-2, 0, 0}, 1.0, 20, 24);
    scene_add_sphere(&play, (double[3]){2, 0, 0}, 1.0, 20, 24);
    rig r = rig_create(&play, 2, NULL);
    rig_step(&r, &play);
    memset(play.x1, 0, sizeof play.x1);
    for (int i = 0; i < 3; i++) {
        cscd_intersections moment;
        cscd_contacts found = rig_step(&r, &play);
        cscd_counters counters = cscd_detector_counters(r.detector);
        assert_int_equal(count_collapsed(r.detector), 2);
        assert_int_equal(found.count, 0);
        assert_true(counters.boxes_tested == 0 && counters.pcp == 0 && counters.tests == 0);
        expect_ok(check_packed(r.detector, play.x1, &moment));
        assert_int_equal(moment.collapsed, 2);
        assert_int_equal(moment.zero_area_triangles, play.triangle_count);
        memset(play.x0, 0, sizeof play.x0);
    }
    rig_destroy(&r);
}
