/* Calls for intersections by kind on larger meshes: the same first pairs for any number of threads, caps, pairs that wait,
 * what is known afterwards, calls that are cancelled, and options that are wrong. */
#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "runtime/intersections/pair_kind.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/packed.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__
enum { REPETITIONS = 2 };
#else
enum { REPETITIONS = 8 };
#endif

static scene s; /* large; one test at a time */

/* Two wavy spheres, one turned, which cross at many places unless they are apart. */
static void make_spheres(double apart) {
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 20, 22);
    uint32_t first = s.vertex_count;
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 20, 22);
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        double *p = s.x0 + (size_t)v * 3, y = p[1], wave = 1.0 + 0.1 * sin(9 * p[0] + 8 * p[1] + 7 * p[2]);
        for (int k = 0; k < 3; k++) p[k] *= wave;
        if (v < first) continue;
        p[1] = 0.6 * y - 0.8 * p[2] + 0.01;
        p[2] = 0.8 * y + 0.6 * p[2];
        p[0] += apart;
    }
    memcpy(s.x1, s.x0, sizeof s.x1);
}

static cscd_intersection_options options_for(cscd_intersection_answer answer, uint64_t kinds,
                                             size_t stop_after) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.answer = answer;
    options.kinds = kinds;
    options.stop_after = stop_after;
    return options;
}

static cscd_intersection_pairs find_pairs(cscd_detector *detector, cscd_intersection_answer answer,
                                          size_t stop_after) {
    cscd_intersection_options options = options_for(answer, UINT64_MAX, stop_after);
    cscd_intersection_pairs found;
    assert_int_equal(find_intersections_packed(detector, s.x0, &options, &found), CSCD_OK);
    return found;
}

/* ---- the first pairs ------------------------------------------------------------------------------------- */

/* Tested against each pair of triangles; returns how many there are. */
static size_t compare_with_all_pairs(const cscd_intersection_pairs *found) {
    size_t next = 0;
    for (uint32_t a = 0; a < s.triangle_count; a++) {
        for (uint32_t b = a + 1; b < s.triangle_count; b++) {
            pair_kind kind;
            if (!pair_kind_find(s.triangles + (size_t)a * 3, s.triangles + (size_t)b * 3, NULL, s.x0, &kind))
                continue;
            assert_true(next < found->count);
            const cscd_intersection_pair *pair = &found->items[next++];
            assert_true(pair->a == a && pair->b == b && pair->kind == kind.kind &&
                        pair->shared == kind.shared);
        }
    }
    assert_int_equal(next, found->count);
    return next;
}

static bool ignore_a_third(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_TT && (a + b) % 3 == 0;
}

static void compare_first_pairs(bool ignores) {
    static cscd_intersection_pair before[1000];
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = ignores ? ignore_a_third : NULL;
    for (size_t stop_after = 1; stop_after <= 1000; stop_after = stop_after * 3 - stop_after / 2) {
        for (uint32_t threads = 1; threads <= 4; threads++) {
            rig r = rig_create(&s, threads, &options);
            cscd_intersection_pairs found = find_pairs(r.detector, CSCD_ANSWER_LIST, stop_after);
            if (threads == 1) memcpy(before, found.items, found.count * sizeof *before);
            assert_true(found.stopped || stop_after > 300);
            assert_int_equal(found.count == stop_after, found.stopped);
            assert_memory_equal(before, found.items, found.count * sizeof *before);
            for (size_t i = 0; i < found.count && ignores; i++)
                assert_true((found.items[i].a + found.items[i].b) % 3 != 0);
            assert_int_equal(find_pairs(r.detector, CSCD_ANSWER_ANY, stop_after).count, 1);
            rig_destroy(&r);
        }
    }
}

static void first_pairs_are_the_same(void **state) {
    (void)state;
    make_spheres(0.02);
    rig r = rig_create(&s, 3, NULL);
    cscd_intersection_pairs found = find_pairs(r.detector, CSCD_ANSWER_LIST, 0);
    assert_true(compare_with_all_pairs(&found) > 300);
    rig_destroy(&r);
    compare_first_pairs(false);
    compare_first_pairs(true);
}

enum {
    GRID_SIDE = 120,
    GRID = GRID_SIDE * GRID_SIDE,
    GRID_TRIANGLES = 2 * (GRID_SIDE - 1) * (GRID_SIDE - 1)
};

/* Two sheets that cross in nearly every triangle of some patches, so that some tasks have pairs enough, and others of the
 * same size none. */
