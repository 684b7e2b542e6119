/* The traversal is compared with all pairs: what it must find, what it may find, and that nothing else
 * matters. */
#include "runtime/bvh/bvh_parts.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { TRIANGLES_MAX = 1600 };

/* A flag for each pair a < b. */
typedef struct pair_table {
    uint8_t found[TRIANGLES_MAX][TRIANGLES_MAX];
    size_t count;
    uint64_t boxes_tested;
} pair_table;

static scene shape; /* large; one test at a time */
static pair_table all, kept, others;

/* Adds a pair; fails when its triangles are the same or the table has it already. */
static void add_pair(const bvh *hierarchy, triangle_pair pair, pair_table *out) {
    uint32_t a = bvh_triangle(hierarchy, pair.a), b = bvh_triangle(hierarchy, pair.b);
    assert_true(a < hierarchy->mesh->triangle_count && b < hierarchy->mesh->triangle_count && a != b);
    uint8_t *place = &out->found[a < b ? a : b][a < b ? b : a];
    assert_int_equal(*place, 0);
    *place = 1;
    out->count++;
}

static void traverse_but(const bvh_rig *r, traversal_pass pass, bool skip_adjacent, pair_table *out) {
    static bool everywhere[SCENE_TRIANGLES_MAX];
    bvh same = r->bvh;
    traversal t;
    memset(out, 0, sizeof *out);
    memset(everywhere, true, sizeof everywhere);
    bvh_skip_adjacent(&same, skip_adjacent ? everywhere : NULL);
    assert_int_equal(traversal_create(r->context, &t), CSCD_OK);
    traversal_begin(&t, &r->bvh, pass);
    for (bool more = true; more;) {
        assert_int_equal(traversal_round(&t, &more), CSCD_OK);
        for (uint32_t i = 0; i < t.worker_count; i++) {
            assert_true(t.workers[i].pair_count <= TRAVERSAL_BATCH_SIZE);
            for (uint32_t k = 0; k < t.workers[i].pair_count; k++)
                add_pair(&r->bvh, t.workers[i].pairs[k], out);
        }
    }
    out->boxes_tested = traversal_boxes_tested(&t);
    traversal_destroy(&t);
}

static void traverse_all(const bvh_rig *r, traversal_pass pass, pair_table *out) {
    traverse_but(r, pass, false, out);
}

/* ---- against all pairs ----------------------------------------------------------------------------------
 */

/* Checks that all pairs are found that no axis separates, and none that an axis separates by more than
 * rounding. Returns how many had to be found. */
static size_t check_against_gaps(const pair_table *table, double distance) {
    gap_motion m = {shape.x0, shape.x1};
    long double rounding = 0x1p-16L * motion_extent(m, shape.vertex_count);
    size_t required = 0;
    for (uint32_t a = 0; a < shape.triangle_count; a++) {
        for (uint32_t b = a + 1; b < shape.triangle_count; b++) {
            point_set first = {shape.triangles + (size_t)a * 3, 3};
            point_set second = {shape.triangles + (size_t)b * 3, 3};
            long double gap = direction_gap(m, first, second, distance + rounding);
            if (gap <= distance) assert_true(table->found[a][b]);
            if (gap > distance + rounding) assert_false(table->found[a][b]);
            required += gap <= distance;
        }
    }
    return required;
}

static size_t check_scene(bvh_setup setup, double distance) {
    bvh_rig r;
    assert_true(shape.triangle_count <= TRIANGLES_MAX);
    assert_true(bvh_rig_create(&shape, setup, &r));
    bvh_free_second_volumes(&r.bvh); /* they tell more pairs apart than axes: test_bvh_slivers.c */
    bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(distance));
    traverse_all(&r, TRAVERSAL_KEPT, &all);
    size_t required = check_against_gaps(&all, distance);
    bvh_rig_destroy(&r);
    return required;
}

TEST(finds_what_may_touch) {
    static const uint32_t region_counts[] = {1, 0, 5, 100};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (int i = 0; i < 4; i++) {
            scene_make((scene_family)family, (uint64_t)(20 + i), &shape);
            bvh_setup setup = {CSCD_SIMD_AUTO, 1, i % 2 == 0 ? BOX_AXES : KDOP_AXES,
                               region_counts[(i + family) % 4]};
            check_scene(setup, i == 3 ? 0.05 : 0.0);
        }
    }
}

/* Some bodies fly together, and some past each other. */
TEST(finds_what_may_touch_in_flight) {
    const double far[3] = {700.0, -3e4, 77.0};
    for (uint32_t i = 0; i < 3; i++) {
        scene_make(SCENE_LINKED_TORI, 25, &shape);
        translate(shape.x1, shape.vertex_count, far);
        check_scene((bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, i * 4}, 0.0);
        memcpy(shape.x1, shape.x0, (size_t)shape.vertex_count / 2 * sizeof(double[3]));
        check_scene((bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, i * 4}, 0.0);
    }
}

