/* Frames that hold far more than is expected of them, on small budgets: what is given is what would be given without a limit,
 * what is left out is said and is the same for any number of threads and after any other calls, and memory stays within
 * the budget and 64 bytes for each pair. */
#include "cscd/events.h"
#include "tests/support/calls.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <string.h>

enum { PAIR_SIZE = 64, WHOLE = 1 << 30, A_THREAD = 1 << 17 };

static body_rig full, without_depths, pairs_alone, rig; /* large; one test at a time */

/* ---- scenes ---------------------------------------------------------------------------------------------- */

static void add_small_shuffled(body_rig *r) {
    tangle_add_shuffled(r, 5, 6);
}

static void add_small_soup(body_rig *r) {
    tangle_add_soup(r, 120);
}

/* ---- calls ----------------------------------------------------------------------------------------------- */

static cscd_intersection_options all_answers(size_t max_memory) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.overlaps = options.cut_offs = options.depths = options.parts = true;
    options.max_memory = max_memory;
    return options;
}

static cscd_status find_with(body_rig *r, const cscd_intersection_options *options) {
    return cscd_detector_find_intersections(r->detector, CSCD_DOUBLES(r->all.x0, r->all.vertex_count),
                                            options, &r->found);
}

static bool leaves_out(const cscd_intersections *found, cscd_left_out what) {
    return (found->left_out >> what & 1) != 0;
}

static void find_references(void (*add)(body_rig *r)) {
    body_rig *const rigs[3] = {&full, &without_depths, &pairs_alone};
    for (int i = 0; i < 3; i++) {
        cscd_intersection_options options = all_answers(WHOLE);
        if (i > 0) options.depths = false;
        if (i > 1) options.overlaps = options.cut_offs = false;
        add(rigs[i]);
        body_rig_create(rigs[i], NULL, 1);
        expect_ok(find_with(rigs[i], &options));
        assert_int_equal(rigs[i]->found.left_out, 0);
        assert_int_equal(rigs[i]->found.wanted_memory, 0);
    }
}

/* ---- what is given ---------------------------------------------------------------------------------------- */

/* What is there is what it is without a limit; what is not there is said to be left out. */
static void compare_given(const body_rig *r) {
    const cscd_intersections *f = &r->found;
    assert_int_equal(f->count, full.found.count);
    assert_int_equal(f->crossing, full.found.crossing);
    assert_true((f->items == NULL) == leaves_out(f, CSCD_LEFT_OUT_PAIRS));
    assert_true((f->curves == NULL) == leaves_out(f, CSCD_LEFT_OUT_CURVES));
    assert_true((f->patches == NULL) == leaves_out(f, CSCD_LEFT_OUT_PATCHES));
    assert_true((f->overlaps == NULL) == leaves_out(f, CSCD_LEFT_OUT_OVERLAPS));
    assert_true((f->cut_offs == NULL) == leaves_out(f, CSCD_LEFT_OUT_CUT_OFFS));
    assert_true((f->depths == NULL) == leaves_out(f, CSCD_LEFT_OUT_DEPTHS));
    assert_true((f->parts == NULL) == leaves_out(f, CSCD_LEFT_OUT_PARTS));
    assert_true((f->wanted_memory > 0) == (f->left_out != 0));
    if (f->items == NULL) return;
    const body_rig *reference = f->depths != NULL   ? &full
                                : f->curves != NULL ? &without_depths
                                                    : &pairs_alone;
    compare_surfaces(r->mesh, &reference->found, f);
    if (f->overlaps != NULL)
        compare_items(full.found.overlaps->items, full.found.overlaps->count, f->overlaps->items,
                      f->overlaps->count, sizeof *f->overlaps->items);
}

/* The peak of a call, beside what the detector has when it has been asked once for a number only. */
static size_t call_memory(body_rig *r, const cscd_intersection_options *options, cscd_status *status) {
    const size_t before = r->counter->bytes;
    r->counter->peak = before;
    *status = find_with(r, options);
    return r->counter->peak - before;
}

