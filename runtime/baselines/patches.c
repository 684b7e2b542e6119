/* Patches of the nodes of binary trees: the trees, contours, which patches are disks, and the stages of a step that hide the pairs
 * within patches. */
#include "runtime/baselines/patches.h"
#include "runtime/baselines/baselines.h"

#include <string.h>

/* ---- trees, by the order of triangles of the BVH, halved and halved again ------------------------------ */

enum { LEAF_HEIGHT = 3, HEIGHT_PER_LEVEL = 3, DEPTH_MAX = 64 };

/* A node still to be built, which covers the 2^height slots of a tree from `first` on. It is the right child of
 * parent. */
typedef struct pending_node {
    uint32_t first, height, parent;
} pending_node;

static uint32_t triangles_of(const bvh *hierarchy, const bvh_tree *p) {
    uint32_t last = p->first_leaf + p->leaf_count - 1;
    return (p->leaf_count - 1) * LANES + (uint32_t)__builtin_popcount(hierarchy->leaf_flags[last].used);
}

/* Trees follow each other. */
static uint32_t triangles_before(const patch_tree *tree) {
    if (tree->root_count == 0) return 0;
    const patch_node *last = &tree->nodes[tree->roots[tree->root_count - 1]];
    return last->first + last->count;
}

static void add_tree(const bvh *hierarchy, uint32_t index, uint32_t leaf_height, patch_tree *tree) {
    const bvh_tree *p = &hierarchy->trees[index];
    uint32_t count = triangles_of(hierarchy, p), before = triangles_before(tree), depth = 0, height = 0;
    pending_node stack[DEPTH_MAX];
    while ((uint64_t)1 << height < count) height++;
    tree->roots[tree->root_count++] = tree->node_count;
    stack[depth++] = (pending_node){0, height, UINT32_MAX};
    while (depth > 0) {
        pending_node at = stack[--depth];
        while (at.height > 0 && at.first + (1u << (at.height - 1)) >= count) at.height--;
        uint32_t first = before + at.first, node = tree->node_count++;
        uint32_t size = count - at.first < 1u << at.height ? count - at.first : 1u << at.height;
        if (at.parent != UINT32_MAX) tree->nodes[at.parent].right = node;
        tree->nodes[node] = (patch_node){
            .first = first, .count = size, .tree = index, .first_slot = at.first, .height = at.height};
        if (at.height <= leaf_height) {
            const bvh_leaf *l = &hierarchy->leaves[p->first_leaf + at.first / LANES];
            memcpy(tree->triangles + first, l->triangles + at.first % LANES, size * sizeof *l->triangles);
            continue;
        }
        uint32_t half = 1u << (at.height - 1);
        stack[depth++] = (pending_node){at.first + half, at.height - 1, node};
        stack[depth++] = (pending_node){at.first, at.height - 1, UINT32_MAX};
    }
}

cscd_status patch_tree_build(const bvh *hierarchy, uint32_t leaf_height, patch_tree *out) {
    cscd_context *context = hierarchy->mesh->context;
    patch_tree tree = {0};
    size_t leaves = leaf_height == 0 ? hierarchy->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < hierarchy->tree_count && leaf_height > 0; i++)
        leaves += hierarchy->trees[i].leaf_count;
    tree.nodes = context_allocate(context, leaves * 2, sizeof *tree.nodes);
    tree.triangles = context_allocate(context, hierarchy->mesh->triangle_count, sizeof *tree.triangles);
    tree.roots = context_allocate(context, hierarchy->tree_count, sizeof *tree.roots);
    if (tree.nodes == NULL || tree.triangles == NULL || tree.roots == NULL) {
        patch_tree_free(context, &tree);
        return CSCD_OUT_OF_MEMORY;
    }
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) add_tree(hierarchy, i, leaf_height, &tree);
    *out = tree;
    return CSCD_OK;
}

void patch_tree_free(cscd_context *context, patch_tree *tree) {
    context_free(context, tree->nodes);
    context_free(context, tree->triangles);
    context_free(context, tree->roots);
    *tree = (patch_tree){0};
}

