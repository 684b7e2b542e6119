/* Patches of the tree's nodes: makes their contours once, and tests cones and contours in every interval. */
#include "runtime/baselines/iccd/patch.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* One thread tests a whole subtree of at most 2^SMALL_HEIGHT triangles; nodes above are tested level
 * by level. */
enum { SMALL_HEIGHT = 6, CONES_PER_TASK = 512 };

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

static void sort_three(uint32_t e[3]) {
    for (int i = 0; i < 3; i++) {
        int a = i == 1 ? 1 : 0, b = a + 1;
        uint32_t low = e[a] < e[b] ? e[a] : e[b], high = e[a] < e[b] ? e[b] : e[a];
        e[a] = low;
        e[b] = high;
    }
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
        if (!reserve_edges(l, 3)) return false;
        memcpy(l->edges + l->count, mesh->triangle_edges[n->triangle], 3 * sizeof(uint32_t));
        sort_three(l->edges + l->count);
        l->sizes[node] = 3;
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
 * its Euler characteristic is that of a disk. Leaves are the patch's triangles. */
static bool is_disk(const cscd_mesh *mesh, const uint32_t *contour, uint32_t size, const patch_node *first,
                    const patch_node *end, vertex_visit *visits, uint32_t stamp) {
    uint32_t vertices = 0, triangles = 0, component = UINT32_MAX;
    for (const patch_node *n = first; n < end; n++) {
        if (!patch_is_leaf(n)) continue;
        if (triangles++ == 0) component = mesh->triangle_components[n->triangle];
        if (mesh->triangle_components[n->triangle] != component) return false;
        for (int i = 0; i < 3; i++) {
            vertex_visit *v = &visits[mesh->triangles[n->triangle][i]];
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

/* Only patches of oriented manifolds are disks. Within one component a patch of one loop has no closed part
 * beside it. */
static void find_disks(patches *p, const cscd_mesh *mesh, const patch_tree *tree, const contour_lists *l,
                       vertex_visit *visits) {
    uint32_t *ends = p->stack; /* one past the last node of each subtree */
    for (uint32_t i = p->tree.node_count; i-- > 0;) {
        const patch_node *n = &tree->nodes[i];
        ends[i] = patch_is_leaf(n) ? i + 1 : ends[n->right];
        const patch_node *leaf = n;
        while (!patch_is_leaf(leaf)) leaf++;
        const cscd_component *c = &mesh->components[mesh->triangle_components[leaf->triangle]];
        bool oriented =
            c->non_manifold_edges == 0 && c->non_manifold_vertices == 0 && c->inconsistent_edges == 0;
        p->disks[i] = oriented && is_disk(mesh, l->edges + l->begins[i], l->sizes[i], n,
                                          tree->nodes + ends[i], visits, p->tree.node_count - i);
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

/* Lists the largest subtrees that one thread works on at a time. */
static void find_small(patches *p, const uint32_t *ends) {
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

static void sort_by_height(patches *p) {
    const patch_tree *tree = &p->tree;
    uint32_t *begins = p->height_begins;
    for (uint32_t i = 0; i < tree->node_count; i++) begins[tree->nodes[i].height + 1]++;
    for (uint32_t h = 0; h < p->height_count; h++) begins[h + 1] += begins[h];
    for (uint32_t i = tree->node_count; i-- > 0;) p->by_height[--begins[tree->nodes[i].height + 1]] = i;
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
    p->contour_edges = context_allocate(l->context, l->count + 1, sizeof *p->contour_edges);
    p->longest = (size_t)longest + 1;
    size_t lanes = parallel_thread_count(l->context->threads);
    p->scratch = context_allocate(l->context, lanes * p->longest, sizeof *p->scratch);
    p->keys = context_allocate(l->context, lanes * p->longest, sizeof *p->keys);
    if (p->contour_edges == NULL || p->scratch == NULL || p->keys == NULL) return false;
    for (uint32_t i = 0; i < p->tree.node_count; i++) {
        p->contour_offsets[i] = total;
        total += l->sizes[i];
    }
    p->contour_offsets[p->tree.node_count] = total;
    for (uint32_t i = 0; i < tree->root_count; i++) place_contour(p, l, tree->roots[i], UINT32_MAX);
    for (uint32_t i = 0; i < p->tree.node_count; i++) {
        if (patch_is_leaf(&tree->nodes[i])) continue;
        place_contour(p, l, i + 1, i);
        place_contour(p, l, tree->nodes[i].right, i);
    }
    find_disks(p, mesh, tree, l, visits);
    find_small(p, p->stack);
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

cscd_status patches_create(const cscd_mesh *mesh, const patch_tree *tree, patches *out) {
    cscd_context *context = mesh->context;
    patches p = {.tree = *tree};
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
    context_free(context, p->scratch);
    context_free(context, p->keys);
    patch_tree_free(context, &p->tree);
    *p = (patches){0};
}

/* ---- one interval ---------------------------------------------------------------------------------- */

/* Nodes are decided from the roots down, each by itself once its parent has not passed. So threads take the large
 * nodes wave by wave, each wave the children of the one before, and then the small subtrees, in any order. */
typedef struct sealing {
    patches *p;
    const cscd_mesh *mesh;
    const double *x0, *x1;
    bool published;
    uint32_t wave_end; /* in p->stack */
    atomic_uint next;
} sealing;

/* Nodes of one height do not depend on each other. */
typedef struct cone_work {
    const sealing *sealing;
    uint32_t height;
} cone_work;

/* Sets the cones of up to eight nodes of one height. */
static void set_cones(const sealing *s, const uint32_t *nodes, uint32_t count, bool leaves) {
    const float pi = 3.14159265f, limit = s->published ? pi : normal_cone_limit;
    const normal_cone_kernels *kernels = normal_cone_kernels_of(s->mesh->context);
    const patch_node *all = s->p->tree.nodes;
    uint32_t first[LANES], second[LANES];
    normal_cone cones[LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        uint32_t node = nodes[i < count ? i : count - 1];
        first[i] = leaves ? all[node].triangle : node + 1;
        second[i] = all[node].right;
    }
    if (leaves)
        kernels->of_triangles((const uint32_t(*)[3])s->mesh->triangles, first, s->x0, s->x1, s->published,
                              cones);
    else
        kernels->of_unions(s->p->cones, first, second, limit, cones);
    for (uint32_t i = 0; i < count; i++) s->p->cones[nodes[i]] = cones[i];
}

static void merge_some_cones(void *data, uint32_t index) {
    const cone_work *work = data;
    const patches *p = work->sealing->p;
    uint32_t begin = p->height_begins[work->height] + index * CONES_PER_TASK;
    uint32_t end = p->height_begins[work->height + 1];
    if (end - begin > CONES_PER_TASK) end = begin + CONES_PER_TASK;
    for (uint32_t i = begin; i < end; i += LANES)
        set_cones(work->sealing, p->by_height + i, end - i < LANES ? end - i : LANES, work->height == 0);
}

static void merge_cones(const sealing *s) {
    for (uint32_t h = 0; h < s->p->height_count; h++) {
        cone_work work = {s, h};
        uint32_t count = s->p->height_begins[h + 1] - s->p->height_begins[h];
        parallel_run(s->mesh->context->threads, (count + CONES_PER_TASK - 1) / CONES_PER_TASK,
                     merge_some_cones, &work);
    }
}

static bool passes_test(const sealing *s, uint32_t node, uint32_t lane) {
    const patches *p = s->p;
    size_t first = p->contour_offsets[node];
    const contour_query query = {.mesh = s->mesh,
                                 .edges = p->contour_edges + first,
                                 .edge_count = (uint32_t)(p->contour_offsets[node + 1] - first),
                                 .x0 = s->x0,
                                 .x1 = s->x1,
                                 .axis = p->cones[node].axis,
                                 .skipped = s->published && p->parent_tested[node] ? p->inherited[node] : 0,
                                 .published = s->published};
    return contour_stays_simple(&query, p->scratch + lane * p->longest, p->keys + lane * p->longest);
}

/* Returns true if the children are to be decided, too. */
static bool decide_node(const sealing *s, uint32_t node, uint32_t lane) {
    patches *p = s->p;
    const patch_node *n = &p->tree.nodes[node];
    if (patch_is_leaf(n)) return false;
    bool tested = p->cones[node].angle < INFINITY && (s->published || p->disks[node]);
    p->tested[node] = tested;
    p->passed[node] = tested && passes_test(s, node, lane);
    if (p->passed[node]) return false;
    p->parent_tested[node + 1] = p->parent_tested[n->right] = tested;
    p->reached[node + 1] = p->reached[n->right] = true;
    return true;
}

static void decide_wave(void *data, uint32_t lane) {
    sealing *s = data;
    patches *p = s->p;
    for (;;) {
        uint32_t at = atomic_fetch_add(&s->next, 1);
        if (at >= s->wave_end) return;
        decide_node(s, p->stack[at], lane);
    }
}

static void decide_small(void *data, uint32_t lane) {
    sealing *s = data;
    patches *p = s->p;
    for (;;) {
        uint32_t at = atomic_fetch_add(&s->next, 1);
        if (at >= p->small_count) return;
        for (uint32_t i = p->small_roots[at]; i < p->small_ends[at]; i++) {
            if (p->reached[i]) decide_node(s, i, lane);
        }
    }
}

/* In the stack, the large nodes of a wave follow those of the wave before. */
static void append_large(patches *p, uint32_t node, uint32_t *end) {
    if (p->tree.nodes[node].height > SMALL_HEIGHT) p->stack[(*end)++] = node;
}

static void decide_all(sealing *s) {
    patches *p = s->p;
    parallel *threads = s->mesh->context->threads;
    uint32_t lanes = parallel_thread_count(threads), begin = 0, end = 0;
    for (uint32_t i = 0; i < p->tree.root_count; i++) {
        p->reached[p->tree.roots[i]] = true;
        append_large(p, p->tree.roots[i], &end);
    }
    while (begin < end) {
        s->wave_end = end;
        atomic_store(&s->next, begin);
        parallel_run(threads, end - begin < lanes ? end - begin : lanes, decide_wave, s);
        for (uint32_t last = end; begin < last; begin++) {
            uint32_t node = p->stack[begin];
            if (p->passed[node]) continue;
            append_large(p, node + 1, &end);
            append_large(p, p->tree.nodes[node].right, &end);
        }
    }
    atomic_store(&s->next, 0);
    parallel_run(threads, lanes, decide_small, s);
}

void patches_seal(patches *p, const cscd_mesh *mesh, const double *x0, const double *x1, bool published) {
    sealing s = {.p = p, .mesh = mesh, .x0 = x0, .x1 = x1, .published = published};
    size_t size = p->tree.node_count * sizeof *p->passed;
    merge_cones(&s);
    memset(p->parent_tested, 0, size);
    memset(p->passed, 0, size);
    memset(p->tested, 0, size);
    memset(p->reached, 0, size);
    decide_all(&s);
    p->contours = p->sealed = 0;
    for (uint32_t i = 0; i < p->tree.node_count; i++) {
        p->contours += p->tested[i];
        p->sealed += p->passed[i];
    }
}