/* What a mesh and its threads take, whatever is found. */
static size_t fixed_memory(const body_rig *r, uint32_t threads) {
    return 512 * (size_t)r->all.triangle_count + (size_t)A_THREAD * threads + 16384;
}

static void warm_up(body_rig *r) {
    cscd_intersection_options count = cscd_intersection_defaults();
    count.answer = CSCD_ANSWER_COUNT;
    expect_ok(find_with(r, &count));
}

static uint64_t find_on_budget(void (*add)(body_rig *r), size_t most, uint32_t threads) {
    counting_allocator counter = counting_allocator_start();
    const cscd_intersection_options options = all_answers(most);
    cscd_status status;
    add(&rig);
    rig.counter = &counter;
    body_rig_create(&rig, NULL, threads);
    warm_up(&rig);
    size_t taken = call_memory(&rig, &options, &status);
    assert_int_equal(status, rig.found.items != NULL ? CSCD_OK : CSCD_LIST_TOO_LONG);
    compare_given(&rig);
    assert_true(taken <= most + PAIR_SIZE * rig.found.count + fixed_memory(&rig, threads));
    const uint64_t left_out = rig.found.left_out;
    body_rig_free(&rig);
    assert_int_equal(counter.live, 0);
    return left_out;
}

static void try_budgets(void (*add)(body_rig *r), uint64_t expected_at_some) {
    uint64_t seen = 0;
    find_references(add);
    for (size_t most = 1024; most <= 1 << 26; most *= 4) {
        const uint64_t left_out = find_on_budget(add, most, 1);
        assert_int_equal(find_on_budget(add, most, 3), left_out);
        seen |= left_out;
    }
    assert_int_equal(find_on_budget(add, WHOLE, 2), 0);
    assert_int_equal(seen & expected_at_some, expected_at_some);
}

TEST(a_shuffled_frame_stays_on_its_budget) {
    try_budgets(add_small_shuffled, 0x7f);
}

TEST(what_is_wanted_is_the_same_for_any_threads) {
    body_rig *const rigs[2] = {&rig, &full};
    cscd_intersection_options options = cscd_intersection_defaults();
    options.patches = true;
    for (int i = 0; i < 2; i++) {
        add_small_shuffled(rigs[i]);
        body_rig_create(rigs[i], NULL, i == 0 ? 1 : 4);
    }
    for (options.max_memory = 1 << 14; options.max_memory < 1 << 20;
         options.max_memory += PACED(4, 8) << 10) {
        for (int i = 0; i < 2; i++) find_with(rigs[i], &options);
        assert_int_equal(rig.found.wanted_memory, full.found.wanted_memory);
    }
}

TEST(a_soup_stays_on_its_budget) {
    try_budgets(add_small_soup, 0x7f);
}

/* ---- pairs ------------------------------------------------------------------------------------------------ */

enum { MANY_RINGS = 13, MANY_SEGMENTS = 18 };

TEST(pairs_take_64_bytes_each) {
    for (uint32_t threads = 1; threads <= 4; threads += 3) {
        counting_allocator counter = counting_allocator_start();
        cscd_intersection_options options = cscd_intersection_defaults();
        cscd_status status;
        tangle_add_shuffled(&rig, MANY_RINGS, MANY_SEGMENTS);
        rig.counter = &counter;
        body_rig_create(&rig, NULL, threads);
        warm_up(&rig);
        size_t taken = call_memory(&rig, &options, &status);
        expect_ok(status);
        print_message("  %zu pairs, %.1f bytes each\n", rig.found.count,
                      (double)taken / (double)rig.found.count);
        assert_true(rig.found.count > 20 * rig.all.triangle_count);
        /* The lists of each thread grow by their own steps: some 400 KiB each, whatever they hold in the end. */
        assert_true(taken <= PAIR_SIZE * rig.found.count + ((size_t)1 << 19) * threads);
        body_rig_free(&rig);
    }
}

