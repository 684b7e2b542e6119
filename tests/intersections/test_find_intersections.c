/* Intersections by kind through the API: all pairs by the oracle, what options ask for, and what is left out. */
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/intersections/kind_oracle.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <stdio.h>
#include <string.h>

enum { SCENES = NIGHTLY(15, 150) };

static integer_scene s; /* large; one test at a time */
static cscd_intersection expected[PAIRS_MAX], before[PAIRS_MAX];

static rig rig_up(uint32_t threads, cscd_method method) {
    rig r = {NULL};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = threads;
    expect_ok(cscd_context_create(&options, &r.context));
    r.mesh = integer_scene_mesh(&s, r.context);
    r.detector = integer_scene_detector(&s, r.mesh, method);
    return r;
}

static cscd_intersections find_pairs(const rig *r, cscd_intersection_answer answer, uint64_t kinds,
                                     size_t stop_after) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = answer;
    options.kinds = kinds;
    options.stop_after = stop_after;
    expect_ok(find_intersections_packed(r->detector, s.positions, &options, &found));
    return found;
}

/* ---- one answer ---------------------------------------------------------------------------------------- */

static void expect_pair(const rig *r, const cscd_intersection *is, const cscd_intersection *wanted) {
    assert_int_equal(is->a, wanted->a);
    assert_int_equal(is->b, wanted->b);
    assert_int_equal(is->kind, wanted->kind);
    assert_int_equal(is->shared, wanted->shared);
    assert_memory_equal(is->objects, wanted->objects, sizeof is->objects);
    assert_int_equal(is->components[0], cscd_mesh_triangle_component(r->mesh, is->a));
    assert_int_equal(is->components[1], cscd_mesh_triangle_component(r->mesh, is->b));
}

static void expect_counts(const cscd_intersections *found, const cscd_intersection *pairs, size_t count) {
    size_t of_kind[CSCD_INTERSECTION_TOUCHING + 1] = {0};
    for (size_t i = 0; i < count; i++) of_kind[pairs[i].kind]++;
    assert_int_equal(found->count, count);
    assert_int_equal(found->crossing, of_kind[CSCD_INTERSECTION_CROSSING]);
    assert_int_equal(found->coplanar, of_kind[CSCD_INTERSECTION_COPLANAR]);
    assert_int_equal(found->folded, of_kind[CSCD_INTERSECTION_FOLDED]);
    assert_int_equal(found->duplicate, of_kind[CSCD_INTERSECTION_DUPLICATE]);
    assert_int_equal(found->touching, of_kind[CSCD_INTERSECTION_TOUCHING]);
}

/* The list has exactly the expected pairs. */
static void expect_list(const rig *r, const cscd_intersections *found, size_t count) {
    expect_counts(found, expected, count);
    for (size_t i = 0; i < count; i++) expect_pair(r, &found->items[i], &expected[i]);
    assert_false(found->stopped);
    assert_int_equal(cscd_detector_waiting(r->detector).triangles, 0);
}

/* Sorted, and all of them expected. */
static void expect_some_of(const rig *r, const cscd_intersections *found, size_t count) {
    size_t next = 0;
    expect_counts(found, found->items, found->count);
    for (size_t i = 0; i < found->count; i++) {
        while (next < count &&
               (expected[next].a != found->items[i].a || expected[next].b != found->items[i].b))
            next++;
        assert_true(next < count);
        expect_pair(r, &found->items[i], &expected[next++]);
    }
}

/* ---- all answers for a set of kinds ---------------------------------------------------------------------- */

/* A search without duplicates has all other pairs. */
static void compare_with_check(const rig *r, size_t count) {
    cscd_intersections plain;
    size_t next = 0;
    expect_ok(check_packed(r->detector, s.positions, &plain));
    for (size_t i = 0; i < count; i++) {
        if (expected[i].kind == CSCD_INTERSECTION_DUPLICATE) continue;
        assert_true(next < plain.count);
        assert_int_equal(plain.items[next].a, expected[i].a);
        assert_int_equal(plain.items[next++].b, expected[i].b);
    }
    assert_int_equal(next, plain.count);
    cscd_intersections found = find_pairs(r, CSCD_ANSWER_COUNT, UINT64_MAX, 0);
    assert_int_equal(found.zero_area_triangles, plain.zero_area_triangles);
    assert_int_equal(found.first_zero_area, plain.first_zero_area);
}

