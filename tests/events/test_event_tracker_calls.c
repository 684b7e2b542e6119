/* Trackers with mistakes, failing allocations and long recordings. */
#include "tests/support/counting_allocator.h"
#include "tests/support/events/recording_oracle.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- mistakes ------------------------------------------------------------------------------------------- */

static void expect_refused(const recorded_frames *r, cscd_status status, const char *words) {
    const char *detail = cscd_context_detail(r->context);
    assert_int_equal(status, CSCD_INVALID_ARGUMENT);
    if (strstr(detail, words) == NULL) fail_msg("\"%s\" has no \"%s\"", detail, words);
}

TEST(options_that_cannot_be) {
    recorded_frames r;
    random_seed(1);
    recorded_frames_create(&r, NULL, 0);
    cscd_event_tracker *none = NULL;
    cscd_event_options options = cscd_event_defaults();
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, NULL, NULL), "out is NULL");
    options.struct_size = 4;
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, &options, &none), "cscd_event_defaults");
    options = cscd_event_defaults();
    options.part_count = 2;
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, &options, &none), "labels is NULL");
    options.labels = r.labels;
    r.labels[7] = 2;
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, &options, &none), "triangle 7");
    options = cscd_event_defaults();
    options.seam_count = 1;
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, &options, &none), "seams is NULL");
    options.seams = r.seams;
    r.seams[1] = 1000;
    expect_refused(&r, cscd_event_tracker_create(r.context, r.mesh, &options, &none), "vertex 1000");
    assert_null(none);
    recorded_frames_free(&r);
}

static void expect_refused_frame(const recorded_frames *r, const cscd_intersection_pairs *found,
                                 const char *words) {
    cscd_event_tracker *tracker = recorded_tracker(r, false);
    expect_refused(r, cscd_event_tracker_add_frame(tracker, 0, found), words);
    assert_int_equal(cscd_event_tracker_add_frame(tracker, 0, NULL), CSCD_OK);
    cscd_event_tracker_destroy(tracker);
}

TEST(frames_of_another_mesh) {
    recorded_frames r;
    random_seed(2);
    recorded_frames_create(&r, NULL, 0);
    const cscd_intersection_pair far_pair = {.a = 0, .b = 1000};
    cscd_curve curve = {.point_count = 1, .piece_count = 2};
    cscd_curve_point points[2] = {{.edge = 0}};
    cscd_curve_piece pieces[2] = {{0, 1}, {1, 2}};
    cscd_depth depth = {.vertex = 1000};
    expect_refused_frame(&r, &(cscd_intersection_pairs){.count = 3}, "ask for CSCD_ANSWER_LIST");
    expect_refused_frame(&r, &(cscd_intersection_pairs){.items = &far_pair, .count = 1}, "pair 0");
    cscd_curves curves = {.items = &curve, .count = 1, .points = points, .pieces = pieces};
    curves.point_count = curves.piece_count = 2;
    const cscd_intersection_pairs with_curve = {.curves = &curves};
    expect_refused_frame(&r, &with_curve, "curve 0");
    curve.point_count = 3;
    expect_refused_frame(&r, &with_curve, "curve 0");
    curve.point_count = 2;
    pieces[1].b = 1000;
    expect_refused_frame(&r, &with_curve, "curve 0");
    pieces[1].b = 2;
    points[1].x[2] = NAN;
    expect_refused_frame(&r, &with_curve, "curve 0");
    cscd_depths depths = {.items = &depth, .count = 1};
    const cscd_intersection_pairs with_depth = {.depths = &depths};
    expect_refused_frame(&r, &with_depth, "depth 0");
    depth.vertex = 0;
    static const double wrong_depths[] = {NAN, INFINITY, -0.5};
    for (size_t i = 0; i < 3; i++) {
        depth.depth = wrong_depths[i];
        expect_refused_frame(&r, &with_depth, "depth 0");
    }
    const cscd_depth wrong[] = {{.triangle = 1000}, {.edge = 1000}, {.face = 1000}};
    for (size_t i = 0; i < 3; i++) {
        depth = wrong[i];
        expect_refused_frame(&r, &with_depth, "depth 0");
    }
    recorded_frames_free(&r);
}

