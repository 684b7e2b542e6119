/* Patches: at each of their corners objects wind as often as the patch says, on grids where everything degenerates; and
 * what is buried in scenes that one sees through. */
#include "runtime/intersections/intersections.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/intersections/grid_scene.h"
#include "tests/support/test.h"

#include <string.h>

enum { SEEDS = NIGHTLY(80, 400) };

enum { LANES_USED = 3 };

static traced_scene traced; /* large; one test at a time */

/* A scene with its patches. */
typedef struct patched_scene {
    bvh trees;
    patch_finder finder;
    cscd_patches patches;
} patched_scene;

static void find_patches(patched_scene *p) {
    mesh_trees_build(traced.scene.mesh, traced.scene.positions, BOX_AXES, &p->trees);
    expect_ok(patch_finder_create(traced.scene.mesh, LANES_USED, &p->finder));
    expect_ok(patch_finder_run(&p->finder, &traced.scene.surface, &p->trees, traced.joiner.found,
                               traced.joiner.piece_count, &p->patches));
}

static void free_patches(patched_scene *p) {
    patch_finder_free(&p->finder);
    bvh_free(&p->trees);
    traced_scene_free(&traced);
}

static int number_of(const cscd_patches *patches, uint32_t patch, uint32_t object) {
    const cscd_patch *of = &patches->items[patch];
    for (uint32_t i = 0; i < of->winding_count; i++) {
        if (patches->windings[of->first_winding + i].body == object)
            return patches->windings[of->first_winding + i].number;
    }
    return 0;
}

/* ---- grids --------------------------------------------------------------------------------------------- */

static void compare_corner(const patched_scene *p, uint32_t triangle, uint32_t corner) {
    int32_t numbers[GRID_OBJECTS] = {0};
    bool is_touched[GRID_OBJECTS] = {false};
    uint32_t touched[GRID_OBJECTS], patch = p->patches.corner_patches[triangle * 3 + corner];
    winding_tally tally = {numbers, is_touched, touched, 0};
    winding_find(&traced.scene.surface, &p->trees, (corner_side){triangle, (uint8_t)corner, true}, &tally);
    assert_true(patch < p->patches.count);
    assert_int_equal(p->patches.items[patch].component, traced.scene.mesh->triangle_components[triangle]);
    for (uint32_t object = 0; object < traced.scene.object_count; object++)
        assert_int_equal(number_of(&p->patches, patch, object), numbers[object]);
    assert_int_equal(p->patches.items[patch].own, numbers[p->patches.items[patch].object]);
}

/* Counts agree with the lists. */
static void check_counts(const patched_scene *p) {
    uint32_t vertices = 0, triangles = 0, listed_vertices = 0, listed_triangles = 0;
    const cscd_mesh *mesh = traced.scene.mesh;
    for (size_t i = 0; i < p->patches.count; i++) {
        vertices += p->patches.items[i].vertex_count;
        triangles += p->patches.items[i].triangle_count;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        listed_vertices += p->patches.vertex_patches[v] != UINT32_MAX;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        listed_triangles += p->patches.triangle_patches[t] != UINT32_MAX;
    assert_int_equal(vertices, listed_vertices);
    assert_int_equal(triangles, listed_triangles);
}

TEST(corners_have_the_numbers_of_their_patch) {
    size_t cut = 0, buried = 0;
    for (int family = 0; family < GRID_FAMILIES; family++) {
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            patched_scene p;
            traced_scene_make((grid_family)family, seed, &traced);
            find_patches(&p);
            for (uint32_t i = 0; i < traced.scene.mesh->triangle_count * 3; i++)
                compare_corner(&p, i / 3, i % 3);
            check_counts(&p);
            cut += p.patches.count > traced.scene.mesh->component_count;
            buried += p.patches.winding_count;
            free_patches(&p);
        }
    }
    print_message("  %zu scenes are cut, %zu times an object winds around a patch\n", cut, buried);
    assert_true(cut > 2 * SEEDS && buried > 5 * SEEDS);
}