/* The first call of a size is kept in `before`; those of other thread counts must be the same. */
static void compare_first_pairs(const rig *r, uint64_t kinds, size_t stop_after, size_t count, bool first) {
    cscd_intersections found = find_pairs(r, CSCD_ANSWER_LIST, kinds, stop_after);
    assert_int_equal(found.count, stop_after < count ? stop_after : count);
    assert_int_equal(found.stopped, stop_after <= count);
    expect_some_of(r, &found, count);
    if (first) memcpy(before, found.items, found.count * sizeof *before);
    assert_memory_equal(before, found.items, found.count * sizeof *before);
    cscd_intersections counted = find_pairs(r, CSCD_ANSWER_COUNT, kinds, stop_after);
    expect_counts(&counted, before, found.count);
    assert_null(counted.items);
}

static void compare_answers(const rig *r, uint64_t kinds, size_t count) {
    cscd_intersections found = find_pairs(r, CSCD_ANSWER_LIST, kinds, 0);
    expect_list(r, &found, count);
    found = find_pairs(r, CSCD_ANSWER_COUNT, kinds, 0);
    expect_counts(&found, expected, count);
    assert_null(found.items);
    found = find_pairs(r, CSCD_ANSWER_ANY, kinds, 0);
    assert_int_equal(found.count, count > 0);
    assert_int_equal(found.stopped, count > 0);
    assert_null(found.items);
    assert_int_equal(found.crossing + found.coplanar + found.folded + found.duplicate + found.touching, 0);
}

static void compare_scene(uint64_t seed, size_t of_kind[]) {
    static const cscd_method methods[] = {CSCD_METHOD_AUTO,     CSCD_METHOD_NONE,  CSCD_METHOD_SINGLE,
                                          CSCD_METHOD_KMEANS,   CSCD_METHOD_BRUTE, CSCD_METHOD_ICCD,
                                          CSCD_METHOD_PUBLISHED};
    integer_scene_make(seed, &s);
    size_t all = integer_scene_pairs(&s, UINT64_MAX, expected);
    for (size_t i = 0; i < all; i++) of_kind[expected[i].kind]++;
    for (uint32_t i = 0; i < 7; i++) {
        uint32_t threads = 1 + (i + (uint32_t)seed) % 4;
        uint64_t some = 1 + (seed + i) % 31;
        rig r = rig_up(threads, method_or_none(methods[i]));
        compare_answers(&r, UINT64_MAX, integer_scene_pairs(&s, UINT64_MAX, expected));
        compare_with_check(&r, all);
        compare_answers(&r, some, integer_scene_pairs(&s, some, expected));
        rig_destroy(&r);
    }
    size_t sizes[] = {1, 2, 5, all / 2 + 1, all, all + 1};
    uint64_t kinds[] = {UINT64_MAX, 1 + seed % 31};
    rig rigs[4];
    for (uint32_t i = 0; i < 4; i++) rigs[i] = rig_up(1 + i, CSCD_METHOD_NONE);
    for (uint32_t i = 0; i < 48; i++) {
        size_t count = integer_scene_pairs(&s, kinds[i / 4 % 2], expected), stop_after = sizes[i / 8];
        if (stop_after > 0)
            compare_first_pairs(&rigs[i % 4], kinds[i / 4 % 2], stop_after, count, i % 4 == 0);
    }
    for (int i = 0; i < 4; i++) rig_destroy(&rigs[i]);
}

TEST(equals_the_oracle) {
    size_t of_kind[CSCD_INTERSECTION_TOUCHING + 1] = {0};
    for (uint64_t seed = 0; seed < SCENES; seed++) compare_scene(seed, of_kind);
    for (int kind = 0; kind <= CSCD_INTERSECTION_TOUCHING; kind++) {
        printf("%s %zu  ", cscd_intersection_kind_name((cscd_intersection_kind)kind), of_kind[kind]);
        assert_true(of_kind[kind] > SCENES);
    }
    puts("");
}