/* Rows and columns first to first + count - 1 of an 8 x 8 square of bits. */
static uint64_t bits_of_square(uint32_t first, uint32_t count) {
    uint64_t row = (uint64_t)(((1u << count) - 1) << first), bits = 0;
    for (uint32_t i = first; i < first + count; i++) bits |= row << (8 * i);
    return bits;
}

static void hide_patch(const patch_node *node, bvh *hierarchy) {
    if (node->height <= LEAF_HEIGHT) {
        uint32_t index = hierarchy->trees[node->tree].first_leaf + node->first_slot / LANES;
        hierarchy->leaf_self_pairs[index] &= ~bits_of_square(node->first_slot % LANES, 1u << node->height);
        return;
    }
    int level = (int)(node->height - LEAF_HEIGHT - 1) / HEIGHT_PER_LEVEL;
    uint32_t unit_height = LEAF_HEIGHT + HEIGHT_PER_LEVEL * (uint32_t)level;
    uint32_t child = node->first_slot >> unit_height, count = 1u << (node->height - unit_height);
    uint32_t block = hierarchy->trees[node->tree].first_blocks[level] + child / LANES;
    hierarchy->levels[level].self_pairs[block] &= ~bits_of_square(child % LANES, count);
}

void patch_tree_hide(const patch_tree *tree, const bool *sealed, bvh *hierarchy) {
    for (uint32_t i = 0; i < tree->node_count; i++) {
        if (sealed[i]) hide_patch(&tree->nodes[i], hierarchy);
    }
}

/* ---- contours ---------------------------------------------------------------------------------------------- */

/* Lists of edge numbers, one per node, while they are made: the last node's first. */
typedef struct contour_lists {
    cscd_context *context;
    uint32_t *edges;
    size_t count, capacity;
    size_t *begins; /* per node */
    uint32_t *sizes;
} contour_lists;

static bool reserve_edges(contour_lists *l, size_t more) {
    if (l->count + more <= l->capacity) return true;
    size_t capacity = 2 * (l->count + more);
    uint32_t *grown = context_grow(l->context, l->edges, l->count, capacity, sizeof *grown);
    if (grown == NULL) return false;
    l->edges = grown;
    l->capacity = capacity;
    return true;
}

/* Sorts the edges of a few triangles, and leaves out those that two of them have. */
static uint32_t contour_of_leaf(const cscd_mesh *mesh, const uint32_t *triangles, uint32_t count,
                                uint32_t *out) {
    uint32_t size = 0;
    for (uint32_t i = 0; i < 3 * count; i++) {
        uint32_t edge = mesh->triangle_edges[triangles[i / 3]][i % 3], at = size;
        while (at > 0 && out[at - 1] > edge) at--;
        if (at > 0 && out[at - 1] == edge) {
            memmove(out + at - 1, out + at, (size - at) * sizeof *out);
            size--;
            continue;
        }
        memmove(out + at + 1, out + at, (size - at) * sizeof *out);
        out[at] = edge;
        size++;
    }
    return size;
}

/* Merges two ascending lists and leaves out what is in both. So the contours of two patches become the contour of the
 * patches together. */
static uint32_t difference_of(const uint32_t *a, uint32_t a_count, const uint32_t *b, uint32_t b_count,
                              uint32_t *out) {
    uint32_t i = 0, j = 0, count = 0;
    while (i < a_count || j < b_count) {
        if (j == b_count || (i < a_count && a[i] < b[j]))
            out[count++] = a[i++];
        else if (i == a_count || b[j] < a[i])
            out[count++] = b[j++];
        else {
            i++;
            j++;
        }
    }
    return count;
}

static bool list_contour(contour_lists *l, const cscd_mesh *mesh, const patch_tree *tree, uint32_t node) {
    const patch_node *n = &tree->nodes[node];
    if (patch_is_leaf(n)) {
        if (!reserve_edges(l, (size_t)n->count * 3)) return false;
        l->sizes[node] = contour_of_leaf(mesh, tree->triangles + n->first, n->count, l->edges + l->count);
    } else {
        uint32_t left = node + 1, right = n->right;
        if (!reserve_edges(l, (size_t)l->sizes[left] + l->sizes[right])) return false;
        l->sizes[node] = difference_of(l->edges + l->begins[left], l->sizes[left],
                                       l->edges + l->begins[right], l->sizes[right], l->edges + l->count);
    }
    l->begins[node] = l->count;
    l->count += l->sizes[node];
    return true;
}

