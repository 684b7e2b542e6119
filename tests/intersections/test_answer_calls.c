/* Calls that ask for all answers about surfaces, cancelled wherever they ask, and called again from within. */
#include "src/core/context.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/test.h"

#include <string.h>

static body_rig rig, other; /* large; one test at a time */

/* Two boxes that cross, and a bar through both. */
static void add_boxes(body_rig *r) {
    static const double corners[3][3] = {{0, 0, 0}, {1.25, 1.5, 1.125}, {-1, 1.6, 1.2}};
    static const double sizes[3][3] = {{2, 2, 2}, {2, 2, 2}, {6, 0.25, 0.5}};
    body_rig_begin(r);
    for (int i = 0; i < 3; i++) {
        body_rig_add_box(r, corners[i], sizes[i]);
        body_rig_end_body(r);
    }
}

static void compare_answers(void) {
    const cscd_intersection_pairs *a = &rig.found, *b = &other.found;
    assert_int_equal(a->curves->point_count, b->curves->point_count);
    assert_memory_equal(a->curves->points, b->curves->points,
                        a->curves->point_count * sizeof *a->curves->points);
    assert_int_equal(a->patches->winding_count, b->patches->winding_count);
    assert_memory_equal(a->patches->windings, b->patches->windings,
                        a->patches->winding_count * sizeof *a->patches->windings);
    assert_int_equal(a->overlaps->count, b->overlaps->count);
    assert_memory_equal(a->overlaps->items, b->overlaps->items,
                        a->overlaps->count * sizeof *a->overlaps->items);
    assert_int_equal(a->depths->count, b->depths->count);
    assert_memory_equal(a->depths->items, b->depths->items, a->depths->count * sizeof *a->depths->items);
}

typedef struct answer_stopper {
    uint32_t calls, at;
    bool in_answers; /* the last call was in the stage of an answer */
} answer_stopper;

static bool go_on_until(void *user, const char *stage, double fraction) {
    answer_stopper *h = user;
    h->in_answers =
        strcmp(stage, "curves") == 0 || strcmp(stage, "patches") == 0 || strcmp(stage, "depths") == 0;
    return ++h->calls != h->at && fraction >= 0.0;
}

/* A call that is cancelled gives nothing, and the next one gives everything. */
TEST(cancelled_anywhere) {
    uint32_t cancelled = 0, in_answers = 0;
    answer_stopper h = {.at = 0};
    add_boxes(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    add_boxes(&rig);
    body_rig_create(&rig, NULL, 1);
    rig.context->progress.host = (cscd_progress){go_on_until, &h};
    rig.context->progress.interval_ms = 0.0; /* asks as often as it can */
    for (h.at = 1;; h.at++) {
        h.calls = 0;
        rig.found.count = 4711;
        cscd_status status = body_rig_try(&rig);
        if (status == CSCD_OK) break;
        assert_int_equal(status, CSCD_CANCELLED);
        assert_int_equal(rig.found.count, 4711);
        assert_non_null(strstr(cscd_context_detail(rig.context), "cancelled by the progress function"));
        cancelled++;
        in_answers += h.in_answers;
        uint32_t at = h.at;
        h.at = 0;
        body_rig_find(&rig);
        compare_answers();
        h.at = at;
    }
    print_message("  cancelled %u times, %u times in answers\n", cancelled, in_answers);
    assert_true(in_answers >= 3);
    body_rig_free(&rig);
    body_rig_free(&other);
}

/* The caller's function, which is asked while pairs are found, asks the detector. */
static bool ask_again(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    size_t *asked = user;
    cscd_intersection_pairs kept = rig.found;
    assert_true(kind == CSCD_CONTACT_TT && a < b);
    assert_int_equal(body_rig_try(&rig), CSCD_BUSY);
    assert_memory_equal(&kept, &rig.found, sizeof kept);
    (*asked)++;
    return false;
}

TEST(called_from_within) {
    size_t asked = 0;
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ask_again;
    options.ignore_user = &asked;
    add_boxes(&other);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    add_boxes(&rig);
    memset(&rig.found, 0, sizeof rig.found);
    body_rig_create(&rig, &options, 1);
    body_rig_find(&rig);
    assert_true(asked >= rig.found.count && asked > 0);
    compare_answers();
    body_rig_free(&rig);
    body_rig_free(&other);
}
