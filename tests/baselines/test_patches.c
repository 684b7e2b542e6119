/* The patches of all nodes of trees, compared with a reference that counts and walks: their contours,
 * which edges the parent has too, which patches are disks, and how the loops of these run. */
#include "runtime/baselines/patches.h"
#include "tests/support/bvh/bvh_rig.h"
#include "tests/support/models/bodies.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SCENES_PER_FAMILY = PACED(20, 3), BODY_TRIANGLES = PACED(3000, 600) };

static scene s; /* large; one test at a time */

/* A mesh, its tree of one region, and the patches of one kind of test. */
typedef struct patch_subject {
    cscd_context *context;
    cscd_mesh *mesh;
    uint32_t *regions;
    double *weights;
    bvh bvh;
    patches patches;
} patch_subject;

static patch_subject subject_create(cscd_object_desc desc, const double *positions,
                                    const contour_test *test) {
    patch_subject f = {0};
    assert_int_equal(cscd_context_create(NULL, &f.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(f.context, &desc, 1, &f.mesh), CSCD_OK);
    f.regions = calloc(desc.triangle_count, sizeof *f.regions);
    f.weights = calloc(desc.triangle_count, sizeof *f.weights);
    assert_true(f.regions != NULL && f.weights != NULL);
    bvh_regions regions = {f.regions, f.weights, 1};
    assert_int_equal(bvh_build(f.mesh, regions, positions, BOX_AXES, &f.bvh), CSCD_OK);
    patch_tree tree;
    assert_int_equal(patch_tree_build(&f.bvh, test->leaf_height, &tree), CSCD_OK);
    assert_int_equal(patches_create(f.mesh, &tree, test, &f.patches), CSCD_OK);
    return f;
}

static void subject_destroy(patch_subject *f) {
    patches_free(f->context, &f->patches);
    bvh_free(&f->bvh);
    free(f->weights);
    free(f->regions);
    cscd_mesh_destroy(f->mesh);
    cscd_context_destroy(f->context);
}

/* ---- the reference --------------------------------------------------------------------------------- */

/* The patch of one node: its triangles, how many of them have each edge, and a union-find over its
 * vertices. */
typedef struct reference_patches {
    const cscd_mesh *mesh;
    uint32_t *triangles, triangle_count;
    uint32_t *edge_counts, *roots, *vertex_seen, *outline;
} reference_patches;

static uint32_t root_of(uint32_t *roots, uint32_t v) {
    while (roots[v] != v) v = roots[v] = roots[roots[v]];
    return v;
}

/* The triangles of the leaves below a node, which are those that it says. */
static void collect_reference(const patch_tree *tree, uint32_t node, reference_patches *r) {
    const patch_node *n = &tree->nodes[node];
    const uint32_t before = r->triangle_count;
    if (patch_is_leaf(n)) {
        for (uint32_t i = 0; i < n->count; i++)
            r->triangles[r->triangle_count++] = tree->triangles[n->first + i];
        return;
    }
    collect_reference(tree, node + 1, r);
    collect_reference(tree, n->right, r);
    assert_int_equal(r->triangle_count - before, n->count);
    assert_memory_equal(r->triangles + before, tree->triangles + n->first, n->count * sizeof *r->triangles);
}

/* Counts vertices, edges and faces; returns V - E + F. */
static int64_t euler_characteristic(reference_patches *r) {
    int64_t sum = r->triangle_count;
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t v = r->mesh->triangles[r->triangles[i]][k];
            sum += r->vertex_seen[v]++ == 0;
            sum -= r->edge_counts[r->mesh->triangle_edges[r->triangles[i]][k]]++ == 0;
        }
    }
    return sum;
}

static bool is_connected(reference_patches *r) {
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        const uint32_t *t = r->mesh->triangles[r->triangles[i]];
        for (int k = 0; k < 3; k++) r->roots[t[k]] = t[k];
    }
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        const uint32_t *t = r->mesh->triangles[r->triangles[i]];
        for (int k = 0; k < 2; k++) r->roots[root_of(r->roots, t[k + 1])] = root_of(r->roots, t[k]);
    }
    uint32_t first = root_of(r->roots, r->mesh->triangles[r->triangles[0]][0]);
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        if (root_of(r->roots, r->mesh->triangles[r->triangles[i]][0]) != first) return false;
    }
    return true;
}

/* Walks along edges of one triangle, each at most once. Returns true when one closed walk that visits no
 * vertex twice uses them all. */
