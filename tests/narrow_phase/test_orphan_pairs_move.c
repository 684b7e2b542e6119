/* Orphan pairs of meshes that were made from others: those that a search of the whole mesh finds. */
#include "runtime/narrow_phase/narrow_phase.h"
#include "tests/support/changing_mesh.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static changing_scene changing;
static scene_change change;

static int compare_pairs(const void *a, const void *b) {
    return memcmp(a, b, sizeof(uint32_t[2]));
}

static void check_same_pairs(uint32_t (*a)[2], size_t a_count, uint32_t (*b)[2], size_t b_count) {
    assert_int_equal(a_count, b_count);
    if (a_count == 0) return;
    qsort(a, a_count, sizeof *a, compare_pairs);
    qsort(b, b_count, sizeof *b, compare_pairs);
    assert_memory_equal(a, b, a_count * sizeof *a);
}

/* Without memory nothing is left. */
static void check_failures(counting_allocator *counter, const orphan_pairs *pairs,
                           const cscd_mesh_change *made) {
    size_t live = counter->live;
    cscd_status status = CSCD_OUT_OF_MEMORY;
    orphan_pairs out = {.vf_count = 0};
    for (size_t n = 0; status != CSCD_OK; n++) {
        bool too_many;
        counter->fail_at = counter->calls + n;
        status = orphan_pairs_move(pairs, made->mesh, made, &out, &too_many);
        counter->fail_at = SIZE_MAX;
        if (status != CSCD_OK) assert_int_equal(counter->live, live);
    }
    orphan_pairs_free(made->context, &out);
}

TEST(equal_those_of_the_whole_mesh) {
    size_t kept = 0, known = 0;
    for (uint64_t seed = 0; seed < 120; seed++) {
        random_stream random = stream_start(seed);
        counting_allocator counter = counting_allocator_start();
        cscd_context *context = context_of(0, &counter);
        changing_scene_make(&random, true, &changing);
        cscd_mesh *first = changing_scene_mesh(context, &changing);
        cscd_mesh_change *last = NULL, *made = NULL;
        orphan_pairs pairs, moved, expected;
        bool too_many, expected_too_many;
        assert_int_equal(orphan_pairs_create(first, &pairs, &too_many), CSCD_OK);
        for (int round = 0; round < 6 && !too_many; round++) {
            const cscd_mesh *old = last != NULL ? cscd_mesh_change_mesh(last) : first;
            uint32_t object = stream_below(&random, changing.object_count);
            if (round % 2 == 0 || !changing_scene_tear(&random, &changing, object, &change))
                changing_scene_change(&random, &changing, &change);
            assert_int_equal(cscd_mesh_change_create(context, old, change.list, change.count, &made),
                             CSCD_OK);
            if (seed % 20 == 0) check_failures(&counter, &pairs, made);
            const cscd_mesh *mesh = made->mesh;
            assert_int_equal(orphan_pairs_move(&pairs, mesh, made, &moved, &too_many), CSCD_OK);
            assert_int_equal(orphan_pairs_create(mesh, &expected, &expected_too_many), CSCD_OK);
            assert_int_equal(too_many, expected_too_many);
            kept += pairs.ee_count + pairs.vf_count;
            known += moved.ee_count + moved.vf_count;
            check_same_pairs(moved.vf, moved.vf_count, expected.vf, expected.vf_count);
            check_same_pairs(moved.ee, moved.ee_count, expected.ee, expected.ee_count);
            orphan_pairs_free(context, &expected);
            orphan_pairs_free(context, &pairs);
            pairs = moved;
            cscd_mesh_change_destroy(last);
            last = made;
        }
        orphan_pairs_free(context, &pairs);
        cscd_mesh_change_destroy(last);
        cscd_mesh_destroy(first);
        cscd_context_destroy(context);
        assert_int_equal(counter.live, 0);
    }
    assert_true(kept > 10000 && known > 10000);
}
