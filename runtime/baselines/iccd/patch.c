/* Patches of the tree's nodes: their contours, and which of them are disks. They are made once. */
#include "runtime/baselines/iccd/patch.h"

#include <string.h>

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
