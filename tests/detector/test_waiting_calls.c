/* Changes of what is left out that fail, are cancelled, or cost memory. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <string.h>

TEST(mistakes_change_nothing) {
    static equal_panels p;
    cscd_contacts contacts;
    const uint32_t beyond[] = {0, EQUAL_VERTICES}, same[] = {3, 3};
    equal_panels_begin(&p, 0.0, 1);
    assert_int_equal(cscd_detector_set_seams(NULL, NULL, 0), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_detector_set_ignored(NULL, NULL, 0), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_detector_set_seams(p.detector, NULL, 1), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(p.context), "seams is NULL, but there are to be 1 pairs");
    expect_invalid(p.context, cscd_detector_set_seams(p.detector, beyond, 1),
                   "pair 0 of seams names vertex 50, but there are 50");
    assert_int_equal(cscd_detector_set_seams(p.detector, same, 1), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_set_ignored(p.detector, NULL, 2), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_set_ignored(p.detector, (const uint32_t[]){0, 2 * EQUAL_TRIANGLES}, 1),
                     CSCD_INVALID_ARGUMENT);
    expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
    assert_true(cscd_detector_waiting(p.detector).features == 0 && contacts.count == 0);
    const uint32_t distant[] = {0, EQUAL_VERTICES - 1};
    expect_ok(cscd_detector_set_seams(p.detector, distant, 1));
    expect_ok(cscd_detector_set_ignored(p.detector, (const uint32_t[]){0, 1}, 1));
    expect_invalid(p.context, step_packed(p.detector, p.x0, p.x0, &contacts),
                   "pair 0 of seams joins the vertices 0 and 49");
    equal_panels_end(&p);
}

TEST(steps_with_waiting_pairs_allocate_nothing) {
    static equal_panels p;
    cscd_contacts contacts;
    cscd_intersections crossing;
    cscd_free_step step;
    size_t calls = 0;
    equal_panels_begin(&p, 0.0, 2);
    equal_panels_open(&p);
    for (int i = 0; i < 10; i++) {
        if (i == 2) calls = p.counter.calls;
        expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
        expect_ok(check_packed(p.detector, p.x0, &crossing));
        expect_ok(max_step_packed(p.detector, p.x0, p.x0, NULL, &step));
        const cscd_waiting waiting = cscd_detector_waiting(p.detector);
        assert_true(contacts.count == 0 && waiting.features == p.touching && waiting.triangles > 0);
    }
    assert_int_equal(p.counter.calls, calls);
    equal_panels_end(&p);
}

/* The vertices of some rows are sewn. */
static void sew_rows(const equal_panels *p, uint32_t begin, uint32_t end) {
    expect_ok(cscd_detector_set_seams(p->detector, &p->seams[begin * EQUAL_SIDE][0],
                                      (size_t)(end - begin) * EQUAL_SIDE));
}

static void set_all_rules(const equal_panels *p, bool apart) {
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    if (apart) rules[0].mask = 0;
    expect_ok(cscd_detector_set_rules(p->detector, apart ? rules : NULL, apart ? 2 : 0, NULL, 0));
}

/* The seam opens row by row, closes so with gaps between, opens in turns; and panels are hidden in turns. */
static void change_to_and_fro(const equal_panels *p, int way, uint32_t i) {
    if (way == 0) sew_rows(p, 0, EQUAL_SIDE - 1 - i % EQUAL_SIDE);
    if (way == 1) sew_rows(p, 0, i % EQUAL_SIDE + 1);
    if (way == 2) sew_rows(p, 0, 3);
    if (way == 2) sew_rows(p, 2, EQUAL_SIDE);
    if (way == 3) set_all_rules(p, true);
    if (way > 0) equal_panels_open(p);
    if (way == 3) set_all_rules(p, false);
}

/* What is uncovered again and again, while no positions are seen, is remembered once. */
TEST(changes_to_and_fro_take_no_memory) {
    static equal_panels p;
    cscd_contacts contacts;
    for (int way = 0; way < 4; way++) {
        size_t live = 0;
        equal_panels_begin(&p, 0.0, 1);
        equal_panels_part(&p, 0.3, p.x1);
        if (way > 0) equal_panels_open(&p);
        expect_ok(step_packed(p.detector, p.x1, p.x1, &contacts));
        for (uint32_t i = 0; i < 3 * EQUAL_SIDE; i++) {
            change_to_and_fro(&p, way, i);
            if (i == 1) live = p.counter.live;
            assert_true(i < 1 || p.counter.live <= live + 1); /* room for one more */
        }
        expect_ok(step_packed(p.detector, p.x0, p.x0, &contacts));
        assert_true(contacts.count == 0 && cscd_detector_waiting(p.detector).features == p.touching);
        equal_panels_end(&p);
    }
}