static cscd_detector *make_sheets(cscd_context *context, uint32_t patches, double *x) {
    uint32_t *triangles = malloc(sizeof *triangles * 3 * GRID_TRIANGLES), count = 0;
    for (uint32_t v = 0; v < 2 * GRID; v++) {
        bool upper = v >= GRID;
        x[3 * v] = v % GRID / GRID_SIDE + (upper ? 0.3 : 0.0);
        x[3 * v + 1] = v % GRID_SIDE + (upper ? 0.2 : 0.0);
        bool crossing = (v % GRID / GRID_SIDE / 15 * 5 + v % GRID_SIDE / 15 * 3 + patches) % 7 == 0;
        x[3 * v + 2] = (v * 7 + upper) % 5 * 0.3 + (upper && !crossing ? 1.3 : 0.0);
    }
    for (uint32_t i = 0; i + 1 < GRID_SIDE; i++) {
        for (uint32_t j = 0; j + 1 < GRID_SIDE; j++) {
            uint32_t k = i * GRID_SIDE + j;
            uint32_t both[6] = {k, k + GRID_SIDE, k + 1, k + 1, k + GRID_SIDE, k + GRID_SIDE + 1};
            memcpy(triangles + 3 * (size_t)count, both, sizeof both);
            count += 2;
        }
    }
    const cscd_object_desc sheet = cscd_object_of_triangles(GRID, GRID_TRIANGLES, triangles);
    const cscd_object_desc sheets[2] = {sheet, sheet};
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    assert_int_equal(cscd_mesh_create(context, sheets, 2, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, NULL, &detector), CSCD_OK);
    cscd_mesh_destroy(mesh);
    free(triangles);
    return detector;
}

/* Whichever thread is first, and though threads leave tasks that others have made needless. */
static void first_pairs_do_not_depend_on_luck(void **state) {
    static const size_t stops[] = {1, 30, 100, 300};
    static double x[2 * GRID * 3];
    static cscd_intersection_pair before[4][300];
    (void)state;
    for (uint32_t i = 0; i < 4 * REPETITIONS; i++) {
        cscd_context_options context_options = cscd_context_defaults();
        cscd_context *context = NULL;
        cscd_intersection_pairs found;
        context_options.thread_count = 1 + i % 4;
        assert_int_equal(cscd_context_create(&context_options, &context), CSCD_OK);
        cscd_detector *detector = make_sheets(context, i / 4, x);
        detector->space.traversal.tasks_wanted = 60;
        for (int k = 0; k < 16; k++) {
            cscd_intersection_options options = options_for(CSCD_ANSWER_LIST, UINT64_MAX, stops[k % 4]);
            assert_int_equal(find_intersections_packed(detector, x, &options, &found), CSCD_OK);
            assert_int_equal(found.count, stops[k % 4]);
            if (i % 4 == 0) memcpy(before[k % 4], found.items, found.count * sizeof *found.items);
            assert_memory_equal(before[k % 4], found.items, found.count * sizeof *found.items);
        }
        cscd_detector_destroy(detector);
        cscd_context_destroy(context);
    }
}

/* The first pair ends the search: with one thread few boxes are compared. */
static void searches_end_early(void **state) {
    (void)state;
    make_spheres(0.02);
    rig r = rig_create(&s, 1, NULL);
    find_pairs(r.detector, CSCD_ANSWER_LIST, 0);
    uint64_t all = traversal_boxes_tested(&r.detector->space.traversal);
    find_pairs(r.detector, CSCD_ANSWER_ANY, 0);
    assert_true(traversal_boxes_tested(&r.detector->space.traversal) * 2 < all);
    find_pairs(r.detector, CSCD_ANSWER_COUNT, 10);
    assert_true(traversal_boxes_tested(&r.detector->space.traversal) * 2 < all);
    rig_destroy(&r);
    make_spheres(3.0);
    r = rig_create(&s, 1, NULL);
    assert_int_equal(find_pairs(r.detector, CSCD_ANSWER_ANY, 0).count, 0);
    rig_destroy(&r);
}

/* ---- caps ------------------------------------------------------------------------------------------------ */

