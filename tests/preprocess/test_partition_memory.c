/* Partitions: every allocation fails once; nothing leaks, and a partition that cannot be renewed stays. */
#include "tests/support/counting_allocator.h"
#include "tests/support/packed.h"
#include "tests/support/preprocess/partition_check.h"
#include "tests/support/test.h"

#include <string.h>

typedef struct fixture {
    counting_allocator counter;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    body shape;
} fixture;

static void fixture_begin(fixture *f) {
    f->shape = body_of(BODY_DUMBBELL, 1500);
    f->counter = counting_allocator_start();
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(&f->counter);
    cscd_object_desc desc =
        cscd_object_of_triangles(f->shape.vertex_count, f->shape.triangle_count, f->shape.triangles);
    cscd_plan_options plan_options = cscd_plan_defaults();
    plan_options.method = CSCD_METHOD_KMEANS;
    assert_int_equal(cscd_context_create(&options, &f->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(f->context, &desc, 1, &f->mesh), CSCD_OK);
    assert_int_equal(plan_create_packed(f->mesh, f->shape.positions, &plan_options, &f->plan), CSCD_OK);
}

static void fixture_end(fixture *f) {
    cscd_plan_destroy(f->plan);
    cscd_mesh_destroy(f->mesh);
    cscd_context_destroy(f->context);
    assert_int_equal(f->counter.live, 0);
    body_free(&f->shape);
}

static cscd_partition_options watched_within(void) {
    cscd_partition_options options = cscd_partition_defaults();
    options.within = true;
    return options;
}

static void check_failure(const fixture *f, cscd_status status, size_t bytes) {
    assert_int_equal(status, CSCD_OUT_OF_MEMORY);
    assert_int_equal(cscd_context_bytes(f->context), bytes);
    assert_non_null(strstr(cscd_context_detail(f->context), "out of memory"));
}

static void create_without_memory(void **state) {
    (void)state;
    fixture f;
    fixture_begin(&f);
    cscd_partition_options options = watched_within();
    size_t bytes = cscd_context_bytes(f.context), failures = 0;
    for (;; failures++) {
        cscd_partition *partition = NULL;
        f.counter.fail_at = f.counter.calls + failures;
        cscd_status status = partition_create_packed(f.mesh, f.plan, f.shape.positions, &options, &partition);
        if (status == CSCD_OK) {
            check_partition(partition);
            cscd_partition_destroy(partition);
            break;
        }
        assert_null(partition);
        check_failure(&f, status, bytes);
    }
    assert_int_equal(cscd_context_bytes(f.context), bytes);
    assert_true(failures > 30);
    fixture_end(&f);
}

static void renew_without_memory(void **state) {
    (void)state;
    fixture f;
    fixture_begin(&f);
    cscd_partition_options options = watched_within();
    cscd_partition *partition = NULL;
    assert_int_equal(partition_create_packed(f.mesh, f.plan, f.shape.positions, &options, &partition),
                     CSCD_OK);
    uint32_t cells = cscd_partition_cell_count(partition);
    size_t bytes = cscd_context_bytes(f.context), failures = 0;
    for (uint32_t v = 0; v < f.shape.vertex_count; v++) f.shape.positions[v * 3] *= 3.0;
    for (;; failures++) {
        f.counter.fail_at = f.counter.calls + failures;
        cscd_status status = partition_renew_packed(partition, f.shape.positions, 1);
        if (status == CSCD_OK) break;
        check_failure(&f, status, bytes);
        assert_true(cscd_partition_cell_count(partition) == cells && partition->generation == 1);
        check_partition(partition);
    }
    assert_int_equal(partition->generation, 2);
    assert_int_equal(cscd_context_bytes(f.context), bytes);
    assert_true(failures > 15);
    check_partition(partition);
    cscd_partition_destroy(partition);
    fixture_end(&f);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(create_without_memory),
                                       cmocka_unit_test(renew_without_memory)};
    return cmocka_run_group_tests_name("partition memory", tests, NULL, NULL);
}
