/* Trackers with mistakes, failing allocations and long recordings. */
#include "runtime/events/events.h"
#include "tests/support/calls.h"
#include "tests/support/events/recorded_frames.h"
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

static void expect_refused_frame(const recorded_frames *r, const cscd_intersections *found,
                                 const char *words) {
    cscd_event_tracker *tracker = recorded_tracker(r);
    expect_refused(r, cscd_event_tracker_add_frame(tracker, 0, found), words);
    assert_int_equal(cscd_event_tracker_add_frame(tracker, 0, NULL), CSCD_OK);
    cscd_event_tracker_destroy(tracker);
}

TEST(frames_of_another_mesh) {
    recorded_frames r;
    random_seed(2);
    recorded_frames_create(&r, NULL, 0);
    const cscd_intersection far_pair = {.a = 0, .b = 1000};
    cscd_curve curve = {.point_count = 1, .piece_count = 2};
    cscd_curve_point points[2] = {{.edge = 0}};
    cscd_curve_piece pieces[2] = {{0, 1}, {1, 2}};
    cscd_depth depth = {.vertex = 1000};
    expect_refused_frame(&r, &(cscd_intersections){.count = 3}, "ask for CSCD_ANSWER_LIST");
    expect_refused_frame(&r, &(cscd_intersections){.items = &far_pair, .count = 1}, "pair 0");
    cscd_curves curves = {.items = &curve, .count = 1, .points = points, .pieces = pieces};
    curves.point_count = curves.piece_count = 2;
    const cscd_intersections with_curve = {.curves = &curves};
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
    const cscd_intersections with_depth = {.depths = &depths};
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
    cscd_event_tracker *tracker = recorded_tracker(&r);
    cscd_events events;
    const cscd_contact contact = {.kind = CSCD_CONTACT_EE, .a = 0, .b = 9}, bad = {.kind = CSCD_CONTACT_TT};
    expect_refused(&r, cscd_event_tracker_add_contacts(tracker, &bad, 1), "contact 0");
    expect_refused(&r, cscd_event_tracker_add_contacts(tracker, NULL, 1), "contacts is NULL");
    assert_int_equal(cscd_event_tracker_add_contacts(tracker, NULL, 0), CSCD_OK);
    assert_int_equal(cscd_event_tracker_add_contacts(tracker, &contact, 1), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_finish(tracker, &events), "1 contacts wait");
    expect_refused(&r, cscd_event_tracker_take(tracker, NULL), "out is NULL");
    expect_refused(&r, cscd_event_tracker_finish(tracker, NULL), "out is NULL");
    assert_int_equal(cscd_event_tracker_add_frame(tracker, 5, NULL), CSCD_OK);
    expect_refused(&r, cscd_event_tracker_add_frame(tracker, 5, NULL), "does not come after frame 5");
    assert_int_equal(cscd_event_tracker_finish(tracker, &events), CSCD_OK);
    assert_int_equal(events.count, 1);
    assert_int_equal(events.items[0].first_frame, 5);
    cscd_event_tracker_destroy(tracker);
    recorded_frames_free(&r);
}

/* In a chain of seams all vertices have the name of the least one, whatever the order of the seams. */
TEST(chains_of_seams) {
    static const uint32_t orders[6][6] = {{0, 1, 1, 2, 2, 3}, {0, 1, 2, 3, 1, 2}, {1, 2, 0, 1, 2, 3},
                                          {1, 2, 2, 3, 0, 1}, {2, 3, 0, 1, 1, 2}, {2, 3, 1, 2, 0, 1}};
    recorded_frames r;
    random_seed(4);
    recorded_frames_create(&r, NULL, 0);
    for (int i = 0; i < 6; i++) {
        mesh_rings rings;
        assert_int_equal(mesh_rings_create(r.mesh, 2, orders[i], 3, &rings), CSCD_OK);
        for (uint32_t v = 0; v < 4; v++) assert_int_equal(rings.names[v], 0);
        assert_int_equal(rings.names[4], 4);
        mesh_rings_free(r.context, &rings);
    }
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
    const cscd_intersection pair = {.a = 0, .b = other, .kind = CSCD_INTERSECTION_COPLANAR};
    const cscd_contact contact = {.kind = CSCD_CONTACT_VF, .a = last, .b = other + 15};
    const cscd_part_pair copies = {.a = 0, .b = 1, .same_solid = true};
    const cscd_part_pairs parts = {.items = &copies, .count = 1};
    const cscd_intersections found = {.items = &pair, .count = 1, .parts = &parts};
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
        cscd_event_tracker *tracker = recorded_tracker(&r);
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