/* The volumes of these pairs overlap by no more than rounding. */
TEST(finds_what_just_touches) {
    random_stream random = stream_start(26);
    size_t required = 0;
    for (uint32_t i = 0; i < 16; i++) {
        make_touching_pairs(&random, 90, i % 2 == 0 ? 3.0 : 300.0, &shape);
        required += check_scene((bvh_setup){CSCD_SIMD_AUTO, 1, i % 4 < 2 ? BOX_AXES : KDOP_AXES, i / 4}, 0.0);
    }
    print_message("  %zu pairs had to be found\n", required);
    assert_true(required > 16 * 90);
}

/* More leaves than the cache of volumes can hold, all overlapping each other. */
TEST(finds_what_may_touch_in_a_crowd) {
    random_stream random = stream_start(27);
    scene_clear(&shape);
    shape.vertex_count = 300;
    shape.triangle_count = TRIANGLES_MAX;
    for (uint32_t i = 0; i < shape.vertex_count * 3; i++) {
        shape.x0[i] = stream_between(&random, 0.0, 1.0);
        shape.x1[i] = shape.x0[i] + stream_between(&random, -0.1, 0.1);
    }
    for (uint32_t t = 0; t < TRIANGLES_MAX; t++) {
        uint32_t first = stream_below(&random, shape.vertex_count - 2);
        for (uint32_t i = 0; i < 3; i++) shape.triangles[t * 3 + i] = first + i;
    }
    for (uint32_t region_count = 1; region_count < PACED(5, 2); region_count += 2)
        check_scene((bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, region_count}, 0.0);
}

/* ---- threads, levels, rounds -----------------------------------------------------------------------------
 */

static void check_same(bvh_setup setup) {
    bvh_rig r;
    if (!bvh_rig_create(&shape, setup, &r)) return;
    bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
    traverse_all(&r, TRAVERSAL_KEPT, &others);
    assert_memory_equal(&others, &all, sizeof all);
    bvh_rig_destroy(&r);
}

static void check_all_ways(uint32_t region_count) {
    bvh_setup setup = {CSCD_SIMD_SCALAR, 1, BOX_AXES, region_count};
    bvh_rig r;
    assert_true(bvh_rig_create(&shape, setup, &r));
    bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
    traverse_all(&r, TRAVERSAL_KEPT, &all);
    bvh_rig_destroy(&r);
    for (int simd = CSCD_SIMD_SCALAR; simd <= SIMD_LAST; simd++) {
        for (uint32_t threads = 1; threads <= 3; threads++)
            check_same((bvh_setup){(cscd_simd)simd, threads, BOX_AXES, region_count});
    }
}

TEST(same_pairs_on_all_levels_and_threads) {
    static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_LINKED_TORI, SCENE_SOUP,
                                            SCENE_FAR_AWAY};
    for (uint32_t i = 0; i < 4; i++) {
        scene_make(families[i], 30, &shape);
        for (uint32_t region_count = 0; region_count < 3; region_count++) check_all_ways(10 * region_count);
    }
}

/* All triangles are near all others, and there are more pairs than all batches can hold at once. */
TEST(many_rounds) {
    enum { COPIES = 4 };
    scene_make(SCENE_NOISY_SPHERE, 31, &shape);
    uint32_t corner_count = shape.triangle_count * 3;
    for (uint32_t i = corner_count; i < COPIES * corner_count; i++)
        shape.triangles[i] = shape.triangles[i - corner_count];
    shape.triangle_count *= COPIES;
    for (uint32_t i = 0; i < shape.vertex_count * 3; i++) shape.x1[i] = -3.0 * shape.x0[i] + 0.1 * (i % 7);
    check_all_ways(0);
    assert_true(all.count > 6 * TRAVERSAL_BATCH_SIZE);
    check_against_gaps(&all, 0.0);
}

/* ---- passes ----------------------------------------------------------------------------------------------
 */

static uint8_t before[TRIANGLES_MAX], now[TRIANGLES_MAX];
static bool unproven[TRIANGLES_MAX], active[TRIANGLES_MAX], some_active; /* some_active: else all are */

static bool is_hidden(const bvh_rig *r, const uint8_t *orientations, uint32_t a, uint32_t b) {
    return r->regions[a] == r->regions[b] && !orientations_may_touch(orientations[a], orientations[b]);
}

static bool is_active(uint32_t a, uint32_t b) {
    return !some_active || active[a] || active[b];
}

static bool is_kept(const bvh_rig *r, uint32_t a, uint32_t b) {
    return is_active(a, b) && !is_hidden(r, now, a, b);
}

static bool has_come(const bvh_rig *r, uint32_t a, uint32_t b) {
    return is_active(a, b) && is_hidden(r, before, a, b) && !is_hidden(r, now, a, b);
}

/* Proofs look at all triangles. */
static bool both_suspect(const bvh_rig *r, uint32_t a, uint32_t b) {
    (void)r;
    return unproven[a] && unproven[b];
}

