/* The candidates of a motion contain every contact of it and of every shorter motion. */
#include "runtime/detector/detector.h"
#include "runtime/solver/free_step.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

static scene interval; /* large; one test at a time */
static double end[SCENE_VERTICES_MAX * 3];

static size_t count_of(const candidates *c) {
    return c->lists[CSCD_CONTACT_VF].count + c->lists[CSCD_CONTACT_EE].count;
}

/* Tests the candidates up to a share of the motion; their contacts must be those of a step to that point. */
static size_t compare_share(const rig *r, const rig *reference, const candidates *c, double share,
                            result_buffer *buffer) {
    cscd_detector *d = r->detector;
    cscd_contacts expected, found;
    cscd_counters counters = {.vf = 0};
    straight_motion m = {.mesh = r->mesh, .x0 = interval.x0, .x1 = interval.x1};
    motion_at(&m, share, end);
    interval_search search = interval_search_begin(&d->space, interval.x0, end, d->config.limit);
    expect_ok(candidates_test(c, &search));
    expect_ok(contact_list_collect(&d->space, &d->config.exclusions, buffer, &counters, &found));
    expect_ok(step_packed(reference->detector, interval.x0, end, &expected));
    assert_int_equal(found.count, expected.count);
    if (found.count > 0) assert_memory_equal(found.items, expected.items, found.count * sizeof *found.items);
    return found.count;
}

static cscd_status collect_within(cscd_detector *d, double reach, candidates *out) {
    const candidate_quest quest = {&d->space, &d->rebuild, config_growth(&d->config), reach, 0.0};
    return candidates_collect(&quest, interval.x0, interval.x1, out);
}

TEST(candidates_hold_every_contact) {
    size_t contacts = 0, collected = 0, farther = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        candidates c = {.lists = {{.count = 0}}};
        result_buffer buffer = {.capacity = 0};
        scene_make((scene_family)family, 1, &interval);
        rig r = rig_create(&interval, 1 + (uint32_t)family % 3, NULL),
            reference = rig_create(&interval, 1, NULL);
        expect_ok(collect_within(r.detector, 1e-6, &c));
        collected += count_of(&c);
        contacts += compare_share(&r, &reference, &c, 1.0, &buffer);
        contacts += compare_share(&r, &reference, &c, 0.4, &buffer);
        size_t near = count_of(&c);
        expect_ok(collect_within(r.detector, 0.1, &c));
        assert_true(count_of(&c) >= near);
        farther += count_of(&c);
        candidates_free(r.context, &c);
        assert_int_equal(count_of(&c), 0);
        result_buffer_free(r.context, &buffer);
        rig_destroy(&reference);
        rig_destroy(&r);
    }
    print_message("  %zu contacts of %zu candidates; %zu within 0.1\n", contacts, collected, farther);
    assert_true(contacts > 100 && farther > collected);
}
