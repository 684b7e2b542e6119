/* The regions of the three bodies are as expected with the default procedure. The number of regions hardly
 * depends on that of the triangles, so a few small counts suffice. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

static void check_counts(body_kind kind, uint32_t triangle_count, uint32_t least, uint32_t most,
                         double share) {
    body b = body_of(kind, triangle_count);
    cscd_mesh *mesh = body_mesh(&b, 2);
    cscd_plan *plan;
    double area = 0.0, seen = 0.0;
    assert_int_equal(plan_create_packed(mesh, b.positions, NULL, &plan), CSCD_OK);
    assert_int_equal(cscd_plan_method(plan), CSCD_METHOD_CHARGE);
    uint32_t count = cscd_plan_region_count(plan);
    for (uint32_t r = 0; r < count; r++) {
        cscd_region region = cscd_plan_region(plan, r);
        area += region.area;
        seen += region.area * region.visible_share;
    }
    print_message("  %s, %u triangles: %u regions, %.3f visible\n", body_kind_name(kind), triangle_count,
                  count, seen / area);
    assert_true(count >= least && count <= most);
    assert_true(seen >= share * area);
    cscd_plan_destroy(plan);
    body_mesh_destroy(mesh);
    body_free(&b);
}

TEST(pawn_has_two) {
    const uint32_t counts[] = {1000, 1500, 2000};
    for (int i = 0; i < 3; i++) check_counts(BODY_PAWN, counts[i], 2, 2, 0.99);
}

TEST(dumbbell_has_two) {
    const uint32_t counts[] = {1000, 1200, 1710};
    for (int i = 0; i < 3; i++) check_counts(BODY_DUMBBELL, counts[i], 2, 2, 0.99);
}

TEST(figure_has_its_limbs) {
    const uint32_t counts[] = {1500, 2000};
    for (int i = 0; i < 2; i++) check_counts(BODY_FIGURE, counts[i], 6, 9, 0.98);
}