static bool are_adjacent(uint32_t a, uint32_t b) {
    const uint32_t *corners = shape.triangles + (size_t)b * 3;
    for (uint32_t i = 0; i < 3; i++) {
        if (triangle_contains(corners, shape.triangles[a * 3 + i])) return true;
    }
    return false;
}

/* Checks that a pass finds exactly those pairs for which the predicate is true. */
static void check_pass(const bvh_rig *r, traversal_pass pass,
                       bool (*of_pass)(const bvh_rig *, uint32_t, uint32_t)) {
    for (int skip_adjacent = 0; skip_adjacent < 2; skip_adjacent++) {
        traverse_but(r, pass, skip_adjacent != 0, &kept);
        for (uint32_t a = 0; a < shape.triangle_count; a++) {
            for (uint32_t b = a + 1; b < shape.triangle_count; b++) {
                bool skipped = skip_adjacent != 0 && are_adjacent(a, b);
                assert_int_equal(kept.found[a][b], all.found[a][b] && !skipped && of_pass(r, a, b));
            }
        }
        assert_true(kept.boxes_tested <= all.boxes_tested);
    }
}

/* Chooses flags in runs, so that whole blocks have one flag, and clears some of them. */
static void choose_flags(random_stream *random, uint32_t run) {
    uint8_t flag = ORIENTATION_ZERO;
    for (uint32_t t = 0; t < shape.triangle_count; t++) {
        if (stream_below(random, run) == 0) flag = (uint8_t)(1 + stream_below(random, 3));
        before[t] = flag;
        now[t] = stream_below(random, 2 * run) == 0 ? ORIENTATION_ZERO : flag;
        unproven[t] = stream_below(random, 1 + run / 4) == 0;
        bool changes = t == 0 || stream_below(random, run) == 0;
        active[t] = changes ? stream_below(random, 3) == 0 : active[t - 1];
    }
}

static void check_passes(random_stream *random, uint32_t region_count) {
    bvh_rig r;
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 2, BOX_AXES, region_count}, &r));
    bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
    traverse_all(&r, TRAVERSAL_KEPT, &all);
    for (uint32_t i = 0, run = 1; run < 1000; i++, run = i % 2 == 0 ? run * 6 : run) {
        choose_flags(random, run);
        some_active = i % 2 == 1;
        assert_true(bvh_set_active(&r.bvh, some_active ? active : NULL));
        bvh_mark_newly_kept(&r.bvh, before, now);
        check_pass(&r, TRAVERSAL_KEPT, is_kept);
        check_pass(&r, TRAVERSAL_NEWLY_KEPT, has_come);
        bvh_mark_unproven(&r.bvh, unproven);
        check_pass(&r, TRAVERSAL_UNPROVEN, both_suspect);
    }
    bvh_rig_destroy(&r);
}

TEST(passes_are_what_flags_say) {
    random_stream random = stream_start(40);
    for (int family = 0; family < SCENE_FAMILY_COUNT; family += PACED(1, 3)) {
        scene_make((scene_family)family, 41, &shape);
        for (uint32_t region_count = 0; region_count < 3; region_count++)
            check_passes(&random, region_count * region_count * 5);
    }
}

TEST(nothing_active_is_over_at_once) {
    scene_make(SCENE_NOISY_SPHERE, 31, &shape);
    memset(active, false, sizeof active);
    for (uint32_t region_count = 0; region_count < 3; region_count++) {
        bvh_rig r;
        traversal t;
        assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, region_count * 10}, &r));
        bvh_refit(&r.bvh, shape.x0, shape.x1, uniform_growth(0.0));
        assert_int_equal(traversal_create(r.context, &t), CSCD_OK);
        assert_true(bvh_set_active(&r.bvh, active));
        traversal_begin(&t, &r.bvh, TRAVERSAL_KEPT);
        assert_int_equal(t.workers[0].stack_count, 1);
        r.bvh.kernels->search(&t, &t.workers[0], 1);
        assert_int_equal(t.workers[0].stack_count + t.workers[0].pair_count, 0);
        assert_int_equal(traversal_boxes_tested(&t), 0);
        traversal_destroy(&t);
        bvh_rig_destroy(&r);
    }
}

/* Whichever worker runs out of memory. */
TEST(no_worker_fails_unnoticed) {
    bvh_rig r;
    traversal t;
    scene_make(SCENE_TWO_SPHERES, 1, &shape);
    assert_true(bvh_rig_create(&shape, (bvh_setup){CSCD_SIMD_AUTO, 3, BOX_AXES, 1}, &r));
    assert_int_equal(traversal_create(r.context, &t), CSCD_OK);
    assert_int_equal(t.worker_count, 3);
    for (uint32_t worker = 0; worker < t.worker_count; worker++) {
        for (uint32_t i = 0; i < t.worker_count; i++) t.workers[i].out_of_memory = i == worker;
        assert_int_equal(traversal_status(&t), CSCD_OUT_OF_MEMORY);
    }
    traversal_destroy(&t);
    bvh_rig_destroy(&r);
}