static void caps_bound_lists(void **state) {
    (void)state;
    make_spheres(0.02);
    rig r = rig_create(&s, 2, NULL);
    size_t all = find_pairs(r.detector, CSCD_ANSWER_LIST, 0).count;
    for (size_t beside = 0; beside < 200; beside += 50) {
        cscd_intersection_pairs found = {.count = 0};
        assert_int_equal(cscd_detector_set_longest_list(r.detector, all - 1), CSCD_OK);
        r.detector->cap.beside = beside;
        assert_int_equal(find_intersections_packed(r.detector, s.x0, NULL, &found), CSCD_LIST_TOO_LONG);
        assert_int_equal(found.count, all);
        assert_int_equal(found.crossing + found.touching, all);
        assert_null(found.items);
        assert_int_equal(find_pairs(r.detector, CSCD_ANSWER_COUNT, 0).count, all);
        assert_int_equal(find_pairs(r.detector, CSCD_ANSWER_ANY, 0).count, 1);
        found = find_pairs(r.detector, CSCD_ANSWER_LIST, 20);
        assert_true(found.stopped && found.count == 20);
        assert_int_equal(cscd_detector_set_longest_list(r.detector, all / 2), CSCD_OK);
        cscd_intersection_options options = options_for(CSCD_ANSWER_LIST, UINT64_MAX, all - 3);
        assert_int_equal(find_intersections_packed(r.detector, s.x0, &options, &found), CSCD_LIST_TOO_LONG);
        assert_int_equal(found.count, all);
        assert_int_equal(cscd_detector_set_longest_list(r.detector, all), CSCD_OK);
        r.detector->cap.beside = beside;
        found = find_pairs(r.detector, CSCD_ANSWER_LIST, all + 1);
        assert_false(found.stopped);
        assert_int_equal(compare_with_all_pairs(&found), all);
    }
    rig_destroy(&r);
}

/* ---- states ---------------------------------------------------------------------------------------------- */

static void expect_same_knowledge(const rig *a, const rig *b) {
    for (uint32_t t = 0; t < s.triangle_count; t++)
        assert_int_equal(cscd_detector_start_state(a->detector, t),
                         cscd_detector_start_state(b->detector, t));
}

/* A whole search tells a later step as much as a check; one that may stop early tells nothing. */
static void states_are_known_afterwards(void **state) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_intersections plain;
    (void)state;
    options.method = CSCD_METHOD_SINGLE;
    make_spheres(0.02);
    for (uint64_t kinds = 1; kinds < 32; kinds *= 2) {
        rig checked = rig_create(&s, 2, &options), asked = rig_create(&s, 2, &options);
        cscd_intersection_options all = options_for(CSCD_ANSWER_COUNT, kinds, 0);
        cscd_intersection_options some = options_for(CSCD_ANSWER_LIST, kinds, SIZE_MAX);
        cscd_intersection_pairs found;
        assert_int_equal(find_intersections_packed(asked.detector, s.x0, &some, &found), CSCD_OK);
        expect_same_knowledge(&checked, &asked);
        assert_int_equal(check_packed(checked.detector, s.x0, &plain), CSCD_OK);
        assert_int_equal(find_intersections_packed(asked.detector, s.x0, &all, &found), CSCD_OK);
        expect_same_knowledge(&checked, &asked);
        assert_int_equal(cscd_detector_start_state(asked.detector, 0) == CSCD_START_STATE_UNKNOWN, false);
        rig_destroy(&checked);
        rig_destroy(&asked);
    }
}

/* ---- pairs that wait --------------------------------------------------------------------------------------- */

/* Triangles 0 and 1 cross, 1 and 2 are duplicates. */
static void make_trio(double height) {
    static const double x[] = {0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 1, 1, -1, 3, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 4, 5, 3};
    scene_clear(&s);
    s.vertex_count = 6;
    s.triangle_count = 3;
    memcpy(s.triangles, triangles, sizeof triangles);
    memcpy(s.x0, x, sizeof x);
    for (uint32_t v = 3; v < 6; v++) s.x0[v * 3 + 2] += height;
}

static void expect_trio(cscd_detector *detector, size_t crossing, size_t duplicate, size_t waiting) {
    cscd_intersection_pairs found = find_pairs(detector, CSCD_ANSWER_LIST, 0);
    assert_int_equal(found.count, crossing + duplicate);
    assert_int_equal(found.crossing, crossing);
    assert_int_equal(found.duplicate, duplicate);
    assert_int_equal(found.waiting, waiting);
    for (size_t i = 0; i < found.count; i++)
        assert_int_equal(found.items[i].kind == CSCD_INTERSECTION_DUPLICATE, found.items[i].a == 1);
}

static void waiting_pairs_are_left_out(void **state) {
    static const uint32_t ignored[][2] = {{1, 0}, {0, 2}, {2, 1}};
    (void)state;
    make_trio(0.0);
    rig r = rig_create(&s, 2, NULL);
    expect_trio(r.detector, 2, 1, 0);
    assert_int_equal(cscd_detector_set_ignored(r.detector, ignored[0], 3), CSCD_OK);
    expect_trio(r.detector, 0, 0, 0);
    assert_int_equal(cscd_detector_set_ignored(r.detector, NULL, 0), CSCD_OK);
    expect_trio(r.detector, 0, 1, 2); /* a duplicate never comes apart, so it does not wait */
    make_trio(5.0);
    expect_trio(r.detector, 0, 1, 0);
    make_trio(0.0);
    expect_trio(r.detector, 2, 1, 0);
    rig_destroy(&r);
}

