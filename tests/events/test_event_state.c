/* The state of a tracker as bytes: whatever is changed in them is refused, or serves all calls. */
#include "tests/support/events/recorded_frames.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { FUZZED = PACED(200, 30) };

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

TEST(changed_bytes_are_refused) {
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

enum { HEADER = 11, OF_EVENT = 22, OF_STAMP = 4 };

static void make_known_state(known_state *s) {
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
    assert_true(count_at(bytes, 7) > 1 && count_at(bytes, 8) > 1 && s->stamp_count > 1);
    cscd_event_tracker_destroy(tracker);
}

static void expect_loaded(known_state *s, size_t place, uint64_t number, cscd_status expected) {
    uint8_t changed[sizeof s->bytes];
    memcpy(changed, s->bytes, s->size);
    for (int i = 0; i < 8; i++) changed[8 * place + (size_t)i] = (uint8_t)(number >> 8 * i);
    sign_bytes(changed, s->size);
    assert_int_equal(cscd_event_tracker_load(s->target, changed, s->size), expected);
}

/* Two events, or two stamps, of so many numbers each, that follow each other from a place on change places. */
static void expect_order_matters(known_state *s, size_t place, size_t numbers) {
    uint8_t changed[sizeof s->bytes];
    const size_t first = 8 * place, size = 8 * numbers;
    memcpy(changed, s->bytes, s->size);
    memcpy(changed + first, s->bytes + first + size, size);
    memcpy(changed + first + size, s->bytes + first, size);
    sign_bytes(changed, s->size);
    assert_int_equal(cscd_event_tracker_load(s->target, changed, s->size), CSCD_INVALID_ARGUMENT);
}

TEST(wrong_numbers_are_refused) {
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
    expect_loaded(&s, HEADER + 2, 8, CSCD_INVALID_ARGUMENT);                          /* not yet */
    expect_loaded(&s, s.first_closed + 2, 7, CSCD_INVALID_ARGUMENT);                  /* it may go on */
    expect_loaded(&s, s.first_closed + 2, 8, CSCD_INVALID_ARGUMENT);                  /* not yet */
    expect_loaded(&s, s.first_closed + 10, UINT64_C(0x7ff8) << 48, CSCD_INVALID_ARGUMENT); /* no length */
    expect_loaded(&s, s.first_closed + 16, 1000, CSCD_INVALID_ARGUMENT); /* no such triangle */
    expect_loaded(&s, 2, 1, CSCD_INVALID_ARGUMENT);                      /* a later chunk */
    expect_loaded(&s, 6, 0, CSCD_INVALID_ARGUMENT);                      /* frames */
    expect_order_matters(&s, HEADER, OF_EVENT);
    expect_order_matters(&s, s.first_closed, OF_EVENT);
    expect_order_matters(&s, s.stamps, OF_STAMP);
    cscd_event_tracker_destroy(s.target);
    recorded_frames_free(&s.r);
}
