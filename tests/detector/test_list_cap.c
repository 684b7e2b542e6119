/* A cap on the length of lists: the number that is counted, the memory that is not taken, and what is known afterwards. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <stdio.h>
#include <string.h>

enum { SCENES = NIGHTLY(6, 12) };

static scene s; /* large; one test at a time */

/* Two detectors of one mesh in contexts of their own: one that has caps, and one that has none. */
typedef struct capped_pair {
    counting_allocator counters[2];
    rig rigs[2];
    cscd_detector *capped, *free;
    size_t asked[2]; /* calls of ignore */
    bool ignores;
} capped_pair;

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    ++*(size_t *)user;
    return (a * 7 + b + (uint32_t)kind) % 5 == 0;
}

static void pair_begin(capped_pair *p, cscd_detector_options options, uint32_t threads) {
    const cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    for (int i = 0; i < 2; i++) {
        p->counters[i] = counting_allocator_start();
        p->asked[i] = 0;
        options.ignore = p->ignores ? ignore_some : NULL;
        options.ignore_user = &p->asked[i];
        p->rigs[i] = rig_of_objects(context_of(threads, &p->counters[i]), &desc, 1, s.x0, &options);
    }
    p->capped = p->rigs[0].detector;
    p->free = p->rigs[1].detector;
}

static void pair_end(capped_pair *p) {
    for (int i = 0; i < 2; i++) {
        rig_destroy(&p->rigs[i]);
        assert_int_equal(p->counters[i].live, 0);
    }
}

/* beside: so much room have workers beside their share. With little they are suspended often. */
static void set_cap(capped_pair *p, size_t longest, size_t beside) {
    expect_ok(cscd_detector_set_longest_list(p->capped, longest));
    p->capped->interval.cap.beside = beside;
}

/* ---- each list ----------------------------------------------------------------------------------------- */

typedef struct any_list {
    const void *items;
    size_t count, item_size;
} any_list;

typedef enum call_kind { STEP, CHECK, NEAR, UNIQUE, BOUNDS, TRUNCATE, CALL_KINDS } call_kind;

static const double distance = 0.15;

/* Of bounds and truncation the list is within the library; `blocked` and `held` stand for it when it is not too long. */
static cscd_status call_it(cscd_detector *d, call_kind kind, const double *x0, const double *x1,
                           any_list *out) {
    static double scratch[SCENE_VERTICES_MAX * 3];
    cscd_contacts contacts = {.count = 0};
    cscd_intersections crossing = {.count = 0};
    cscd_proximities near = {.count = 0};
    cscd_displacement_bounds bounds = {.near_count = 0};
    cscd_truncation cut = {.near_count = 0};
    cscd_status status = CSCD_OK;
    switch (kind) {
    case STEP:
        status = step_packed(d, x0, x1, &contacts);
        *out = (any_list){contacts.items, contacts.count, sizeof *contacts.items};
        break;
    case CHECK:
        status = check_packed(d, x1, &crossing);
        *out = (any_list){crossing.items, crossing.count, sizeof *crossing.items};
        break;
    case NEAR:
        status = find_near_packed(d, x1, distance, &near);
        *out = (any_list){near.items, near.count, sizeof *near.items};
        break;
    case UNIQUE:
        status = find_unique_packed(d, x1, distance, &near);
        *out = (any_list){near.items, near.count, sizeof *near.items};
        break;
    case BOUNDS:
        status = displacement_bounds_packed(d, x0, distance, scratch, &bounds);
        *out = (any_list){bounds.blocked, bounds.near_count, 0};
        break;
    default:
        status = truncate_packed(d, x1, x0, distance, scratch, &cut); /* from where the last step ended */
        *out = (any_list){cut.held, cut.near_count, 0};
    }
    return status;
}

static void expect_equal_lists(const any_list *a, const any_list *b) {
    assert_int_equal(a->count, b->count);
    if (a->count > 0 && a->item_size > 0) assert_memory_equal(a->items, b->items, a->count * a->item_size);
}