static bool is_one_loop(const cscd_mesh *mesh, const uint32_t *edges, uint32_t count) {
    bool *used = calloc(count + 1, sizeof *used);
    assert_non_null(used);
    uint32_t walked = 1, at = mesh->edges[edges[0]][1], start = mesh->edges[edges[0]][0];
    used[0] = true;
    while (at != start) {
        uint32_t next = UINT32_MAX, ways = 0;
        for (uint32_t i = 0; i < count; i++) {
            const uint32_t *v = mesh->edges[edges[i]];
            if (used[i] || (v[0] != at && v[1] != at)) continue;
            ways++;
            next = i;
        }
        if (ways != 1) break;
        used[next] = true;
        walked++;
        at = mesh->edges[edges[next]][0] + mesh->edges[edges[next]][1] - at;
    }
    free(used);
    return at == start && walked == count;
}

static bool is_clean(const cscd_mesh *mesh, uint32_t triangle) {
    cscd_component c = cscd_mesh_component(mesh, cscd_mesh_triangle_component(mesh, triangle));
    return c.non_manifold_edges == 0 && c.non_manifold_vertices == 0 && c.inconsistent_edges == 0;
}

/* ---- comparisons ----------------------------------------------------------------------------------- */

static bool list_contains(const uint32_t *list, size_t count, uint32_t value) {
    for (size_t i = 0; i < count; i++) {
        if (list[i] == value) return true;
    }
    return false;
}

/* Checks that the contour is the edges with an odd number of triangles, first those that the parent has
 * too. */
static void check_contour(const patches *p, const reference_patches *r, uint32_t node, uint32_t parent) {
    const uint32_t *own = p->contour_edges + p->contour_offsets[node], *above = NULL;
    size_t size = p->contour_offsets[node + 1] - p->contour_offsets[node], above_size = 0;
    if (parent != UINT32_MAX) {
        above = p->contour_edges + p->contour_offsets[parent];
        above_size = p->contour_offsets[parent + 1] - p->contour_offsets[parent];
    }
    for (size_t i = 0; i < size; i++) {
        assert_true(r->edge_counts[own[i]] % 2 == 1 && !list_contains(own, i, own[i]));
        assert_true(list_contains(above, above_size, own[i]) == (i < p->inherited[node]));
    }
}

static bool runs_along(const reference_patches *r, uint32_t from, uint32_t to) {
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        const uint32_t *t = r->mesh->triangles[r->triangles[i]];
        for (int k = 0; k < 3; k++) {
            if (t[k] == from && t[(k + 1) % 3] == to)
                return r->edge_counts[r->mesh->triangle_edges[r->triangles[i]][k]] == 1;
        }
    }
    return false;
}

/* Checks that the loop of a disk goes along each edge of one triangle once, as that triangle does. */
static void check_loop(const patches *p, const reference_patches *r, uint32_t node) {
    const uint32_t *loop = p->loops + p->contour_offsets[node];
    const size_t size = p->contour_offsets[node + 1] - p->contour_offsets[node];
    for (size_t i = 0; i < size; i++) {
        assert_true(runs_along(r, loop[i], loop[(i + 1) % size]));
        assert_false(list_contains(loop, i, loop[i]));
    }
}

/* Lists the edges with an odd number of triangles; returns how many there are. */
static uint32_t list_outline(reference_patches *r) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < 3 * r->triangle_count; i++) {
        uint32_t edge = r->mesh->triangle_edges[r->triangles[i / 3]][i % 3];
        if (r->edge_counts[edge] % 2 == 1 && !list_contains(r->outline, count, edge))
            r->outline[count++] = edge;
    }
    return count;
}

typedef struct patch_tally {
    uint32_t nodes, disks;
} patch_tally;

static void check_node(const patch_subject *f, reference_patches *r, uint32_t node, uint32_t parent,
                       patch_tally *sum) {
    const patches *p = &f->patches;
    size_t size = p->contour_offsets[node + 1] - p->contour_offsets[node];
    r->triangle_count = 0;
    collect_reference(&f->patches.tree, node, r);
    int64_t euler = euler_characteristic(r);
    if (p->contour_edges != NULL) check_contour(p, r, node, parent);
    const uint32_t outlined = list_outline(r);
    bool disk = euler == 1 && outlined > 0 && is_clean(f->mesh, r->triangles[0]) && is_connected(r) &&
                is_one_loop(f->mesh, r->outline, outlined);
    assert_true(p->disks[node] == disk);
    assert_int_equal(size, outlined);
    if (p->loops != NULL && p->disks[node]) check_loop(p, r, node);
    for (uint32_t i = 0; i < r->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            r->vertex_seen[f->mesh->triangles[r->triangles[i]][k]] = 0;
            r->edge_counts[f->mesh->triangle_edges[r->triangles[i]][k]] = 0;
        }
    }
    sum->nodes++;
    sum->disks += p->disks[node];
}

