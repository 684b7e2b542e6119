/* Scalars of views that share bytes are found, as by marking every byte. */
#include "src/mesh/positions.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <string.h>

enum { MEMORY_SIZE = 4096, VIEWS = 60000 };

static char memory[MEMORY_SIZE];
static uint8_t owners[MEMORY_SIZE];

static const char *scalar_at(const view_grid *g, uint32_t vertex, uint32_t coordinate) {
    return g->data + vertex * g->stride + coordinate * g->coordinate_stride;
}

/* Marks the bytes of a view. Returns whether one of them was marked before. */
static bool mark_bytes(const view_grid *g) {
    bool twice = false;
    for (uint32_t v = 0; v < g->vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            const char *scalar = scalar_at(g, v, k);
            for (size_t i = 0; i < g->scalar_size; i++) {
                uint8_t *owner = &owners[scalar + i - memory];
                twice |= *owner != 0;
                *owner = 1;
            }
        }
    }
    return twice;
}

static void expect_common_byte(const view_grid *a, const view_grid *b, const view_clash *clash) {
    assert_true(clash->vertices[0] < a->vertex_count && clash->vertices[1] < b->vertex_count);
    assert_true(clash->coordinates[0] < 3 && clash->coordinates[1] < 3);
    const char *p = scalar_at(a, clash->vertices[0], clash->coordinates[0]);
    const char *q = scalar_at(b, clash->vertices[1], clash->coordinates[1]);
    assert_true(p < q + b->scalar_size && q < p + a->scalar_size);
    if (a == b)
        assert_true(clash->vertices[0] != clash->vertices[1] ||
                    clash->coordinates[0] != clash->coordinates[1]);
}

/* Layouts of all kinds: structs, columns, and steps that interlock or do not. */
static view_grid random_grid(size_t stride) {
    view_grid g = {.scalar_size = random_integer(0, 1) ? 4 : 8,
                   .vertex_count = (uint32_t)random_integer(1, 9)};
    size_t few = (size_t)random_integer(1, 40), columns;
    g.stride = stride != 0 ? stride : random_integer(0, 3) == 0 ? g.scalar_size : few;
    columns = g.stride * (size_t)random_integer(1, 10) + (size_t)random_integer(0, 12);
    g.coordinate_stride = random_integer(0, 2) == 0 ? g.scalar_size : random_integer(0, 1) ? few : columns;
    g.data = memory + random_integer(0, 300);
    return g;
}

TEST(one_view) {
    int overlapping = 0;
    random_seed(1);
    for (int i = 0; i < VIEWS; i++) {
        view_grid g = random_grid(0);
        view_clash clash;
        memset(owners, 0, sizeof owners);
        bool expected = mark_bytes(&g);
        assert_int_equal(view_overlaps_itself(&g, &clash), expected);
        if (expected) expect_common_byte(&g, &g, &clash);
        overlapping += expected;
    }
    print_message("  %d of %d views overlap themselves\n", overlapping, VIEWS);
    assert_true(overlapping > VIEWS / 4 && overlapping < VIEWS * 3 / 4);
}

/* Only views that do not overlap themselves are compared, half of them with equal strides. */
TEST(two_views) {
    int overlapping = 0, compared = 0;
    random_seed(2);
    while (compared < VIEWS) {
        view_grid a = random_grid(0), b = random_grid(random_integer(0, 1) ? a.stride : 0);
        view_clash clash;
        memset(owners, 0, sizeof owners);
        if (mark_bytes(&a) || view_overlaps_itself(&b, &clash)) continue;
        bool expected = mark_bytes(&b);
        assert_int_equal(views_overlap(&a, &b, &clash), expected);
        if (expected) expect_common_byte(&a, &b, &clash);
        overlapping += expected;
        compared++;
    }
    print_message("  %d of %d pairs overlap\n", overlapping, compared);
    assert_true(overlapping > VIEWS / 4 && overlapping < VIEWS * 3 / 4);
}

/* Views that hold all the memory that there can be are compared without overflow. */
TEST(large_views) {
    const size_t most = SIZE_MAX / 16 + 1;
    view_grid a = {memory, most / 2, 8, 8, 2}, b = {memory + 24, most / 4, 8, 8, 3};
    view_clash clash;
    assert_false(view_overlaps_itself(&a, &clash));
    assert_false(views_overlap(&a, &b, &clash));
    b.data = memory + 16;
    assert_true(views_overlap(&a, &b, &clash));
    assert_true(clash.vertices[0] == 0 && clash.coordinates[0] == 2 && clash.coordinates[1] == 0);
}
