/* Vertices without a triangle cost one number each, and a count that can only be a mistake costs nothing. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <string.h>

enum { MOST = (1 << 24) + 256 };

static counting_allocator counter;
static cscd_context *context;

static cscd_status create_one_triangle(uint32_t vertex_count, cscd_mesh **out) {
    static const uint32_t one[] = {0, 1, 2};
    cscd_object_desc object = cscd_object_of_triangles(vertex_count, 1, one);
    return cscd_mesh_create(context, &object, 1, out);
}

static int open_context(void **state) {
    (void)state;
    cscd_context_options options = cscd_context_defaults();
    counter = counting_allocator_start();
    options.allocator = counting_allocator_interface(&counter);
    return cscd_context_create(&options, &context) == CSCD_OK ? 0 : -1;
}

static int close_context(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return counter.live == 0 ? 0 : -1;
}

/* The counts of a mistake: one too many, and numbers that were negative. */
TEST(absurd_counts_are_refused) {
    cscd_mesh *none = NULL;
    size_t peak = counter.peak;
    assert_int_equal(create_one_triangle(MOST + 1, &none), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "16777473 vertices are too many for 1 triangle:"));
    assert_int_equal(create_one_triangle((uint32_t)-6, &none), CSCD_INVALID_MESH);
    assert_non_null(strstr(cscd_context_detail(context), "leave out vertices that no triangle has"));
    assert_null(none);
    assert_true(counter.peak < peak + 1000); /* a copy of the description only */
}

TEST(spare_vertices_cost_little) {
    cscd_mesh *mesh = NULL;
    assert_int_equal(create_one_triangle(MOST, &mesh), CSCD_OK);
    assert_true(counter.peak < (size_t)MOST * 4 + 10000);
    cscd_mesh_destroy(mesh);
}

AROUND_ALL(open_context, close_context)