static patch_tally check_patches(cscd_object_desc desc, const double *positions, const contour_test *test) {
    patch_tally sum = {0};
    patch_subject f = subject_create(desc, positions, test);
    reference_patches r = {.mesh = f.mesh};
    uint32_t *parents = calloc(f.patches.tree.node_count, sizeof *parents);
    r.triangles = calloc(desc.triangle_count, sizeof *r.triangles);
    r.edge_counts = calloc(f.mesh->edge_count, sizeof *r.edge_counts);
    r.roots = calloc(desc.vertex_count, sizeof *r.roots);
    r.outline = calloc((size_t)desc.triangle_count * 3, sizeof *r.outline);
    r.vertex_seen = calloc(desc.vertex_count, sizeof *r.vertex_seen);
    assert_true(parents != NULL && r.triangles != NULL && r.edge_counts != NULL && r.roots != NULL &&
                r.vertex_seen != NULL && r.outline != NULL);
    parents[0] = UINT32_MAX;
    for (uint32_t i = 0; i < f.patches.tree.node_count; i++) {
        if (!patch_is_leaf(&f.patches.tree.nodes[i]))
            parents[i + 1] = parents[f.patches.tree.nodes[i].right] = i;
        check_node(&f, &r, i, parents[i], &sum);
    }
    free(parents);
    free(r.triangles);
    free(r.edge_counts);
    free(r.roots);
    free(r.outline);
    free(r.vertex_seen);
    subject_destroy(&f);
    return sum;
}

/* Returns what is found with a triangle a leaf. */
static patch_tally check_mesh(cscd_object_desc desc, const double *positions) {
    check_patches(desc, positions, &star_test);
    return check_patches(desc, positions, &sweep_test);
}

TEST(disks_of_scenes) {
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        patch_tally sum = {0};
        for (uint32_t seed = 0; seed < SCENES_PER_FAMILY; seed++) {
            scene_make((scene_family)family, seed + 800, &s);
            patch_tally own =
                check_mesh(cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles), s.x0);
            sum.nodes += own.nodes;
            sum.disks += own.disks;
        }
        print_message("  %-14s %6u nodes, %6u disks\n", scene_family_name((scene_family)family), sum.nodes,
                      sum.disks);
        if (family < SCENE_BOW_TIE) assert_true(sum.disks > sum.nodes / 2);
    }
}

TEST(disks_of_bodies) {
    static const body_kind kinds[] = {BODY_PAWN, BODY_TORUS, BODY_GENUS2, BODY_COIL, BODY_CHAIN, BODY_CUBE};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        body b = body_of(kinds[i], body_nearest_count(kinds[i], BODY_TRIANGLES));
        patch_tally sum =
            check_mesh(cscd_object_of_triangles(b.vertex_count, b.triangle_count, b.triangles), b.positions);
        print_message("  %-14s %6u nodes, %6u disks\n", body_kind_name(kinds[i]), sum.nodes, sum.disks);
        assert_true(sum.disks > sum.nodes / 2 && sum.disks < sum.nodes);
        body_free(&b);
    }
}

/* Positions are random, so trees cut the mesh into patches of any shape: with holes, touching at vertices,
 * or in loose parts. */
static void check_shape(const mesh_shape *given, uint32_t seed) {
    double positions[3 * 400];
    assert_true(given->vertex_count <= 400);
    for (uint32_t i = 0; i < given->vertex_count * 3; i++)
        positions[i] = (double)((i + 1 + seed * 977) * 2654435761u >> 8) * 0x1p-24;
    check_mesh(cscd_object_of_triangles(given->vertex_count, given->triangle_count, given->triangles[0]),
               positions);
}

TEST(patches_of_any_shape) {
    for (uint32_t seed = 0; seed < 10; seed++) {
        for (int kind = 0; kind < 4; kind++) {
            mesh_shape grid = {0};
            shape_add_grid(&grid, 5, 6, kind % 2 == 1, kind / 2 == 1);
            check_shape(&grid, seed);
        }
        mesh_shape strip = {0}, pair = {0};
        shape_add_moebius_strip(&strip, 9);
        check_shape(&strip, seed);
        shape_add_tetrahedron(&pair, 0, 1, 2, 3);
        shape_add_tetrahedron(&pair, 3, 4, 5, 6);
        shape_add_quad(&pair, 7, 8, 9, 10);
        check_shape(&pair, seed);
        mesh_shape fans = {0}; /* three triangles share an edge */
        for (uint32_t i = 2; i < 5; i++) shape_add_triangle(&fans, 0, 1, i);
        check_shape(&fans, seed);
    }
}