TEST(calls_out_of_order) {
    recorded_frames r;
    random_seed(3);
    recorded_frames_create(&r, NULL, 0);
    cscd_event_tracker *first = recorded_tracker(&r, false), *second = recorded_tracker(&r, true);
    cscd_events events;
    const cscd_contact contact = {.kind = CSCD_CONTACT_EE, .a = 0, .b = 9}, bad = {.kind = CSCD_CONTACT_TT};
    const uint8_t *bytes = NULL;
    size_t size = 0;
    expect_refused(&r, cscd_event_tracker_add_contacts(first, &bad, 1), "contact 0");
    expect_refused(&r, cscd_event_tracker_add_contacts(first, NULL, 1), "contacts is NULL");
    assert_int_equal(cscd_event_tracker_add_contacts(first, NULL, 0), CSCD_OK);
    assert_int_equal(cscd_event_tracker_add_contacts(first, &contact, 1), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_finish(first, &events), "1 contacts wait");
    expect_refused(&r, cscd_event_tracker_save(first, &bytes, &size), "1 contacts wait");
    expect_refused(&r, cscd_event_tracker_merge(first, second), "1 contacts wait");
    expect_refused(&r, cscd_event_tracker_take(first, NULL), "out is NULL");
    expect_refused(&r, cscd_event_tracker_finish(first, NULL), "out is NULL");
    expect_refused(&r, cscd_event_tracker_save(first, NULL, &size), "bytes is NULL");
    expect_refused(&r, cscd_event_tracker_load(first, NULL, 0), "bytes is NULL");
    assert_int_equal(cscd_event_tracker_add_frame(first, 5, NULL), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_add_frame(first, 5, NULL), "does not come after frame 5");
    assert_int_equal(cscd_event_tracker_add_frame(second, 5, NULL), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_merge(first, second), "begins with frame 5");
    expect_refused(&r, cscd_event_tracker_merge(first, first), "with itself");
    expect_refused(&r, cscd_event_tracker_merge(second, first), "without later_chunk");
    cscd_event_options other = r.options;
    other.rings++;
    other.later_chunk = true;
    cscd_event_tracker *stranger = NULL;
    assert_int_equal(cscd_event_tracker_create(r.context, r.mesh, &other, &stranger), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_merge(first, stranger), "different meshes");
    assert_int_equal(cscd_event_tracker_save(stranger, &bytes, &size), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_load(second, bytes, size), "of another mesh");
    assert_int_equal(cscd_event_tracker_finish(first, &events), CSCD_OK);
    assert_int_equal(events.count, 1);
    assert_int_equal(events.items[0].first_frame, 5);
    cscd_event_tracker_destroy(stranger);
    cscd_event_tracker_destroy(second);
    cscd_event_tracker_destroy(first);
    recorded_frames_free(&r);
}

/* Each of these rules joins frames in another way, so trackers that have different ones do not fit together. */
TEST(trackers_of_other_rules) {
    recorded_frames r;
    random_seed(4);
    recorded_frames_create(&r, NULL, 0);
    static uint32_t labels[2][64];
    static const uint32_t seam[2] = {0, 3};
    cscd_event_tracker *trackers[6];
    assert_true(cscd_mesh_triangle_count(r.mesh) <= 64);
    labels[1][40] = 1;
    for (int i = 0; i < 6; i++) {
        cscd_event_options options = cscd_event_defaults();
        options.later_chunk = true;
        options.gap = i == 1;
        options.rings = i == 2 ? 1 : 2;
        options.labels = i == 3 ? labels[0] : i == 4 ? labels[1] : NULL;
        options.part_count = i == 3 || i == 4 ? 2 : 0;
        options.seams = seam;
        options.seam_count = i == 5;
        assert_int_equal(cscd_event_tracker_create(r.context, r.mesh, &options, &trackers[i]), CSCD_OK);
    }
    for (int i = 0; i < 36; i++) {
        const uint8_t *bytes;
        size_t size;
        cscd_event_tracker *to = trackers[i / 6], *from = trackers[i % 6];
        if (to == from) continue;
        expect_refused(&r, cscd_event_tracker_merge(to, from),
                       "different meshes, rings, gaps, labels or seams");
        assert_int_equal(cscd_event_tracker_save(from, &bytes, &size), CSCD_OK);
        expect_refused(&r, cscd_event_tracker_load(to, bytes, size), "of other rings, gaps, labels or seams");
    }
    for (int i = 0; i < 6; i++) cscd_event_tracker_destroy(trackers[i]);
    recorded_frames_free(&r);
}