/* The number of pairs that the items of a list stand for. */
static size_t pairs_of(const any_list *list, call_kind kind) {
    const cscd_proximity *items = list->items;
    size_t count = list->count;
    for (size_t i = 0; kind == UNIQUE && i < list->count; i++) count += items[i].count - 1;
    return count;
}

/* One call under caps below, at and above its length; then what is known of the end is the same as without caps. */
static void compare_call(capped_pair *p, call_kind kind, const double *x0, const double *x1,
                         random_stream *random, size_t *sum) {
    any_list truth, found;
    size_t asked = p->asked[1], beside = stream_below(random, 2) == 0 ? 1 : 1 + stream_below(random, 400);
    expect_ok(call_it(p->free, kind, x0, x1, &truth));
    size_t length = pairs_of(&truth, kind);
    asked = p->asked[1] - asked;
    if (length > 1) {
        const size_t caps[] = {1, 1 + length / 2, length - 1};
        set_cap(p, caps[stream_below(random, length > 2 ? 3 : 1)], beside);
        size_t before = p->asked[0];
        assert_int_equal(call_it(p->capped, kind, x0, x1, &found), CSCD_LIST_TOO_LONG);
        assert_null(found.items);
        assert_int_equal(found.count, length);
        if (kind != TRUNCATE) assert_int_equal(p->asked[0] - before, asked); /* it asks again, to taint */
        char sentence[128];
        snprintf(sentence, sizeof sentence, "the list would have %zu items, more than longest_list", length);
        assert_non_null(strstr(cscd_context_detail(p->rigs[0].context), sentence));
        sum[0]++;
    }
    set_cap(p, length + stream_below(random, 2), beside);
    expect_ok(call_it(p->capped, kind, x0, x1, &found));
    expect_equal_lists(&truth, &found);
    sum[1] += truth.count;
}

static void compare_states(const capped_pair *p) {
    const start_states *a = &p->capped->known.starts, *b = &p->free->known.starts;
    assert_int_equal(a->known, b->known);
    assert_memory_equal(a->triangles, b->triangles, s.triangle_count);
}

static void go_to(double share, double *out) {
    for (uint32_t i = 0; i < s.vertex_count * 3; i++) out[i] = s.x0[i] + share * (s.x1[i] - s.x0[i]);
}

/* In place of a family: a closed shell that is pressed through itself, with thousands of contacts, or a sheet whose
 * corners fold. */
enum { CRUMPLED_SHELL = SCENE_FAMILY_COUNT, CRUMPLED_SHEET };

static void make_scene(int family, uint64_t seed) {
    const double centre[3] = {0.0, 0.0, 0.0};
    random_stream random = stream_start(seed);
    if (family < SCENE_FAMILY_COUNT) {
        scene_make((scene_family)family, seed, &s);
        return;
    }
    scene_clear(&s);
    if (family == CRUMPLED_SHELL)
        scene_add_torus(&s, centre, 1.0, 0.4, 26, 26, false);
    else
        scene_add_sheet(&s, 2.0, 2.0, 24, 24);
    for (uint32_t i = 0; i < s.vertex_count * 3; i++) {
        s.x0[i] += stream_between(&random, -1e-3, 1e-3);
        s.x1[i] = (i % 3 == 2 ? -0.6 : 0.9) * s.x0[i] + stream_between(&random, -0.1, 0.1);
    }
}