/* Lists without an end are not made; they are counted, and a caller sees from the status that there is none. */
TEST(pairs_that_do_not_fit_are_counted) {
    cscd_intersection_options options = cscd_intersection_defaults();
    add_small_shuffled(&rig);
    body_rig_create(&rig, NULL, 2);
    expect_ok(find_with(&rig, &options));
    const size_t count = rig.found.count, crossing = rig.found.crossing;
    options.max_memory = PAIR_SIZE * count;
    expect_ok(find_with(&rig, &options));
    assert_int_equal(rig.found.left_out, 0);
    options.max_memory = PAIR_SIZE * count - 1;
    assert_int_equal(find_with(&rig, &options), CSCD_LIST_TOO_LONG);
    assert_non_null(strstr(cscd_context_detail(rig.context), "max_memory"));
    assert_null(rig.found.items);
    assert_int_equal(rig.found.count, count);
    assert_int_equal(rig.found.crossing, crossing);
    assert_int_equal(rig.found.left_out, 1 << CSCD_LEFT_OUT_PAIRS);
    assert_int_equal(rig.found.wanted_memory, PAIR_SIZE * count);
    for (size_t after = count / 2; after <= count; after += count / 2) {
        options.stop_after = after; /* half of them fit, and one more does not */
        options.max_memory = PAIR_SIZE * (count / 2);
        assert_int_equal(find_with(&rig, &options), after == count / 2 ? CSCD_OK : CSCD_LIST_TOO_LONG);
        assert_int_equal(rig.found.count, after == count / 2 ? after : count);
        assert_int_equal(rig.found.items == NULL, after != count / 2);
    }
    options.stop_after = 0;
    options.max_memory = PAIR_SIZE * count;
    expect_ok(find_with(&rig, &options));
    options.max_memory = 1; /* other answers keep no list */
    options.answer = CSCD_ANSWER_COUNT;
    expect_ok(find_with(&rig, &options));
    assert_int_equal(rig.found.count, count);
    options.answer = CSCD_ANSWER_LIST;
    expect_ok(cscd_detector_set_longest_list(rig.detector, 10));
    assert_int_equal(find_with(&rig, &options), CSCD_LIST_TOO_LONG);
    assert_non_null(strstr(cscd_context_detail(rig.context), "longest_list"));
    assert_int_equal(rig.found.left_out, 0);
}

/* ---- other calls ------------------------------------------------------------------------------------------ */

/* What is left out does not depend on what earlier calls have kept, nor does memory grow by it. */
TEST(earlier_frames_change_nothing) {
    counting_allocator counter = counting_allocator_start();
    random_stream random = stream_start(3);
    cscd_status status;
    find_references(add_small_shuffled);
    add_small_shuffled(&rig);
    rig.counter = &counter;
    body_rig_create(&rig, NULL, 2);
    warm_up(&rig);
    const size_t before = counter.bytes;
    uint64_t left_out[20];
    for (int round = 0; round < 2; round++) {
        for (uint32_t i = 0; i < 40; i++) {
            const uint32_t k = i < 20 ? i : stream_below(&random, 20);
            const cscd_intersection_options options = all_answers((size_t)4096 << k / 2 << (k % 2 == 0));
            call_memory(&rig, &options, &status);
            compare_given(&rig);
            if (round == 0 && i < 20)
                left_out[k] = rig.found.left_out;
            else
                assert_int_equal(rig.found.left_out, left_out[k]);
        }
    }
    for (uint32_t i = 0; i < 10; i++) { /* all on one budget, of which the calls before kept more */
        const cscd_intersection_options options = all_answers(1 << 20);
        counter.peak = counter.bytes;
        find_with(&rig, &options);
        if (i > 0)
            assert_true(counter.peak - before <=
                        (1 << 20) + 2 * PAIR_SIZE * rig.found.count + fixed_memory(&rig, 2));
    }
    body_rig_free(&rig);
}

