/* Events of bodies that move, from what a detector finds, are those of comparing everything with everything. */
#include "tests/support/events/recorded_frames.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { FLIGHTS = PACED(40, 6) };

enum { BODY_VERTICES = 26, BODY_TRIANGLES = 48, BODIES = 3 };

static const uint32_t coarse[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

static uint32_t find_point(double (*points)[3], uint32_t *count, const double x[3]) {
    for (uint32_t i = 0; i < *count; i++) {
        if (memcmp(points[i], x, sizeof points[i]) == 0) return i;
    }
    memcpy(points[*count], x, sizeof points[*count]);
    return (*count)++;
}

/* A box from -1 to 1 whose edges are halved: 26 vertices, 48 triangles. */
static void make_body(double points[BODY_VERTICES][3], uint32_t triangles[BODY_TRIANGLES * 3]) {
    static const int parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    uint32_t count = 0, made = 0;
    for (int t = 0; t < 12; t++) {
        double x[6][3];
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < 3; c++) x[k][c] = (coarse[3 * t + k] >> c & 1) * 2.0 - 1.0;
        }
        for (int k = 0; k < 3; k++) {
            for (int c = 0; c < 3; c++) x[3 + k][c] = 0.5 * (x[k][c] + x[(k + 1) % 3][c]);
        }
        for (int p = 0; p < 4; p++) {
            for (int k = 0; k < 3; k++) triangles[made++] = find_point(points, &count, x[parts[p][k]]);
        }
    }
    assert_int_equal(count, BODY_VERTICES);
}

typedef struct flight {
    double points[BODY_VERTICES][3];
    double sizes[BODIES], from[BODIES][3], speeds[BODIES][3];
} flight;

static void place_bodies(const flight *f, double time, double *x) {
    for (int b = 0; b < BODIES; b++) {
        for (int v = 0; v < BODY_VERTICES; v++) {
            for (int c = 0; c < 3; c++)
                *x++ = f->from[b][c] + time * f->speeds[b][c] + f->sizes[b] * f->points[v][c];
        }
    }
}

static void create_flight(recorded_frames *r, flight *f) {
    uint32_t triangles[BODY_TRIANGLES * 3];
    cscd_object_desc objects[BODIES];
    make_body(f->points, triangles);
    for (int b = 0; b < BODIES; b++) {
        objects[b] = cscd_object_of_triangles(BODY_VERTICES, BODY_TRIANGLES, triangles);
        f->sizes[b] = random_between(0.3, 1.0);
        for (int c = 0; c < 3; c++) {
            f->from[b][c] = random_between(-2.0, 2.0);
            f->speeds[b][c] = -2.0 * f->from[b][c] + random_between(-0.5, 0.5);
        }
    }
    assert_int_equal(cscd_context_create(NULL, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, objects, BODIES, &r->mesh), CSCD_OK);
    r->options = cscd_event_defaults();
    r->options.rings = (uint32_t)random_integer(0, 4);
    r->options.gap = (uint32_t)random_integer(0, 1);
}

static void record_flight(recorded_frames *r, const flight *f) {
    enum { COORDINATES = BODIES * BODY_VERTICES * 3 };
    double x0[COORDINATES], x1[COORDINATES];
    cscd_detector *detector = NULL;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = random_integer(0, 2) > 0;
    options.patches = options.depths = options.curves && random_integer(0, 2) > 0;
    assert_int_equal(cscd_detector_create(r->context, r->mesh, NULL, NULL, &detector), CSCD_OK);
    r->frame_count = 12;
    for (uint32_t i = 0; i < r->frame_count; i++) {
        cscd_contacts contacts = {0};
        cscd_intersections found;
        recorded_frame *frame = &r->frames[i];
        frame->number = i;
        place_bodies(f, (i - 1.0) / 11.0, x0);
        place_bodies(f, i / 11.0, x1);
        if (i > 0)
            assert_int_equal(cscd_detector_step(detector, CSCD_DOUBLES(x0, COORDINATES / 3),
                                                CSCD_DOUBLES(x1, COORDINATES / 3), &contacts),
                             CSCD_OK);
        recorded_frames_copy(frame, NULL, &contacts);
        assert_int_equal(
            cscd_detector_find_intersections(detector, CSCD_DOUBLES(x1, COORDINATES / 3), &options, &found),
            CSCD_OK);
        cscd_contacts kept = {.items = frame->contacts, .count = frame->contact_count};
        cscd_contact *copied = frame->contacts;
        recorded_frames_copy(frame, &found, &kept);
        free(copied);
    }
    cscd_detector_destroy(detector);
}

/* Three boxes fly through each other. Where something is buried in every frame from the first crossing to the last, that
 * is one event. */
TEST(bodies_that_move) {
    size_t deep = 0, long_ones = 0;
    for (uint64_t seed = 0; seed < FLIGHTS; seed++) {
        recorded_frames r = {.frame_count = 0};
        flight f;
        random_seed(seed);
        create_flight(&r, &f);
        record_flight(&r, &f);
        cscd_event_tracker *tracker = recorded_tracker(&r);
        recorded_frames_add(&r, tracker, 0, r.frame_count);
        cscd_events found;
        size_t count;
        cscd_event *expected = recording_oracle(&r, &count);
        assert_int_equal(cscd_event_tracker_finish(tracker, &found), CSCD_OK);
        assert_int_equal(found.count, count);
        if (count > 0) assert_memory_equal(found.items, expected, count * sizeof *expected);
        for (size_t i = 0; i < count; i++) {
            deep += expected[i].depth > 0.1;
            long_ones += expected[i].last_frame > expected[i].first_frame + 2;
        }
        free(expected);
        cscd_event_tracker_destroy(tracker);
        recorded_frames_free(&r);
    }
    assert_true(deep >= FLIGHTS / 3 && long_ones >= FLIGHTS / 2);
}