static void run_scene(int family, uint64_t seed, cscd_detector_options options, uint32_t threads,
                      size_t *sum) {
    static double from[SCENE_VERTICES_MAX * 3], to[SCENE_VERTICES_MAX * 3];
    static const double shares[] = {0.0, 0.5, 1.0, 0.8, 0.2, 0.9};
    static uint32_t ignored[300][2];
    capped_pair p = {.ignores = seed % 3 == 0};
    random_stream random = stream_start(seed);
    make_scene(family, seed);
    for (int i = 0; i < 300; i++)
        for (int k = 0; k < 2; k++) ignored[i][k] = stream_below(&random, s.triangle_count);
    options.ignored = &ignored[0][0];
    options.ignored_count = seed % 2 == 0 ? 300 : 0;
    pair_begin(&p, options, threads);
    for (int i = 0; i < 5; i++) {
        go_to(shares[i], from);
        go_to(shares[i + 1], to);
        compare_call(&p, STEP, from, to, &random, sum);
        compare_states(&p);
        if (stream_below(&random, 3) > 0) continue;
        compare_call(&p, (call_kind)stream_below(&random, CALL_KINDS), from, to, &random, sum);
        compare_states(&p);
    }
    for (int kind = 0; kind < CALL_KINDS; kind++) {
        compare_call(&p, (call_kind)kind, from, to, &random, sum);
        compare_states(&p);
    }
    pair_end(&p);
}

TEST(lists_are_counted_without_being_kept) {
    const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_BRUTE,
                                   CSCD_METHOD_KMEANS, method_or_none(CSCD_METHOD_ICCD)};
    size_t sum[2] = {0};
    for (int i = 0; i < 5 * SCENES; i++) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[i % 5];
        options.mode = i % 4 == 3 ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL;
        if (i % 7 == 6) options.min_separation = 0.05;
        run_scene(i % SCENE_FAMILY_COUNT, (uint64_t)i, options, 1 + (uint32_t)i % 3, sum);
    }
    print_message("  %zu lists were too long, %zu items were compared\n", sum[0], sum[1]);
    assert_true(sum[0] > 200 && sum[1] > 10000);
}

/* Workers are suspended in the middle of a pass, and contacts that have left them taint as others. */
TEST(workers_are_suspended_in_mid_pass) {
    const cscd_method methods[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_NONE, CSCD_METHOD_KMEANS};
    size_t sum[2] = {0};
    for (int i = PACED(0, 3); i < 9; i += PACED(1, 2)) {
        cscd_detector_options options = cscd_detector_defaults();
        options.method = methods[i % 3];
        options.mode = i % 4 == 3 ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL;
        run_scene(i >= 6 ? CRUMPLED_SHEET : CRUMPLED_SHELL, (uint64_t)i, options, 1 + (uint32_t)i % 3, sum);
    }
    print_message("  %zu lists were too long, %zu items were compared\n", sum[0], sum[1]);
    assert_true(sum[0] > PACED(100, 20) && sum[1] > 100000);
}

/* ---- lines --------------------------------------------------------------------------------------------- */

TEST(lines_have_the_cap_too) {
    capped_pair p = {.ignores = false};
    cscd_line_search *lines[2];
    cscd_proximities truth, found;
    cscd_free_step steps[2];
    scene_make(SCENE_FOLDED_SHEET, 7, &s);
    pair_begin(&p, cscd_detector_defaults(), 2);
    set_cap(&p, 3, 1);
    for (int i = 0; i < 2; i++) {
        expect_ok(cscd_line_search_create(i == 0 ? p.capped : p.free, &lines[i]));
        expect_ok(line_begin_packed(lines[i], s.x0, s.x1, distance));
        expect_ok(line_max_step_packed(lines[i], 1.0, NULL, &steps[i]));
    }
    assert_true(steps[0].limited && steps[0].fraction == steps[1].fraction);
    expect_ok(cscd_line_search_find_near(lines[1], 0.5, distance, CSCD_NEAR_PAIRS, &truth));
    assert_int_equal(cscd_line_search_find_near(lines[0], 0.5, distance, CSCD_NEAR_PAIRS, &found),
                     CSCD_LIST_TOO_LONG);
    assert_true(truth.count > 100 && found.items == NULL);
    assert_int_equal(found.count, truth.count);
    set_cap(&p, truth.count, 1);
    expect_ok(cscd_line_search_find_near(lines[0], 0.5, distance, CSCD_NEAR_PAIRS, &found));
    assert_memory_equal(found.items, truth.items, truth.count * sizeof *truth.items);
    expect_ok(max_step_packed(p.capped, s.x0, s.x1, NULL, &steps[0]));
    for (int i = 0; i < 2; i++) cscd_line_search_destroy(lines[i]);
    pair_end(&p);
}

