/* The contacts of all lanes form one list, sorted by time and names, without those that the caller
 * ignores; long lists are moved, not copied, and are the same. */
#include "runtime/detector/contact_list.h"
#include "runtime/detector/detector.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene shape; /* large; one test at a time */

static const double times[] = {0.5, 0.25, 0.0, -0.0, 0.25, 1.0, 0.25, 0.0};
enum { CONTACT_COUNT = sizeof times / sizeof *times };

/* Makes contacts of two kinds, some at equal times, and deals them out to all lanes. */
static void fill_lanes(cscd_context *context, search_space *s) {
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) contact_lane_reset(&s->lanes[i]);
    for (uint32_t i = 0; i < CONTACT_COUNT; i++) {
        elementary_contact hit = {.toi = times[i]};
        cscd_contact_kind kind = i % 3 == 0 ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
        contact_lane_add(context, &s->lanes[i % s->traversal.lane_count], kind, (7 * i) % 5, 20 - i, &hit,
                         i == 5);
    }
    s->traversal.busy_lanes = s->traversal.lane_count;
}

static bool in_order(const cscd_contact *a, const cscd_contact *b) {
    if (a->toi != b->toi) return a->toi < b->toi;
    if (a->kind != b->kind) return a->kind < b->kind;
    return a->a != b->a ? a->a < b->a : a->b < b->b;
}

static cscd_contacts collect_from(rig *r, search_space *s, cscd_counters *counters, result_buffer *buffer,
                                  const exclusions *e) {
    cscd_contacts found = {.count = 0};
    *counters = (cscd_counters){.vf = 0};
    fill_lanes(r->context, s);
    s->lanes[0].feature_pairs = 3;
    s->lanes[0].decided[ELEMENTARY_SIGNS] = 2;
    assert_int_equal(contact_list_collect(s, e, buffer, counters, &found), CSCD_OK);
    return found;
}

static void lists_are_sorted_for_any_lane_count(void **state) {
    static cscd_contact expected[CONTACT_COUNT];
    (void)state;
    scene_make(SCENE_SPIKE, 1, &shape);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        rig r = rig_create(&shape, threads, NULL);
        search_space s;
        exclusions none;
        result_buffer buffer = {.capacity = 0};
        cscd_counters counters;
        cscd_detector_options options = cscd_detector_defaults();
        assert_int_equal(search_space_create(r.mesh, &s), CSCD_OK);
        assert_int_equal(exclusions_create(r.mesh, &options, &none), CSCD_OK);
        cscd_contacts found = collect_from(&r, &s, &counters, &buffer, &none);
        assert_int_equal(found.count, CONTACT_COUNT);
        for (size_t i = 1; i < found.count; i++) assert_true(in_order(&found.items[i - 1], &found.items[i]));
        assert_true(counters.vf == 5 && counters.ee == 3 && counters.bounded == 1);
        assert_true(counters.feature_pairs == 3 && counters.by_signs == 2 && counters.tests == 2);
        if (threads == 1)
            memcpy(expected, found.items, sizeof expected);
        else
            assert_memory_equal(found.items, expected, sizeof expected);
        result_buffer_free(r.context, &buffer);
        exclusions_free(r.context, &none);
        search_space_destroy(&s);
        rig_destroy(&r);
    }
}

static bool ignore_everything(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (kind == CSCD_CONTACT_VF || a < b);
}

static void what_the_caller_ignores_is_not_counted(void **state) {
    (void)state;
    scene_make(SCENE_SPIKE, 1, &shape);
    rig r = rig_create(&shape, 1, NULL);
    search_space s;
    exclusions all;
    result_buffer buffer = {.capacity = 0};
    cscd_counters counters;
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignore_everything;
    assert_int_equal(search_space_create(r.mesh, &s), CSCD_OK);
    assert_int_equal(exclusions_create(r.mesh, &options, &all), CSCD_OK);
    cscd_contacts found = collect_from(&r, &s, &counters, &buffer, &all);
    assert_int_equal(found.count, 0);
    assert_true(counters.vf == 0 && counters.ee == 0 && counters.bounded == 0 && counters.feature_pairs == 3);
    result_buffer_free(r.context, &buffer);
    exclusions_free(r.context, &all);
    search_space_destroy(&s);
    rig_destroy(&r);
}

/* ---- long lists ---------------------------------------------------------------------------------------- */

static void lanes_of_long_lists_give_back_their_memory(void **state) {
    (void)state;
    scene_make(SCENE_SPIKE, 1, &shape);
    for (uint32_t threads = 1; threads <= 4; threads++) {
        rig r = rig_create(&shape, threads, NULL);
        search_space s;
        exclusions none;
        result_buffer by_copy = {.capacity = 0}, by_move = {.capacity = 0};
        cscd_counters counted, counters;
        cscd_detector_options options = cscd_detector_defaults();
        assert_int_equal(search_space_create(r.mesh, &s), CSCD_OK);
        assert_int_equal(exclusions_create(r.mesh, &options, &none), CSCD_OK);
        const cscd_contacts expected = collect_from(&r, &s, &counted, &by_copy, &none);
        s.moves_from = 1;
        for (int round = 0; round < 2; round++) {
            const cscd_contacts found = collect_from(&r, &s, &counters, &by_move, &none);
            assert_int_equal(found.count, expected.count);
            assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
            assert_memory_equal(&counters, &counted, sizeof counters);
            assert_true(by_move.keys == NULL && by_move.spare_keys == NULL);
            for (uint32_t i = 0; i < s.traversal.lane_count; i++)
                assert_true(s.lanes[i].count == 0 && s.lanes[i].block_count == 0);
        }
        result_buffer_free(r.context, &by_copy);
        result_buffer_free(r.context, &by_move);
        exclusions_free(r.context, &none);
        search_space_destroy(&s);
        rig_destroy(&r);
    }
}

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    return user == NULL && (a + b + (uint32_t)kind) % 3 == 0;
}

/* Whole steps there and back, with lists that are copied and lists that are moved. */
static void steps_with_long_lists_are_the_same(void **state) {
    (void)state;
    static scene back;
    size_t contacts = 0;
    for (uint32_t seed = 0; seed < 4 * SCENE_FAMILY_COUNT; seed++) {
        scene_make((scene_family)(seed % SCENE_FAMILY_COUNT), seed, &shape);
        back = shape;
        memcpy(back.x0, shape.x1, sizeof back.x0);
        memcpy(back.x1, shape.x0, sizeof back.x1);
        cscd_detector_options options = cscd_detector_defaults();
        if (seed % 2 == 1) options.ignore = ignore_some;
        rig copying = rig_create(&shape, 1 + seed % 3, &options),
            moving = rig_create(&shape, 1 + seed % 3, &options);
        moving.detector->space.moves_from = 1;
        for (int step = 0; step < 4; step++) {
            const scene *interval = step % 2 == 0 ? &shape : &back;
            const cscd_contacts expected = rig_step(&copying, interval), found = rig_step(&moving, interval);
            assert_int_equal(found.count, expected.count);
            assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
            contacts += found.count;
        }
        rig_destroy(&copying);
        rig_destroy(&moving);
    }
    assert_true(contacts > 1000);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lists_are_sorted_for_any_lane_count),
                                       cmocka_unit_test(lanes_of_long_lists_give_back_their_memory),
                                       cmocka_unit_test(steps_with_long_lists_are_the_same),
                                       cmocka_unit_test(what_the_caller_ignores_is_not_counted)};
    return cmocka_run_group_tests_name("contact_list", tests, NULL, NULL);
}
