/* Events of random recordings are those of comparing everything with everything, whether they are taken at the end or on
 * the way. */
#include "tests/support/events/recorded_frames.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RECORDINGS = PACED(600, 60) };

static void print_events(const char *name, const cscd_event *events, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const cscd_event *e = &events[i];
        printf(
            "%s: parts %d %d frames %d..%d worst %d kinds %d pairs %d depths %d contacts %d depth %g length "
            "%.17g x %g %g %g triangle %d first %d\n",
            name, (int)e->a, (int)e->b, (int)e->first_frame, (int)e->last_frame, (int)e->worst_frame,
            (int)e->kinds, (int)e->pairs, (int)e->depths, (int)e->contacts, e->depth, e->length, e->x[0],
            e->x[1], e->x[2], (int)e->triangle, (int)e->first_triangle);
    }
}

static void expect_events(const cscd_event *found, size_t found_count, const cscd_event *expected,
                          size_t count) {
    if (found_count == count && (count == 0 || memcmp(found, expected, count * sizeof *found) == 0)) return;
    print_events("found", found, found_count);
    print_events("expected", expected, count);
    fail_msg("%zu events, expected %zu, or others", found_count, count);
}

static void expect_oracle(const recorded_frames *r, cscd_event_tracker *tracker) {
    size_t count;
    cscd_event *expected = recording_oracle(r, &count);
    cscd_events found;
    assert_int_equal(cscd_event_tracker_finish(tracker, &found), CSCD_OK);
    assert_int_equal(found.open, 0);
    expect_events(found.items, found.count, expected, count);
    free(expected);
}

TEST(events_are_those_of_the_oracle) {
    size_t long_ones = 0, joined = 0;
    for (uint64_t seed = 0; seed < RECORDINGS; seed++) {
        recorded_frames r;
        random_seed(seed);
        recorded_frames_create(&r, NULL, (uint32_t)random_integer(0, 12));
        cscd_event_tracker *tracker = recorded_tracker(&r);
        for (int again = 0; again < 2; again++) {
            recorded_frames_add(&r, tracker, 0, r.frame_count);
            expect_oracle(&r, tracker);
        }
        cscd_event_tracker_destroy(tracker);
        size_t count;
        cscd_event *expected = recording_oracle(&r, &count);
        for (size_t i = 0; i < count; i++) {
            long_ones += expected[i].last_frame > expected[i].first_frame;
            joined += expected[i].contacts > 0 && expected[i].pairs > 0 && expected[i].depths > 0;
        }
        free(expected);
        recorded_frames_free(&r);
    }
    assert_true(long_ones > RECORDINGS / 2 && joined > RECORDINGS / 8);
}

static int compare_events(const void *left, const void *right) {
    const cscd_event *s = left, *t = right;
    if (s->first_frame != t->first_frame) return s->first_frame < t->first_frame ? -1 : 1;
    if (s->a != t->a) return s->a < t->a ? -1 : 1;
    if (s->b != t->b) return s->b < t->b ? -1 : 1;
    return s->first_triangle < t->first_triangle ? -1 : s->first_triangle > t->first_triangle;
}

/* What is taken on the way has ended, and together it is everything. Events of loose features alone may have equal keys. */
TEST(what_is_taken_is_everything) {
    for (uint64_t seed = 0; seed < RECORDINGS; seed++) {
        recorded_frames r;
        random_seed(seed);
        recorded_frames_create(&r, NULL, 12);
        cscd_event_tracker *tracker = recorded_tracker(&r);
        cscd_event *taken = calloc(1000, sizeof *taken);
        size_t taken_count = 0, count;
        cscd_events events;
        assert_non_null(taken);
        for (uint32_t f = 0; f <= r.frame_count; f++) {
            if (f < r.frame_count) recorded_frames_add(&r, tracker, f, f + 1);
            cscd_status status = f < r.frame_count ? cscd_event_tracker_take(tracker, &events)
                                                   : cscd_event_tracker_finish(tracker, &events);
            assert_int_equal(status, CSCD_OK);
            for (size_t i = 0; i < events.count; i++) {
                taken[taken_count++] = events.items[i];
                uint32_t last = 0;
                while (r.frames[last].number != events.items[i].last_frame) last++;
                if (f < r.frame_count) assert_int_equal(last + r.options.gap + 1, f);
            }
        }
        cscd_event *expected = recording_oracle(&r, &count);
        qsort(taken, taken_count, sizeof *taken, compare_events);
        assert_int_equal(taken_count, count);
        for (size_t i = 0; i < count; i++) assert_int_equal(compare_events(&taken[i], &expected[i]), 0);
        free(expected);
        free(taken);
        cscd_event_tracker_destroy(tracker);
        recorded_frames_free(&r);
    }
}