/* A check knows no duplicates, so what is known afterwards does not depend on them. */
static void duplicates_mark_nothing(void **state) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_intersections plain;
    (void)state;
    options.method = CSCD_METHOD_SINGLE;
    make_trio(5.0);
    rig checked = rig_create(&s, 1, &options), asked = rig_create(&s, 1, &options);
    assert_int_equal(check_packed(checked.detector, s.x0, &plain), CSCD_OK);
    assert_int_equal(plain.count, 0);
    expect_trio(asked.detector, 0, 1, 0);
    assert_true(cscd_detector_start_state(asked.detector, 1) != CSCD_START_STATE_CROSSING);
    expect_same_knowledge(&checked, &asked);
    rig_destroy(&checked);
    rig_destroy(&asked);
}

/* A seam may even unite two corners of one triangle: nothing is refused. */
static void odd_seams_are_taken(void **state) {
    static const uint32_t seams[][2] = {{3, 4}, {4, 0}};
    cscd_detector_options options = cscd_detector_defaults();
    (void)state;
    make_trio(0.0);
    options.seams = seams[0];
    options.seam_count = 2;
    options.seam_reach = INFINITY;
    rig r = rig_create(&s, 1, &options);
    cscd_intersection_pairs found = find_pairs(r.detector, CSCD_ANSWER_LIST, 0);
    assert_int_equal(found.duplicate, 1);
    assert_true(found.items[0].a == 0 && found.items[0].shared == 1); /* corner 0, with two of the other */
    const cscd_intersection_pair *last = &found.items[found.count - 1];
    assert_true(last->a == 1 && last->b == 2 && last->kind == CSCD_INTERSECTION_DUPLICATE &&
                last->shared == 3);
    cscd_intersections plain;
    assert_int_equal(check_packed(r.detector, s.x0, &plain), CSCD_OK);
    assert_int_equal(plain.count, found.count - 1);
    rig_destroy(&r);
}

/* ---- cancelled calls ------------------------------------------------------------------------------------- */

typedef struct impatient_host {
    cscd_context *context;
    uint32_t calls, at;
} impatient_host;

static bool go_on_until(void *user, const char *stage, double fraction) {
    impatient_host *h = user;
    return ++h->calls != h->at && stage != NULL && fraction >= 0.0;
}

static void cancelled_calls_change_nothing(void **state) {
    static const size_t stops[] = {0, 400};
    (void)state;
    make_spheres(0.02);
    for (int i = 0; i < 2; i++) {
        impatient_host h = {.at = 0};
        uint32_t cancelled = 0;
        cscd_context_options options = cscd_context_defaults();
        options.progress = (cscd_progress){go_on_until, &h};
        assert_int_equal(cscd_context_create(&options, &h.context), CSCD_OK);
        h.context->progress.interval_ms = 0.0; /* asks as often as it can */
        cscd_mesh *mesh = NULL;
        cscd_detector *detector = NULL;
        cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
        assert_int_equal(cscd_mesh_create(h.context, &desc, 1, &mesh), CSCD_OK);
        assert_int_equal(cscd_detector_create(h.context, mesh, NULL, NULL, &detector), CSCD_OK);
        size_t count = find_pairs(detector, CSCD_ANSWER_LIST, stops[i]).count;
        for (uint32_t at = 1; at < 40; at += 3) {
            cscd_intersection_options asked = options_for(CSCD_ANSWER_LIST, UINT64_MAX, stops[i]);
            cscd_intersection_pairs found = {.count = 4711};
            h.calls = 0;
            h.at = at;
            cscd_status status = find_intersections_packed(detector, s.x0, &asked, &found);
            assert_true(status == CSCD_CANCELLED ? found.count == 4711 : status == CSCD_OK);
            cancelled += status == CSCD_CANCELLED;
            h.at = 0;
            assert_int_equal(find_pairs(detector, CSCD_ANSWER_LIST, stops[i]).count, count);
        }
        assert_true(cancelled >= 5);
        cscd_detector_destroy(detector);
        cscd_mesh_destroy(mesh);
        cscd_context_destroy(h.context);
    }
}

/* ---- memory ---------------------------------------------------------------------------------------------- */

