/* The kernels behind the feature queue: lane by lane what the scalar functions say, on every level that this
 * machine has; and whole intervals, the same on all levels and for all thread counts. */
#include "cscd/research.h"
#include "runtime/ccd/ccd.h"
#include "runtime/ccd/elementary_levels.h"
#include "tests/support/calls.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH_MAX = 200, SLACK = 8, BATCHES_A_FAMILY = 48 };

/* Queries as a mesh of their own, four vertices each. Pair i is query order[i]. */
typedef struct batch {
    cscd_contact_kind kind;
    uint32_t count, order[BATCH_MAX];
    elementary_query queries[BATCH_MAX];
    double x0[BATCH_MAX * 12], x1[BATCH_MAX * 12];
    uint32_t triangles[BATCH_MAX][3], edges[BATCH_MAX * 2][2];
    uint32_t a[BATCH_MAX + SLACK], b[BATCH_MAX + SLACK];
} batch;

static batch work; /* large; one test at a time */

/* ---- batches ----------------------------------------------------------------------------------------- */

static void add_query(const elementary_query *query, uint32_t i) {
    work.queries[i] = *query;
    memcpy(work.x0 + (size_t)i * 12, query->x0, sizeof query->x0);
    memcpy(work.x1 + (size_t)i * 12, query->x1, sizeof query->x1);
    for (uint32_t v = 0; v < 3; v++) work.triangles[i][v] = i * 4 + 1 + v;
    for (uint32_t v = 0; v < 4; v++) work.edges[i * 2 + v / 2][v % 2] = i * 4 + v;
}

static feature_source source_of_work(void) {
    return (feature_source){work.x0, work.x1, (const uint32_t(*)[3])work.triangles,
                            (const uint32_t(*)[2])work.edges};
}

static void make_batch(random_stream *random, cscd_contact_kind kind, query_family family) {
    work.kind = kind;
    work.count = stream_below(random, 4) == 0 ? stream_below(random, 20) : stream_below(random, BATCH_MAX);
    for (uint32_t i = 0; i < work.count; i++) {
        elementary_query query = generate_query(random, kind, family);
        add_query(&query, i);
    }
}

/* All pairs, in a random order. */
static feature_pairs pairs_of_work(random_stream *random) {
    for (uint32_t i = 0; i < work.count; i++) work.order[i] = i;
    for (uint32_t i = work.count; i > 1; i--) {
        uint32_t j = stream_below(random, i), moved = work.order[j];
        work.order[j] = work.order[i - 1];
        work.order[i - 1] = moved;
    }
    for (uint32_t i = 0; i < work.count; i++) {
        uint32_t q = work.order[i];
        work.a[i] = work.kind == CSCD_CONTACT_VF ? q * 4 : q * 2;
        work.b[i] = work.kind == CSCD_CONTACT_VF ? q : q * 2 + 1;
    }
    return (feature_pairs){work.a, work.b, work.count};
}

static uint32_t query_of(uint32_t a) {
    return work.kind == CSCD_CONTACT_VF ? a / 4 : a / 2;
}

typedef bool query_predicate(uint32_t i);
typedef void list_kernel(const feature_source *source, feature_pairs *pairs);

/* The kernel keeps, in their order, those of which the scalar code says so. */
static void check_kept(random_stream *random, list_kernel *kernel, query_predicate *kept, uint64_t *total) {
    feature_source source = source_of_work();
    feature_pairs pairs = pairs_of_work(random);
    uint32_t count = 0;
    kernel(&source, &pairs);
    for (uint32_t i = 0; i < work.count; i++) {
        if (!kept(work.order[i])) continue;
        assert_true(count < pairs.count);
        assert_int_equal(query_of(pairs.a[count++]), work.order[i]);
    }
    assert_int_equal(pairs.count, count);
    *total += count;
}

static coplanarity cubic_of(uint32_t i, point_vectors *vectors) {
    point_vectors_from(&work.queries[i], work.kind, vectors);
    return coplanarity_cubic(vectors);
}