/* ---- whole meshes: the root -------------------------------------------------------------------------- */

static bool root_is_disk(const mesh_shape *given) {
    double positions[3 * 400] = {0};
    patch_subject f = subject_create(
        cscd_object_of_triangles(given->vertex_count, given->triangle_count, given->triangles[0]), positions,
        &sweep_test);
    bool disk = f.patches.disks[0];
    subject_destroy(&f);
    return disk;
}

TEST(roots_that_are_disks_and_not) {
    mesh_shape sheet = {0}, ring = {0}, torus = {0}, strip = {0}, bow_tie = {0}, cube = {0}, beside = {0};
    shape_add_grid(&sheet, 4, 5, false, false);
    assert_true(root_is_disk(&sheet));
    shape_add_grid(&ring, 4, 5, false, true);
    assert_false(root_is_disk(&ring));
    shape_add_grid(&torus, 4, 5, true, true);
    assert_false(root_is_disk(&torus));
    torus.triangle_count--; /* one loop, but V - E + F = -1 */
    assert_false(root_is_disk(&torus));
    shape_add_moebius_strip(&strip, 8);
    assert_false(root_is_disk(&strip));
    shape_add_quad(&bow_tie, 0, 1, 2, 3);
    shape_add_quad(&bow_tie, 0, 4, 5, 6);
    assert_false(root_is_disk(&bow_tie));
    shape_add_cube(&cube);
    assert_false(root_is_disk(&cube));
    cube.triangle_count--;
    assert_true(root_is_disk(&cube));
    /* A torus without one triangle and a closed cube beside it have one loop and V - E + F = 1. */
    shape_add_grid(&beside, 4, 5, true, true);
    beside.triangle_count--;
    uint32_t first = beside.triangle_count;
    shape_add_cube(&beside);
    for (uint32_t t = first; t < beside.triangle_count; t++) {
        for (int k = 0; k < 3; k++) beside.triangles[t][k] += 20;
    }
    beside.vertex_count = 28;
    assert_false(root_is_disk(&beside));
}

/* What is hidden of a patch is in the blocks of its own tree. */
TEST(patches_are_hidden_in_their_tree) {
    const double far_away[3] = {9.0, 0.0, 0.0}, origin[3] = {0.0, 0.0, 0.0};
    size_t hidden = 0;
    bvh_rig r;
    patch_tree tree;
    scene_clear(&s);
    scene_add_sphere(&s, origin, 1.0, 12, 16);
    scene_add_sphere(&s, far_away, 1.0, 12, 16);
    assert_true(bvh_rig_create(&s, (bvh_setup){CSCD_SIMD_AUTO, 1, BOX_AXES, 0}, &r));
    bvh *hierarchy = &r.bvh;
    assert_int_equal(hierarchy->tree_count, 2);
    assert_true(bvh_allow_hiding(hierarchy));
    assert_int_equal(patch_tree_build(hierarchy, 0, &tree), CSCD_OK);
    bool *sealed = calloc(tree.node_count, sizeof *sealed);
    assert_non_null(sealed);
    for (uint32_t i = 0; i < tree.node_count; i++) {
        bvh_show_all(hierarchy);
        sealed[i] = true;
        patch_tree_hide(&tree, sealed, hierarchy);
        sealed[i] = false;
        const uint32_t other = 1 - tree.nodes[i].tree;
        for (int level = 0; level < hierarchy->tree_level; level++) {
            const uint32_t first = hierarchy->trees[other].first_blocks[level];
            const uint32_t end =
                other == 0 ? hierarchy->trees[1].first_blocks[level] : hierarchy->levels[level].block_count;
            for (uint32_t b = 0; b < hierarchy->levels[level].block_count; b++) {
                const bool whole = hierarchy->levels[level].self_pairs[b] == UINT64_MAX;
                assert_true(whole || b < first || b >= end);
                hidden += !whole;
            }
        }
    }
    assert_true(hidden > 10);
    free(sealed);
    patch_tree_free(r.context, &tree);
    bvh_rig_destroy(&r);
}