static cscd_status ask_everything(cscd_detector *detector, size_t found_counts[3]) {
    static const size_t stops[] = {0, 7, 0};
    for (int i = 0; i < 3; i++) {
        cscd_intersection_options options =
            options_for(i < 2 ? CSCD_ANSWER_LIST : CSCD_ANSWER_COUNT, UINT64_MAX, stops[i]);
        cscd_intersection_pairs found = {.count = 4711};
        cscd_status status = find_intersections_packed(detector, s.x0, &options, &found);
        if (status != CSCD_OK) {
            assert_int_equal(found.count, 4711);
            return status;
        }
        found_counts[i] = found.count;
    }
    return CSCD_OK;
}

/* Fails allocation n while a fresh detector is used; returns whether there was one. */
static bool fail_allocation(size_t n, uint32_t threads) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    size_t counts[3] = {0};
    options.allocator = counting_allocator_interface(&counter);
    options.thread_count = threads;
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, NULL, &detector), CSCD_OK);
    counter.fail_at = counter.calls + n;
    cscd_status status = ask_everything(detector, counts);
    bool failed = status == CSCD_OUT_OF_MEMORY;
    assert_true(failed || status == CSCD_OK);
    if (failed) assert_non_null(strstr(cscd_context_detail(context), "out of memory"));
    counter.fail_at = SIZE_MAX;
    assert_int_equal(ask_everything(detector, counts), CSCD_OK);
    assert_true(counts[0] > 300 && counts[1] == 7 && counts[2] == counts[0]);
    size_t calls = counter.calls;
    for (int i = 0; i < 5; i++) assert_int_equal(ask_everything(detector, counts), CSCD_OK);
    if (threads == 1)
        assert_int_equal(counter.calls, calls); /* else lanes share the work in another way each time */
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
    return failed;
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    make_spheres(0.02);
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        size_t n = 0;
        while (fail_allocation(n, threads)) n++;
        print_message("  %zu allocations\n", n);
        assert_true(n >= 5);
    }
}

/* ---- options --------------------------------------------------------------------------------------------- */

static void expect_refused(cscd_detector *detector, cscd_intersection_options options, const char *sentence) {
    cscd_intersection_pairs found = {.count = 4711};
    assert_int_equal(find_intersections_packed(detector, s.x0, &options, &found), CSCD_INVALID_ARGUMENT);
    assert_non_null(strstr(cscd_context_detail(cscd_mesh_context(cscd_detector_mesh(detector))), sentence));
    assert_int_equal(found.count, 4711);
}

static void wrong_options_are_refused(void **state) {
    cscd_intersection_pairs found;
    (void)state;
    make_trio(0.0);
    rig r = rig_create(&s, 1, NULL);
    expect_refused(r.detector, options_for((cscd_intersection_answer)3, UINT64_MAX, 0), "unknown answer 3");
    expect_refused(r.detector, options_for(CSCD_ANSWER_LIST, 0, 0), "no kind");
    expect_refused(r.detector, options_for(CSCD_ANSWER_LIST, ~UINT64_C(31), 0), "no kind");
    expect_refused(r.detector, (cscd_intersection_options){.struct_size = 0}, "cscd_intersection_defaults");
    assert_int_equal(find_intersections_packed(r.detector, s.x0, NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_int_equal(find_intersections_packed(r.detector, NULL, NULL, &found), CSCD_INVALID_ARGUMENT);
    assert_int_equal(find_intersections_packed(NULL, NULL, NULL, NULL), CSCD_NULL_OBJECT);
    assert_string_equal(cscd_intersection_kind_name(CSCD_INTERSECTION_FOLDED), "folded");
    assert_string_equal(cscd_intersection_kind_name((cscd_intersection_kind)5), "unknown");
    assert_int_equal(cscd_intersection_set(CSCD_INTERSECTION_TOUCHING), 16);
    rig_destroy(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(first_pairs_are_the_same),
                                       cmocka_unit_test(first_pairs_do_not_depend_on_luck),
                                       cmocka_unit_test(searches_end_early),
                                       cmocka_unit_test(caps_bound_lists),
                                       cmocka_unit_test(states_are_known_afterwards),
                                       cmocka_unit_test(waiting_pairs_are_left_out),
                                       cmocka_unit_test(duplicates_mark_nothing),
                                       cmocka_unit_test(odd_seams_are_taken),
                                       cmocka_unit_test(cancelled_calls_change_nothing),
                                       cmocka_unit_test(every_allocation_may_fail),
                                       cmocka_unit_test(wrong_options_are_refused)};
    return cmocka_run_group_tests_name("find_intersections_calls", tests, NULL, NULL);
}
