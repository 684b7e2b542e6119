/* Trackers with mistakes, changed bytes, failing allocations and long recordings. */
#include "tests/support/counting_allocator.h"
#include "tests/support/events/recording_oracle.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef SLOW_MACHINE
enum { FUZZED = 30 };
#else
enum { FUZZED = 200 };
#endif

/* ---- mistakes ------------------------------------------------------------------------------------------- */

static void expect_refused(const recorded_frames *r, cscd_status status, const char *words) {
    const char *detail = cscd_context_detail(r->context);
    assert_int_equal(status, CSCD_INVALID_ARGUMENT);
    if (strstr(detail, words) == NULL) fail_msg("\"%s\" has no \"%s\"", detail, words);
}

static void options_that_cannot_be(void **state) {
    (void)state;
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

static void frames_of_another_mesh(void **state) {
    (void)state;
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
    depth.depth = NAN;
    expect_refused_frame(&r, &with_depth, "depth 0");
    const cscd_depth wrong[] = {{.triangle = 1000}, {.edge = 1000}, {.face = 1000}};
    for (size_t i = 0; i < 3; i++) {
        depth = wrong[i];
        expect_refused_frame(&r, &with_depth, "depth 0");
    }
    recorded_frames_free(&r);
}

static void calls_out_of_order(void **state) {
    (void)state;
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

/* ---- bytes that were changed ---------------------------------------------------------------------------- */

static void mix_number(uint64_t *hash, uint64_t number) {
    *hash = (*hash ^ number) * 0x9e3779b97f4a7c15u;
    *hash ^= *hash >> 29;
}

/* Makes the last number fit, so that what is inside has to be seen to be wrong. */
static void sign_bytes(uint8_t *bytes, size_t size) {
    uint64_t hash = 0, number = 0;
    for (size_t i = 0; i + 8 < size; i++) {
        number |= (uint64_t)bytes[i] << 8 * (i % 8);
        if (i % 8 < 7) continue;
        mix_number(&hash, number);
        number = 0;
    }
    for (int i = 0; i < 8; i++) bytes[size - 8 + (size_t)i] = (uint8_t)(hash >> 8 * i);
}

static void change_bytes(uint8_t *bytes, size_t size) {
    for (int n = random_integer(1, 3); n > 0; n--) {
        size_t at = (size_t)random_integer(0, (int)(size / 8) - 1) * 8;
        bool wild = random_integer(0, 2) == 0;
        uint8_t *byte = &bytes[at + (wild ? (size_t)random_integer(0, 7) : 0)];
        *byte = (uint8_t)(wild ? random_bits() : *byte + (uint8_t)random_integer(-3, 3));
    }
}

/* What is loaded in spite of a change must serve all calls. */
static void use_tracker(const recorded_frames *r, cscd_event_tracker *tracker, uint32_t begin) {
    cscd_event_tracker *next = recorded_tracker(r, true);
    cscd_events events;
    recorded_frames_add(r, next, begin, r->frame_count);
    cscd_event_tracker_merge(tracker, next);
    cscd_event_tracker_add_frame(tracker, UINT64_MAX, &r->frames[0].found);
    assert_int_equal(cscd_event_tracker_take(tracker, &events), CSCD_OK);
    assert_int_equal(cscd_event_tracker_finish(tracker, &events), CSCD_OK);
    cscd_event_tracker_destroy(next);
}

static void changed_bytes_are_refused(void **state) {
    (void)state;
    size_t loaded = 0;
    for (uint64_t seed = 0; seed < FUZZED; seed++) {
        recorded_frames r;
        random_seed(seed);
        recorded_frames_create(&r, NULL, 8);
        bool later = random_integer(0, 1) == 0;
        cscd_event_tracker *tracker = recorded_tracker(&r, later), *target = recorded_tracker(&r, later);
        const uint8_t *bytes, *after;
        size_t size, size_after;
        recorded_frames_add(&r, tracker, 0, 5);
        recorded_frames_add(&r, target, 0, 2);
        assert_int_equal(cscd_event_tracker_save(tracker, &bytes, &size), CSCD_OK);
        uint8_t *changed = malloc(size), *before;
        assert_non_null(changed);
        assert_int_equal(cscd_event_tracker_save(target, &after, &size_after), CSCD_OK);
        before = malloc(size_after);
        assert_non_null(before);
        memcpy(before, after, size_after);
        for (size_t cut = 0; cut<size; cut += size> 400 ? size / 50 : 1)
            assert_int_equal(cscd_event_tracker_load(target, bytes, cut), CSCD_INVALID_ARGUMENT);
        for (size_t bit = (size_t)random_integer(0, 60); bit < 8 * size; bit += 61) {
            memcpy(changed, bytes, size);
            changed[bit / 8] = (uint8_t)(changed[bit / 8] ^ 1u << bit % 8);
            assert_int_equal(cscd_event_tracker_load(target, changed, size), CSCD_INVALID_ARGUMENT);
        }
        assert_int_equal(cscd_event_tracker_save(target, &after, &size_after), CSCD_OK);
        assert_memory_equal(after, before, size_after);
        for (int i = 0; i < 100; i++) {
            memcpy(changed, bytes, size);
            change_bytes(changed, size);
            sign_bytes(changed, size);
            if (cscd_event_tracker_load(target, changed, size) != CSCD_OK) continue;
            loaded++;
            use_tracker(&r, target, 5);
        }
        free(before);
        free(changed);
        cscd_event_tracker_destroy(target);
        cscd_event_tracker_destroy(tracker);
        recorded_frames_free(&r);
    }
    assert_true(loaded > FUZZED); /* so the signature is right, and the checks inside were reached */
}

/* A state with known places: numbers of 64 bits in the header, 22 of each event, 4 of each stamp, and the signature. */
typedef struct known_state {
    recorded_frames r;
    cscd_event_tracker *target;
    uint8_t bytes[1 << 16];
    size_t size;
    size_t first_closed, stamps,
        stamp_count; /* where they begin, and how many stamps of the last frames there are */
} known_state;

static uint64_t number_at(const uint8_t *bytes, size_t place) {
    uint64_t number = 0;
    for (int i = 0; i < 8; i++) number |= (uint64_t)bytes[8 * place + (size_t)i] << 8 * i;
    return number;
}

static size_t count_at(const uint8_t *bytes, size_t place) {
    return (size_t)number_at(bytes, place);
}

static void make_known_state(known_state *s) {
    enum { HEADER = 11, OF_EVENT = 22, OF_STAMP = 4 };
    const uint8_t *bytes;
    random_seed(11);
    recorded_frames_create(&s->r, NULL, 8);
    s->r.options.gap = 1;
    cscd_event_tracker *tracker = recorded_tracker(&s->r, false);
    s->target = recorded_tracker(&s->r, false);
    recorded_frames_add(&s->r, tracker, 0, 8);
    assert_int_equal(cscd_event_tracker_save(tracker, &bytes, &s->size), CSCD_OK);
    assert_true(s->size <= sizeof s->bytes);
    memcpy(s->bytes, bytes, s->size);
    s->first_closed = HEADER + OF_EVENT * count_at(bytes, 7);
    s->stamps = s->first_closed + OF_EVENT * count_at(bytes, 8) + OF_STAMP * count_at(bytes, 9);
    s->stamp_count = count_at(bytes, 10);
    assert_true(count_at(bytes, 8) > 1 && s->stamp_count > 1);
    cscd_event_tracker_destroy(tracker);
}

static void expect_loaded(known_state *s, size_t place, uint64_t number, cscd_status expected) {
    uint8_t changed[sizeof s->bytes];
    memcpy(changed, s->bytes, s->size);
    for (int i = 0; i < 8; i++) changed[8 * place + (size_t)i] = (uint8_t)(number >> 8 * i);
    sign_bytes(changed, s->size);
    assert_int_equal(cscd_event_tracker_load(s->target, changed, s->size), expected);
}

static void wrong_numbers_are_refused(void **state) {
    (void)state;
    static known_state s;
    make_known_state(&s);
    size_t second = s.stamps + 4;
    expect_loaded(&s, second, number_at(s.bytes, second), CSCD_OK);
    expect_loaded(&s, second, number_at(s.bytes, second) + 1, CSCD_INVALID_ARGUMENT);       /* other parts */
    expect_loaded(&s, second + 1, 5, CSCD_INVALID_ARGUMENT);                                /* too old */
    expect_loaded(&s, second + 1, 8, CSCD_INVALID_ARGUMENT);                                /* not yet */
    expect_loaded(&s, second + 2, number_at(s.bytes, s.stamps + 2), CSCD_INVALID_ARGUMENT); /* twice */
    expect_loaded(&s, s.stamps + 4 * s.stamp_count - 2, 1000, CSCD_INVALID_ARGUMENT); /* no such vertex */
    expect_loaded(&s, second + 3, number_at(s.bytes, 7), CSCD_INVALID_ARGUMENT);      /* no such event */
    expect_loaded(&s, s.first_closed + 2, 7, CSCD_INVALID_ARGUMENT);                  /* it may go on */
    expect_loaded(&s, s.first_closed + 2, 8, CSCD_INVALID_ARGUMENT);                  /* not yet */
    expect_loaded(&s, s.first_closed + 10, UINT64_C(0x7ff8) << 48, CSCD_INVALID_ARGUMENT); /* no length */
    expect_loaded(&s, s.first_closed + 16, 1000, CSCD_INVALID_ARGUMENT); /* no such triangle */
    expect_loaded(&s, 2, 1, CSCD_INVALID_ARGUMENT);                      /* a later chunk */
    expect_loaded(&s, 6, 0, CSCD_INVALID_ARGUMENT);                      /* frames */
    cscd_event_tracker_destroy(s.target);
    recorded_frames_free(&s.r);
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

static void allocations_that_fail(void **state) {
    (void)state;
    size_t failed = 0;
    for (uint64_t seed = 0; seed < 8; seed++) {
        counting_allocator counter = counting_allocator_start();
        cscd_allocator allocator = counting_allocator_interface(&counter);
        recorded_frames r;
        random_seed(seed);
        recorded_frames_create(&r, &allocator, 10);
        cscd_event_tracker *tracker = NULL, *next = NULL, *loaded = NULL;
        cscd_event_options later = r.options;
        later.later_chunk = true;
        WITH_FAILURES(counter, failed, cscd_event_tracker_create(r.context, r.mesh, &r.options, &tracker));
        WITH_FAILURES(counter, failed, cscd_event_tracker_create(r.context, r.mesh, &later, &next));
        assert_int_equal(cscd_event_tracker_create(r.context, r.mesh, &later, &loaded), CSCD_OK);
        for (uint32_t i = 0; i < r.frame_count; i++) {
            const recorded_frame *f = &r.frames[i];
            cscd_event_tracker *to = i < 5 ? tracker : next;
            WITH_FAILURES(counter, failed,
                          cscd_event_tracker_add_contacts(to, f->contacts, f->contact_count));
            WITH_FAILURES(counter, failed,
                          cscd_event_tracker_add_frame(to, f->number, f->looked ? &f->found : NULL));
        }
        const uint8_t *bytes;
        size_t size, count;
        cscd_events events;
        WITH_FAILURES(counter, failed, cscd_event_tracker_save(next, &bytes, &size));
        WITH_FAILURES(counter, failed, cscd_event_tracker_load(loaded, bytes, size));
        WITH_FAILURES(counter, failed, cscd_event_tracker_merge(tracker, loaded));
        WITH_FAILURES(counter, failed, cscd_event_tracker_finish(tracker, &events));
        cscd_event *expected = recording_oracle(&r, &count);
        assert_int_equal(events.count, count);
        assert_memory_equal(events.items, expected, count * sizeof *expected);
        free(expected);
        cscd_event_tracker_destroy(loaded);
        cscd_event_tracker_destroy(next);
        cscd_event_tracker_destroy(tracker);
        recorded_frames_free(&r);
        assert_int_equal(counter.live, 0);
    }
    assert_true(failed > 50);
}

/* A hundred times the same frames: after the first times nothing is allocated, and what is open stays bounded. */
static void long_recordings(void **state) {
    (void)state;
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_that_cannot_be),    cmocka_unit_test(frames_of_another_mesh),
        cmocka_unit_test(calls_out_of_order),        cmocka_unit_test(changed_bytes_are_refused),
        cmocka_unit_test(wrong_numbers_are_refused), cmocka_unit_test(allocations_that_fail),
        cmocka_unit_test(long_recordings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