static bool open_after_signs(uint32_t i) {
    point_vectors vectors;
    coplanarity f = cubic_of(i, &vectors);
    return !separated_by_axes(&work.queries[i], work.kind) && !coplanarity_excluded(&f);
}

static void for_each_batch(uint64_t seed, void (*check)(random_stream *, const ccd_kernels *)) {
    for (int level = 0; level < LEVEL_COUNT; level++) {
        if (contexts[level] == NULL) continue;
        random_stream random = stream_start(seed);
        for (int i = 0; i < FAMILY_COUNT * 2 * BATCHES_A_FAMILY; i++) {
            make_batch(&random, (cscd_contact_kind)(i % 2), (query_family)(i / 2 % FAMILY_COUNT));
            check(&random, ccd_kernels_of(contexts[level]));
        }
    }
}

/* ---- lane by lane ------------------------------------------------------------------------------------ */

static uint64_t kept_total, pair_total;

static void check_open(random_stream *random, const ccd_kernels *table) {
    check_kept(random, work.kind == CSCD_CONTACT_VF ? table->reject_by_signs_vf : table->reject_by_signs_ee,
               open_after_signs, &kept_total);
    pair_total += work.count;
}

TEST(signs_as_scalar) {
    kept_total = pair_total = 0;
    for_each_batch(72, check_open);
    assert_true(kept_total * 10 > pair_total && kept_total * 10 < pair_total * 9);
}

/* What one root decided, and what two or none: hits and misses; what neither did. */
typedef struct root_counts {
    uint64_t hits[2], misses[2], left;
} root_counts;

static root_counts totals;

/* What the kernel says, the scalar level two says at its roots, from the same interval. */
static void check_decided(uint32_t i, bool single, bool hit, double begin) {
    point_vectors vectors;
    coplanarity f = cubic_of(i, &vectors);
    root_interval roots[ROOTS_MAX];
    const root_interval *touching = NULL;
    int count = cubic_isolate(&f, roots);
    assert_true(single ? count == 1 : count == 0 || count == 2);
    for (int k = 0; k < count && touching == NULL; k++) {
        inside_verdict inside = inside_test(&vectors, work.kind, &roots[k]);
        assert_true(inside == INSIDE_YES || inside == INSIDE_NO);
        if (inside == INSIDE_YES) touching = &roots[k];
    }
    assert_int_equal(hit, touching != NULL);
    if (hit) assert_true(touching->begin == begin && touching->end - begin <= 0x1p-31 && touching->certain);
    if (hit) assert_true(touching->toi == begin);
    elementary_contact unused;
    assert_int_equal(elementary_after_signs(&work.queries[i], work.kind, &unused).touching, hit);
}

static void check_eight(const ccd_kernels *table, const feature_source *source, const feature_pairs *pairs,
                        uint32_t i) {
    bool vf = work.kind == CSCD_CONTACT_VF;
    root_outcomes roots[2];
    (vf ? table->roots_vf : table->roots_ee)(source, pairs->a + i, pairs->b + i, &roots[0]);
    (vf ? table->two_roots_vf : table->two_roots_ee)(source, pairs->a + i, pairs->b + i, &roots[1]);
    for (uint32_t lane = 0; lane < LANES && i + lane < pairs->count; lane++) {
        uint32_t decided = 0;
        for (int k = 0; k < 2; k++) {
            bool hit = roots[k].contacts >> lane & 1, miss = roots[k].apart >> lane & 1;
            assert_false(hit && miss);
            if (hit || miss) check_decided(query_of(pairs->a[i + lane]), k == 0, hit, roots[k].begin[lane]);
            totals.hits[k] += hit;
            totals.misses[k] += miss;
            decided += hit || miss;
        }
        assert_true(decided <= 1);
        totals.left += decided == 0;
    }
}

static void check_roots(random_stream *random, const ccd_kernels *table) {
    feature_source source = source_of_work();
    feature_pairs pairs = pairs_of_work(random);
    if (pairs.count == 0) return;
    for (uint32_t i = 0; i < SLACK; i++) {
        pairs.a[pairs.count + i] = pairs.a[0];
        pairs.b[pairs.count + i] = pairs.b[0];
    }
    for (uint32_t i = 0; i < pairs.count; i += LANES) check_eight(table, &source, &pairs, i);
}