/* Per vertex: the patch that it was last seen in, and its neighbours on that patch's contour. */
typedef struct vertex_visit {
    uint32_t seen, degree, neighbours[2];
} vertex_visit;

/* Is a patch of one oriented manifold component a disk? It is if one loop runs through all edges of its contour and
 * its Euler characteristic is that of a disk. */
static bool is_disk(const cscd_mesh *mesh, const uint32_t *contour, uint32_t size, const uint32_t *patch,
                    uint32_t triangles, vertex_visit *visits, uint32_t stamp) {
    uint32_t vertices = 0;
    for (uint32_t t = 0; t < triangles; t++) {
        if (mesh->triangle_components[patch[t]] != mesh->triangle_components[patch[0]]) return false;
        for (int i = 0; i < 3; i++) {
            vertex_visit *v = &visits[mesh->triangles[patch[t]][i]];
            if (v->seen == stamp) continue;
            *v = (vertex_visit){.seen = stamp};
            vertices++;
        }
    }
    /* V - E + F = 1, where 2 E = 3 F + the contour's edges */
    if (size == 0 || 2 * ((int64_t)vertices + triangles - 1) != 3 * (int64_t)triangles + size) return false;
    for (uint32_t i = 0; i < size; i++) {
        const uint32_t *v = mesh->edges[contour[i]];
        for (int k = 0; k < 2; k++) {
            vertex_visit *visit = &visits[v[k]];
            if (visit->degree == 2) return false;
            visit->neighbours[visit->degree++] = v[1 - k];
        }
    }
    uint32_t start = mesh->edges[contour[0]][0], before = start, at = mesh->edges[contour[0]][1], length = 1;
    for (; at != start; length++) {
        const vertex_visit *visit = &visits[at];
        if (visit->degree != 2) return false;
        uint32_t next = visit->neighbours[0] == before ? visit->neighbours[1] : visit->neighbours[0];
        before = at;
        at = next;
    }
    return length == size;
}

/* Writes the vertices of a disk's loop in order: the patch is on their left, seen from where its triangles are
 * counter-clockwise. visits: as is_disk has left them. */
static void write_loop(const cscd_mesh *mesh, uint32_t edge, uint32_t size, const uint32_t *patch,
                       uint32_t triangles, const vertex_visit *visits, uint32_t *out) {
    uint32_t before = 0, at = 0;
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        uint32_t t = patch[i / 3], k = i % 3;
        if (mesh->triangle_edges[t][k] != edge) continue;
        before = mesh->triangles[t][k];
        at = mesh->triangles[t][(k + 1) % 3];
    }
    for (uint32_t i = 0; i < size; i++) {
        const uint32_t *neighbours = visits[at].neighbours;
        uint32_t next = neighbours[0] == before ? neighbours[1] : neighbours[0];
        out[i] = before;
        before = at;
        at = next;
    }
}

/* Only patches of oriented manifolds are disks. Within one component a patch of one loop has no closed part
 * beside it. */
static void find_disks(patches *p, const cscd_mesh *mesh, const patch_tree *tree, const contour_lists *l,
                       vertex_visit *visits) {
    for (uint32_t i = p->tree.node_count; i-- > 0;) {
        const patch_node *n = &tree->nodes[i];
        const uint32_t *patch = tree->triangles + n->first, *contour = l->edges + l->begins[i];
        const cscd_component *c = &mesh->components[mesh->triangle_components[patch[0]]];
        bool oriented =
            c->non_manifold_edges == 0 && c->non_manifold_vertices == 0 && c->inconsistent_edges == 0;
        p->disks[i] =
            oriented && is_disk(mesh, contour, l->sizes[i], patch, n->count, visits, p->tree.node_count - i);
        if (p->disks[i] && p->loops != NULL)
            write_loop(mesh, contour[0], l->sizes[i], patch, n->count, visits,
                       p->loops + p->contour_offsets[i]);
    }
}