/* A step, and the answers for a frame in the right order, are those of a detector that has never seen the wrong one. */
TEST(a_step_afterwards_is_right) {
    static double good[SCENE_VERTICES_MAX * 3], moved[SCENE_VERTICES_MAX * 3];
    static const double origin[3] = {0, 0, 0}, beside[3] = {0.5, 0.25, 0.125};
    cscd_contacts contacts[2];
    body_rig *const rigs[2] = {&rig, &full};
    for (int i = 0; i < 2; i++) {
        body_rig *r = rigs[i];
        add_small_shuffled(r);
        body_rig_create(r, NULL, 2);
        cscd_intersection_options options = all_answers(i == 0 ? 70000 : WHOLE);
        find_with(r, &options);
        if (i == 0) assert_true(r->found.left_out != 0);
        scene_clear(&r->all);
        scene_add_sphere(&r->all, origin, 1.0, 6, 8);
        scene_add_sphere(&r->all, beside, 0.75, 4, 6);
        memcpy(good, r->all.x0, sizeof good);
        for (uint32_t k = 0; k < r->all.vertex_count * 3; k++) moved[k] = good[k] * 0.75;
        const cscd_view *from = CSCD_DOUBLES(good, r->all.vertex_count),
                        *to = CSCD_DOUBLES(moved, r->all.vertex_count);
        expect_ok(cscd_detector_step(r->detector, from, to, &contacts[i]));
        options = all_answers(1 << 22);
        expect_ok(find_with(r, &options));
        assert_int_equal(r->found.left_out, 0);
    }
    compare_answers(rig.mesh, &full.found, &rig.found);
    assert_int_equal(contacts[0].count, contacts[1].count);
}

/* ---- events ----------------------------------------------------------------------------------------------- */

/* A frame that does not fit is one in which nothing was looked for; the others have their events. */
TEST(events_stay_on_their_budget) {
    counting_allocator counter = counting_allocator_start();
    cscd_event_options options = cscd_event_defaults();
    cscd_event_tracker *tracker = NULL;
    cscd_events events;
    static uint32_t labels[SCENE_TRIANGLES_MAX];
    tangle_add_soup(&rig, 300);
    for (uint32_t i = 0; i < rig.all.triangle_count; i++) labels[i] = i;
    rig.counter = &counter;
    body_rig_create(&rig, NULL, 1);
    expect_ok(find_with(&rig, NULL));
    for (size_t most = 1 << 12; most <= 1 << 26; most *= 2) {
        options.part_count = rig.all.triangle_count;
        options.labels = labels;
        options.max_memory = most;
        expect_ok(cscd_event_tracker_create(rig.context, rig.mesh, &options, &tracker));
        expect_ok(cscd_event_tracker_add_frame(tracker, 0, NULL));
        const size_t before = counter.bytes;
        counter.peak = before;
        cscd_status status = cscd_event_tracker_add_frame(tracker, 1, &rig.found);
        assert_true(counter.peak - before <= most + 64 * (size_t)rig.all.triangle_count);
        assert_int_equal(status, most < 1 << 26 && status != CSCD_OK ? CSCD_LIST_TOO_LONG : CSCD_OK);
        if (status != CSCD_OK) assert_non_null(strstr(cscd_context_detail(rig.context), "max_memory"));
        expect_ok(cscd_event_tracker_add_frame(tracker, 2, NULL));
        expect_ok(cscd_event_tracker_finish(tracker, &events));
        assert_int_equal(events.count, status == CSCD_OK ? rig.found.count : 0);
        if (most == 1 << 12) assert_int_equal(status, CSCD_LIST_TOO_LONG);
        cscd_event_tracker_destroy(tracker);
    }
    body_rig_free(&rig);
    assert_int_equal(counter.live, 0);
}

TEST(names_are_those_of_the_header) {
    assert_string_equal(cscd_name(CSCD_LEFT_OUTS, CSCD_LEFT_OUT_PAIRS), "pairs");
    assert_string_equal(cscd_name(CSCD_LEFT_OUTS, CSCD_LEFT_OUT_CUT_OFFS), "cut-offs");
    assert_string_equal(cscd_name(CSCD_LEFT_OUTS, CSCD_LEFT_OUT_PARTS), "parts");
    assert_string_equal(cscd_name(CSCD_LEFT_OUTS, (cscd_left_out)77), "unknown");
}

AROUND_EACH(NULL, body_rigs_free)