/* The counts prove that each answer is given, and that all levels give it to the same pairs. */
TEST(roots_as_scalar) {
    root_counts first = {0};
    for (int level = 0; level < LEVEL_COUNT; level++) {
        cscd_context *others[LEVEL_COUNT];
        if (contexts[level] == NULL) continue;
        totals = (root_counts){0};
        memcpy(others, contexts, sizeof others);
        memset(contexts, 0, sizeof contexts);
        contexts[level] = others[level];
        for_each_batch(73, check_roots);
        memcpy(contexts, others, sizeof others);
        if (level == 0) first = totals;
        assert_memory_equal(&totals, &first, sizeof totals);
    }
    for (int k = 0; k < 2; k++) {
        printf("%s: hits %llu, misses %llu\n", k == 0 ? "one root" : "two or none",
               (unsigned long long)totals.hits[k], (unsigned long long)totals.misses[k]);
        assert_true(totals.hits[k] >= 1000 && totals.misses[k] >= 1000);
    }
    printf("left %llu\n", (unsigned long long)totals.left);
    assert_true(totals.left >= 1000);
}

/* ---- whole intervals --------------------------------------------------------------------------------- */

typedef struct answer {
    cscd_contact *contacts;
    size_t count;
    cscd_counters counters;
} answer;

static scene interval;

static answer detect_contacts(cscd_simd simd, uint32_t threads, cscd_method method, double distance) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options wanted = cscd_detector_defaults();
    cscd_object_desc desc =
        cscd_object_of_triangles(interval.vertex_count, interval.triangle_count, interval.triangles);
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_contacts found;
    options.simd = simd;
    options.thread_count = threads;
    wanted.method = method;
    wanted.min_separation = distance;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, &wanted, &detector), CSCD_OK);
    assert_int_equal(step_packed(detector, interval.x0, interval.x1, &found), CSCD_OK);
    answer out = {malloc((found.count + 1) * sizeof *out.contacts), found.count,
                  cscd_detector_counters(detector)};
    assert_non_null(out.contacts);
    if (found.count > 0) memcpy(out.contacts, found.items, found.count * sizeof *out.contacts);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return out;
}

static size_t check_interval(cscd_method method, double distance) {
    answer first = detect_contacts(CSCD_SIMD_SCALAR, 1, method, distance);
    for (int level = 0; level < LEVEL_COUNT; level++) {
        for (uint32_t threads = 1; threads <= 3 && contexts[level] != NULL; threads++) {
            answer other = detect_contacts((cscd_simd)(CSCD_SIMD_SCALAR + level), threads, method, distance);
            assert_int_equal(other.count, first.count);
            assert_memory_equal(other.contacts, first.contacts, first.count * sizeof *first.contacts);
            assert_memory_equal(&other.counters, &first.counters, sizeof first.counters);
            free(other.contacts);
        }
    }
    assert_true(first.counters.tests <= first.counters.feature_pairs);
    if (distance == 0.0)
        assert_int_equal(first.counters.by_signs + first.counters.by_roots + first.counters.by_exact,
                         first.counters.tests);
    free(first.contacts);
    return first.count;
}

TEST(same_on_all_levels) {
    size_t contacts = 0;
    for (int i = 0; i < SCENE_FAMILY_COUNT * 6; i++) {
        scene_make((scene_family)(i % SCENE_FAMILY_COUNT), (uint64_t)i, &interval);
        contacts += check_interval(CSCD_METHOD_NONE, 0.0);
        contacts += check_interval(CSCD_METHOD_SINGLE, 0.0);
        if (i < SCENE_FAMILY_COUNT) contacts += check_interval(CSCD_METHOD_BRUTE, 0.0);
        if (i < SCENE_FAMILY_COUNT) contacts += check_interval(CSCD_METHOD_NONE, 1e-3);
    }
    printf("%zu contacts\n", contacts);
    assert_true(contacts >= 1000);
}

AROUND_ALL(open_levels, close_levels)