/* Writes a contour to its place: first the edges that it shares with the parent's contour, then the others. */
static void place_contour(patches *p, const contour_lists *l, uint32_t node, uint32_t parent) {
    const uint32_t *own = l->edges + l->begins[node];
    const uint32_t *above = parent == UINT32_MAX ? own : l->edges + l->begins[parent];
    uint32_t own_size = l->sizes[node], above_size = parent == UINT32_MAX ? 0 : l->sizes[parent];
    uint32_t *out = p->contour_edges + p->contour_offsets[node], count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0, j = 0; i < own_size; i++) {
            while (j < above_size && above[j] < own[i]) j++;
            bool common = j < above_size && above[j] == own[i];
            if (common == (pass == 0)) out[count++] = own[i];
        }
        if (pass == 0) p->inherited[node] = count;
    }
}

static void place_contours(patches *p, const contour_lists *l) {
    const patch_tree *tree = &p->tree;
    for (uint32_t i = 0; i < tree->root_count; i++) place_contour(p, l, tree->roots[i], UINT32_MAX);
    for (uint32_t i = 0; i < tree->node_count; i++) {
        if (patch_is_leaf(&tree->nodes[i])) continue;
        place_contour(p, l, i + 1, i);
        place_contour(p, l, tree->nodes[i].right, i);
    }
}

/* Lists the largest subtrees that one thread works on at a time. */
static void find_small(patches *p) {
    uint32_t *ends = p->stack; /* one past the last node of each subtree */
    for (uint32_t i = p->tree.node_count; i-- > 0;) {
        const patch_node *n = &p->tree.nodes[i];
        ends[i] = patch_is_leaf(n) ? i + 1 : ends[n->right];
    }
    for (uint32_t i = 0; i < p->tree.node_count;) {
        if (p->tree.nodes[i].height > SMALL_HEIGHT) {
            i++;
            continue;
        }
        p->small_roots[p->small_count] = i;
        p->small_ends[p->small_count++] = ends[i];
        i = ends[i];
    }
}

/* Leaves count as the lowest, whatever their height. */
static uint32_t rank_of(const patch_node *n) {
    return patch_is_leaf(n) ? 0 : n->height;
}

static void sort_by_height(patches *p) {
    const patch_tree *tree = &p->tree;
    uint32_t *begins = p->height_begins;
    for (uint32_t i = 0; i < tree->node_count; i++) begins[rank_of(&tree->nodes[i]) + 1]++;
    for (uint32_t h = 0; h < p->height_count; h++) begins[h + 1] += begins[h];
    for (uint32_t i = tree->node_count; i-- > 0;) p->by_height[--begins[rank_of(&tree->nodes[i]) + 1]] = i;
    memmove(begins, begins + 1, p->height_count * sizeof *begins);
    begins[p->height_count] = tree->node_count;
}

static bool fill_patches(patches *p, const cscd_mesh *mesh, const patch_tree *tree, contour_lists *l,
                         vertex_visit *visits) {
    uint32_t longest = 0;
    size_t total = 0;
    for (uint32_t i = p->tree.node_count; i-- > 0;) {
        if (!list_contour(l, mesh, tree, i)) return false;
        if (l->sizes[i] > longest) longest = l->sizes[i];
    }
    uint32_t *contours = context_allocate(l->context, l->count + 1, sizeof *contours);
    *(p->test->by_loops ? &p->loops : &p->contour_edges) = contours;
    p->longest = (size_t)longest + 1;
    size_t lanes = parallel_thread_count(l->context->threads);
    p->scratch = context_allocate(l->context, lanes * p->longest, p->test->scratch_size);
    if (contours == NULL || p->scratch == NULL) return false;
    for (uint32_t i = 0; i < p->tree.node_count; i++) {
        p->contour_offsets[i] = total;
        total += l->sizes[i];
    }
    p->contour_offsets[p->tree.node_count] = total;
    if (p->contour_edges != NULL) place_contours(p, l);
    find_disks(p, mesh, tree, l, visits);
    find_small(p);
    sort_by_height(p);
    return true;
}