/* ---- memory -------------------------------------------------------------------------------------------- */

/* A long list takes no more memory under a cap than the cap and the workers' own room call for. */
TEST(memory_is_bounded) {
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        capped_pair p = {.ignores = threads == 1};
        any_list list;
        scene_make(SCENE_NOISY_SPHERE, 1, &s);
        pair_begin(&p, cscd_detector_defaults(), threads);
        set_cap(&p, 100, 100);
        for (int i = 0; i < 2; i++) { /* the first calls build trees */
            cscd_detector *d = i == 0 ? p.capped : p.free;
            cscd_proximities near;
            expect_ok(find_near_packed(d, s.x0, 1e-9, &near));
            p.counters[i].peak = p.counters[i].bytes;
        }
        size_t before[2] = {p.counters[0].bytes, p.counters[1].bytes};
        cscd_proximities truth, found;
        expect_ok(find_near_packed(p.free, s.x0, 3.0, &truth));
        assert_int_equal(find_near_packed(p.capped, s.x0, 3.0, &found), CSCD_LIST_TOO_LONG);
        assert_int_equal(found.count, truth.count);
        size_t capped = p.counters[0].peak - before[0], whole = p.counters[1].peak - before[1];
        print_message("  %zu pairs take %zu KiB, and %zu KiB under a cap, with %u threads\n", truth.count,
                      whole / 1024, capped / 1024, threads);
        assert_true(whole > 20 * capped);
        assert_int_equal(call_it(p.capped, NEAR, s.x0, s.x0, &list), CSCD_LIST_TOO_LONG);
        pair_end(&p);
    }
}

/* The cap goes over to a clone, and to a larger mesh. */
TEST(clones_and_torn_meshes_keep_the_cap) {
    static double x0[2 * SCENE_VERTICES_MAX * 3], x1[2 * SCENE_VERTICES_MAX * 3];
    capped_pair p = {.ignores = false};
    cscd_detector *clone;
    cscd_mesh_change *change;
    any_list truth, found;
    make_scene(CRUMPLED_SHELL, 3);
    pair_begin(&p, cscd_detector_defaults(), 2);
    set_cap(&p, 10, 1);
    expect_ok(call_it(p.free, STEP, s.x0, s.x1, &truth));
    expect_ok(cscd_detector_clone(p.rigs[0].context, p.capped, &clone));
    assert_int_equal(call_it(clone, STEP, s.x0, s.x1, &found), CSCD_LIST_TOO_LONG);
    assert_int_equal(found.count, truth.count);
    cscd_detector_destroy(clone);
    const cscd_object_desc twin = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    const cscd_object_change added = {.object = UINT32_MAX, .desc = &twin};
    expect_ok(cscd_mesh_change_create(p.rigs[0].context, p.rigs[0].mesh, &added, 1, &change));
    expect_ok(cscd_detector_change_mesh(p.capped, change));
    for (uint32_t i = 0; i < s.vertex_count * 3; i++) {
        x0[i] = s.x0[i];
        x1[i] = s.x1[i];
        x0[s.vertex_count * 3 + i] = s.x0[i] + 100.0;
        x1[s.vertex_count * 3 + i] = s.x1[i] + 100.0;
    }
    assert_int_equal(call_it(p.capped, STEP, x0, x1, &found), CSCD_LIST_TOO_LONG);
    assert_true(found.count > truth.count);
    size_t count = found.count;
    set_cap(&p, 0, 1);
    expect_ok(call_it(p.capped, STEP, x0, x1, &found));
    assert_int_equal(found.count, count);
    assert_int_equal(cscd_detector_set_longest_list(NULL, 1), CSCD_NULL_OBJECT);
    cscd_mesh_change_destroy(change);
    pair_end(&p);
}