/* ---- solids --------------------------------------------------------------------------------------------- */

/* Two parts are copies of one solid. That is said where pairs of theirs lie on each other, not where they only touch. */
TEST(copies_are_said_of_pairs) {
    recorded_frames r;
    random_seed(5);
    recorded_frames_create(&r, NULL, 0);
    cscd_event_options options = cscd_event_defaults();
    cscd_event_tracker *tracker = NULL;
    cscd_events events;
    const uint32_t last = cscd_mesh_object(r.mesh, 0).vertex_count - 1,
                   other = cscd_mesh_object(r.mesh, 0).triangle_count;
    const cscd_intersection_pair pair = {.a = 0, .b = other, .kind = CSCD_INTERSECTION_COPLANAR};
    const cscd_contact contact = {.kind = CSCD_CONTACT_VF, .a = last, .b = other + 15};
    const cscd_part_pair copies = {.a = 0, .b = 1, .same_solid = true};
    const cscd_part_pairs parts = {.items = &copies, .count = 1};
    const cscd_intersection_pairs found = {.items = &pair, .count = 1, .parts = &parts};
    options.rings = 0;
    assert_int_equal(cscd_event_tracker_create(r.context, r.mesh, &options, &tracker), CSCD_OK);
    assert_int_equal(cscd_event_tracker_add_contacts(tracker, &contact, 1), CSCD_OK);
    assert_int_equal(cscd_event_tracker_add_frame(tracker, 0, &found), CSCD_OK);
    assert_int_equal(cscd_event_tracker_finish(tracker, &events), CSCD_OK);
    assert_int_equal(events.count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_true(events.items[i].a == 0 && events.items[i].b == 1);
        assert_int_equal(events.items[i].pairs, i == 0);
        assert_int_equal(events.items[i].contacts, i == 1);
        assert_int_equal((events.items[i].kinds & CSCD_EVENT_SAME_SOLID) != 0, i == 0);
    }
    cscd_event_tracker_destroy(tracker);
    recorded_frames_free(&r);
}

/* ---- memory --------------------------------------------------------------------------------------------- */

/* Makes a call with the first, the second ... allocation refused until it succeeds. */
#define WITH_FAILURES(counter, failed, call)                                                                 \
    do {                                                                                                     \
        for (size_t n = 0;; n++) {                                                                           \
            (counter).fail_at = (counter).calls + n;                                                         \
            cscd_status status = (call);                                                                     \
            (counter).fail_at = SIZE_MAX;                                                                    \
            if (status == CSCD_OK) break;                                                                    \
            assert_int_equal(status, CSCD_OUT_OF_MEMORY);                                                    \
            (failed)++;                                                                                      \
        }                                                                                                    \
    } while (0)

/* A hundred times the same frames: after the first times nothing is allocated, and what is open stays bounded. */
TEST(long_recordings) {
    enum { FRAMES = 12, TIMES = 100 };
    for (uint64_t seed = 0; seed < 10; seed++) {
        counting_allocator counter = counting_allocator_start();
        cscd_allocator allocator = counting_allocator_interface(&counter);
        recorded_frames r;
        random_seed(seed);
        recorded_frames_create(&r, &allocator, FRAMES);
        cscd_event_tracker *tracker = recorded_tracker(&r, seed % 2 == 0);
        size_t calls = 0, events_taken = 0;
        for (uint64_t time = 0; time < TIMES; time++) {
            if (time == TIMES / 2) calls = counter.calls;
            for (uint32_t i = 0; i < FRAMES; i++) {
                const recorded_frame *f = &r.frames[i];
                cscd_events events;
                assert_int_equal(cscd_event_tracker_add_contacts(tracker, f->contacts, f->contact_count),
                                 CSCD_OK);
                assert_int_equal(
                    cscd_event_tracker_add_frame(tracker, time * 100 + i, f->looked ? &f->found : NULL),
                    CSCD_OK);
                assert_int_equal(cscd_event_tracker_take(tracker, &events), CSCD_OK);
                events_taken += events.count;
            }
        }
        assert_int_equal(counter.calls, calls);
        assert_true(events_taken > 0 || r.options.gap > 0 || r.options.rings > 2);
        cscd_event_tracker_destroy(tracker);
        recorded_frames_free(&r);
        assert_int_equal(counter.live, 0);
    }
}