static array_list list_arrays(patches *p) {
    size_t count = p->tree.node_count;
    return (array_list){{ARRAY(p->contour_offsets, count + 1), ARRAY(p->inherited, count),
                         ARRAY(p->disks, count), ARRAY(p->cones, count), ARRAY(p->by_height, count),
                         ARRAY(p->height_begins, (size_t)p->height_count + 2), ARRAY(p->stack, count),
                         ARRAY(p->parent_tested, count), ARRAY(p->passed, count), ARRAY(p->tested, count),
                         ARRAY(p->reached, count), ARRAY(p->small_roots, count),
                         ARRAY(p->small_ends, count)}};
}

static array_list list_scratch(contour_lists *l, size_t node_count) {
    return (array_list){{ARRAY(l->begins, node_count), ARRAY(l->sizes, node_count)}};
}

cscd_status patches_create(const cscd_mesh *mesh, const patch_tree *tree, const contour_test *test,
                           patches *out) {
    cscd_context *context = mesh->context;
    patches p = {.tree = *tree, .test = test};
    for (uint32_t i = 0; i < tree->node_count; i++)
        if (tree->nodes[i].height >= p.height_count) p.height_count = tree->nodes[i].height + 1;
    contour_lists lists = {.context = context};
    vertex_visit *visits = context_allocate(context, mesh->vertex_count, sizeof *visits);
    bool made = visits != NULL && context_allocate_all(context, list_arrays(&p)) &&
                context_allocate_all(context, list_scratch(&lists, p.tree.node_count)) &&
                fill_patches(&p, mesh, &p.tree, &lists, visits);
    context_free(context, visits);
    context_free_all(context, list_scratch(&lists, 0));
    context_free(context, lists.edges);
    if (!made) {
        patches_free(context, &p);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = p;
    return CSCD_OK;
}

void patches_free(cscd_context *context, patches *p) {
    context_free_all(context, list_arrays(p));
    context_free(context, p->contour_edges);
    context_free(context, p->loops);
    context_free(context, p->scratch);
    patch_tree_free(context, &p->tree);
    *p = (patches){0};
}

/* ---- stages of a step -------------------------------------------------------------------------------------- */

static void *create_patches(cscd_context *context) {
    return context_allocate(context, 1, sizeof(patches));
}

static void destroy_patches(cscd_context *context, void *state) {
    patches_free(context, state);
    context_free(context, state);
}

/* Patches belong to one BVH. When decayed trees have been replaced by another BVH, that one has no room for hidden
 * pairs yet. */
static cscd_status follow_bvh(patches *p, bvh *hierarchy, const contour_test *test) {
    patch_tree tree;
    if (p->tree.node_count > 0 && bvh_can_hide(hierarchy)) return CSCD_OK;
    patches_free(hierarchy->mesh->context, p);
    if (!bvh_allow_hiding(hierarchy)) return CSCD_OUT_OF_MEMORY;
    const cscd_status status = patch_tree_build(hierarchy, test->leaf_height, &tree);
    return status == CSCD_OK ? patches_create(hierarchy->mesh, &tree, test, p) : status;
}

static cscd_status hide_patches(patches *p, const contour_test *test, bvh *hierarchy, const double *x0,
                                const double *x1, cscd_counters *counters) {
    cscd_status status = follow_bvh(p, hierarchy, test);
    if (status != CSCD_OK) return status;
    patches_seal(p, hierarchy->mesh, x0, x1, false);
    patch_tree_hide(&p->tree, p->passed, hierarchy);
    counters->contours = p->contours;
    counters->sealed = p->sealed;
    return CSCD_OK;
}

static cscd_status hide_by_sweeps(void *state, bvh *hierarchy, const double *x0, const double *x1,
                                  cscd_counters *counters) {
    return hide_patches(state, &sweep_test, hierarchy, x0, x1, counters);
}

static cscd_status hide_by_stars(void *state, bvh *hierarchy, const double *x0, const double *x1,
                                 cscd_counters *counters) {
    return hide_patches(state, &star_test, hierarchy, x0, x1, counters);
}

const pair_hider iccd_hider = {create_patches, destroy_patches, hide_by_sweeps};
const pair_hider cones_hider = {create_patches, destroy_patches, hide_by_stars};
