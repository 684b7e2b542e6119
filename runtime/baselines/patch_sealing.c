/* Finds the patches that cannot touch themselves in an interval: cones from the leaves up, contours from the roots down. */
#include "runtime/baselines/patches.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum { CONES_PER_TASK = 512 };

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

/* Sets the cones of up to eight nodes of one height. Leaves have one triangle each. */
static void set_cones(const sealing *s, const uint32_t *nodes, uint32_t count, bool leaves) {
    const float pi = 3.14159265f, limit = s->published ? pi : normal_cone_limit;
    const normal_cone_kernels *kernels = normal_cone_kernels_of(s->mesh->context);
    const patch_tree *tree = &s->p->tree;
    uint32_t first[LANES], second[LANES];
    normal_cone cones[LANES];
    for (uint32_t i = 0; i < LANES; i++) {
        uint32_t node = nodes[i < count ? i : count - 1];
        first[i] = leaves ? tree->triangles[tree->nodes[node].first] : node + 1;
        second[i] = tree->nodes[node].right;
    }
    if (leaves)
        kernels->of_triangles((const uint32_t(*)[3])s->mesh->triangles, first, s->x0, s->x1, s->published,
                              cones);
    else
        kernels->of_unions(s->p->cones, first, second, limit, cones);
    for (uint32_t i = 0; i < count; i++) s->p->cones[nodes[i]] = cones[i];
}

/* Sets the cone of a leaf of up to eight triangles. */
static void set_leaf_cone(const sealing *s, uint32_t node) {
    const patch_tree *tree = &s->p->tree;
    const patch_node *n = &tree->nodes[node];
    uint32_t which[LANES];
    for (uint32_t i = 0; i < LANES; i++) which[i] = tree->triangles[n->first + (i < n->count ? i : 0)];
    normal_cone_kernels_of(s->mesh->context)
        ->of_eight((const uint32_t(*)[3])s->mesh->triangles, which, s->x0, s->x1, &s->p->cones[node]);
}

static void merge_some_cones(void *data, uint32_t index) {
    const cone_work *work = data;
    const patches *p = work->sealing->p;
    uint32_t begin = p->height_begins[work->height] + index * CONES_PER_TASK;
    uint32_t end = p->height_begins[work->height + 1];
    if (end - begin > CONES_PER_TASK) end = begin + CONES_PER_TASK;
    if (work->height == 0 && p->test->leaf_height > 0) {
        for (uint32_t i = begin; i < end; i++) set_leaf_cone(work->sealing, p->by_height[i]);
        return;
    }
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

static bool passes_test(const sealing *s, uint32_t node, uint32_t worker) {
    const patches *p = s->p;
    size_t first = p->contour_offsets[node];
    const contour_query query = {.mesh = s->mesh,
                                 .edges = p->test->by_loops ? NULL : p->contour_edges + first,
                                 .loop = p->test->by_loops ? p->loops + first : NULL,
                                 .edge_count = (uint32_t)(p->contour_offsets[node + 1] - first),
                                 .x0 = s->x0,
                                 .x1 = s->x1,
                                 .axis = p->cones[node].axis,
                                 .skipped = s->published && p->parent_tested[node] ? p->inherited[node] : 0,
                                 .published = s->published};
    return p->test->passes(&query, (char *)p->scratch + worker * p->longest * p->test->scratch_size);
}

/* Returns true if the children are to be decided, too. */
static bool decide_node(const sealing *s, uint32_t node, uint32_t worker) {
    patches *p = s->p;
    const patch_node *n = &p->tree.nodes[node];
    if (n->count == 1) return false;
    bool tested = p->cones[node].angle < INFINITY && (s->published || p->disks[node]);
    p->tested[node] = tested;
    p->passed[node] = tested && passes_test(s, node, worker);
    if (p->passed[node] || patch_is_leaf(n)) return false;
    p->parent_tested[node + 1] = p->parent_tested[n->right] = tested;
    p->reached[node + 1] = p->reached[n->right] = true;
    return true;
}

static void decide_wave(void *data, uint32_t worker) {
    sealing *s = data;
    patches *p = s->p;
    for (;;) {
        uint32_t at = atomic_fetch_add(&s->next, 1);
        if (at >= s->wave_end) return;
        decide_node(s, p->stack[at], worker);
    }
}

static void decide_small(void *data, uint32_t worker) {
    sealing *s = data;
    patches *p = s->p;
    for (;;) {
        uint32_t at = atomic_fetch_add(&s->next, 1);
        if (at >= p->small_count) return;
        for (uint32_t i = p->small_roots[at]; i < p->small_ends[at]; i++) {
            if (p->reached[i]) decide_node(s, i, worker);
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
    uint32_t workers = parallel_thread_count(threads), begin = 0, end = 0;
    for (uint32_t i = 0; i < p->tree.root_count; i++) {
        p->reached[p->tree.roots[i]] = true;
        append_large(p, p->tree.roots[i], &end);
    }
    while (begin < end) {
        s->wave_end = end;
        atomic_store(&s->next, begin);
        parallel_run(threads, end - begin < workers ? end - begin : workers, decide_wave, s);
        for (uint32_t last = end; begin < last; begin++) {
            uint32_t node = p->stack[begin];
            if (p->passed[node]) continue;
            append_large(p, node + 1, &end);
            append_large(p, p->tree.nodes[node].right, &end);
        }
    }
    atomic_store(&s->next, 0);
    parallel_run(threads, workers, decide_small, s);
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
