/* Binary trees over the triangles of each region: how they are built, flagged and freed. */
#include "runtime/baselines/volume_tree.h"

#include "runtime/bvh/bvh.h"

#include <math.h>

const char *volume_kind_name(volume_kind kind) {
    static const char *const names[VOLUME_KINDS] = {"sphere", "box", "14-DOP", "18-DOP", "26-DOP"};
    return names[kind];
}

/* ---- building ---------------------------------------------------------------------------------------- */

enum { AXES = 7, NO_PARENT = 0xffffffffu };

/* The axes of the 14-DOP, as unit vectors, so that widths along different axes compare. */
#define DIAGONAL 0.57735026918962576
static const double axes[AXES][3] = {{1, 0, 0},
                                     {0, 1, 0},
                                     {0, 0, 1},
                                     {DIAGONAL, DIAGONAL, DIAGONAL},
                                     {DIAGONAL, DIAGONAL, -DIAGONAL},
                                     {DIAGONAL, -DIAGONAL, DIAGONAL},
                                     {-DIAGONAL, DIAGONAL, DIAGONAL}};

/* A node still to be built of triangles in the order. It is the second child of its parent. */
typedef struct waiting_node {
    uint32_t begin, end, parent, depth;
} waiting_node;

typedef struct tree_builder {
    const double *positions;
    volume_tree *tree;
    uint32_t *order; /* triangles, by region */
    uint32_t *region_ends;
    waiting_node *stack;
} tree_builder;

static double along_axis(int axis, const double p[3]) {
    return axes[axis][0] * p[0] + axes[axis][1] * p[1] + axes[axis][2] * p[2];
}

static double centroid_along(const tree_builder *b, uint32_t triangle, int axis) {
    double sum = 0.0;
    for (int i = 0; i < 3; i++)
        sum += along_axis(axis, b->positions + (size_t)b->tree->triangles[triangle][i] * 3) / 3.0;
    return sum;
}

/* The longest axis of the volume around the triangles, and its middle. */
static int longest_axis(const tree_builder *b, uint32_t begin, uint32_t end, double *middle) {
    int longest = 0;
    double most = -1.0;
    for (int axis = 0; axis < AXES; axis++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = begin; i < end; i++) {
            for (int k = 0; k < 3; k++) {
                const uint32_t vertex = b->tree->triangles[b->order[i]][k];
                const double value = along_axis(axis, b->positions + (size_t)vertex * 3);
                low = fmin(low, value);
                high = fmax(high, value);
            }
        }
        if (high - low <= most) continue;
        most = high - low;
        longest = axis;
        *middle = 0.5 * (low + high);
    }
    return longest;
}

/* Moves the triangles whose centroids lie below the middle to the front; returns how many go to the first child. Where none or all
 * do, half of them. */
static uint32_t split_order(const tree_builder *b, uint32_t begin, uint32_t end) {
    double middle = 0.0;
    const int axis = longest_axis(b, begin, end, &middle);
    uint32_t at = begin;
    for (uint32_t i = begin; i < end; i++) {
        const uint32_t triangle = b->order[i];
        if (!(centroid_along(b, triangle, axis) < middle)) continue;
        b->order[i] = b->order[at];
        b->order[at++] = triangle;
    }
    return at > begin && at < end ? at - begin : (end - begin) / 2;
}

/* A tree may be as deep as it has triangles, so what is to be done waits in a stack of our own. */
static void build_region(const tree_builder *b, uint32_t region) {
    volume_tree *t = b->tree;
    uint32_t waiting = 1;
    b->stack[0] =
        (waiting_node){region == 0 ? 0 : b->region_ends[region - 1], b->region_ends[region], NO_PARENT, 1};
    t->roots[region] = t->node_count;
    while (waiting > 0) {
        const waiting_node p = b->stack[--waiting];
        const uint32_t at = t->node_count++;
        if (p.parent != NO_PARENT) t->nodes[p.parent].second = at;
        if (p.depth > t->depth) t->depth = p.depth;
        t->nodes[at] = (volume_node){.triangle = b->order[p.begin], .region = region};
        if (p.end - p.begin == 1) continue;
        const uint32_t middle = p.begin + split_order(b, p.begin, p.end);
        b->stack[waiting++] = (waiting_node){middle, p.end, at, p.depth + 1};
        b->stack[waiting++] = (waiting_node){p.begin, middle, NO_PARENT, p.depth + 1};
    }
}

static void order_by_region(const tree_builder *b, const uint32_t *regions) {
    const volume_tree *t = b->tree;
    for (uint32_t i = 0; i < t->triangle_count; i++) b->region_ends[regions[i]]++;
    for (uint32_t r = 1; r < t->root_count; r++) b->region_ends[r] += b->region_ends[r - 1];
    for (uint32_t i = t->triangle_count; i-- > 0;) b->order[--b->region_ends[regions[i]]] = i;
    for (uint32_t i = 0; i < t->triangle_count; i++) b->region_ends[regions[i]]++;
}

static array_list list_arrays(volume_tree *t) {
    const size_t nodes = 2 * (size_t)t->triangle_count, floats = VOLUME_FLOATS_MAX;
    return (array_list){
        {ARRAY(t->nodes, nodes), ARRAY(t->roots, t->root_count), ARRAY(t->records, t->vertex_count),
         ARRAY(t->vertex_volumes, t->vertex_count * floats), ARRAY(t->volumes, nodes * floats)}};
}

cscd_status volume_tree_build(const cscd_mesh *mesh, const double *positions, const uint32_t *regions,
                              uint32_t region_count, volume_tree *out) {
    cscd_context *context = mesh->context;
    volume_tree t = {.context = context,
                     .vertex_count = mesh->vertex_count,
                     .triangle_count = mesh->triangle_count,
                     .root_count = region_count,
                     .triangles = (const uint32_t(*)[3])mesh->triangles};
    tree_builder b = {.positions = positions, .tree = &t};
    array_list scratch = {{ARRAY(b.order, t.triangle_count), ARRAY(b.region_ends, region_count),
                           ARRAY(b.stack, (size_t)t.triangle_count + 1)}};
    if (!context_allocate_all(context, scratch)) return CSCD_OUT_OF_MEMORY;
    const bool room = context_allocate_all(context, list_arrays(&t));
    if (room) {
        order_by_region(&b, regions);
        for (uint32_t r = 0; r < region_count; r++) build_region(&b, r);
        volume_tree_orient(&t, NULL);
        *out = t;
    }
    context_free_all(context, scratch);
    return room ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

void volume_tree_free(volume_tree *t) {
    if (t->context != NULL) context_free_all(t->context, list_arrays(t));
    *t = (volume_tree){0};
}

void volume_tree_orient(volume_tree *t, const uint8_t *orientations) {
    for (uint32_t i = t->node_count; i-- > 0;) {
        volume_node *n = &t->nodes[i];
        if (n->second == 0)
            n->flags = orientations != NULL ? orientations[n->triangle] : ORIENTATION_ZERO;
        else
            n->flags = t->nodes[i + 1].flags | t->nodes[n->second].flags;
    }
}

/* ---- searches ---------------------------------------------------------------------------------------- */

enum { FIRST_PAIRS = 1024 };

/* A visit takes one pair from the stack and puts at most four on it, each of which is one level deeper on one side at
 * least. */
cscd_status volume_search_open(const volume_tree *t, volume_search *out) {
    volume_search s = {.context = t->context, .capacity = FIRST_PAIRS};
    s.pairs = context_reserve(s.context, s.capacity, sizeof *s.pairs);
    s.stack = context_reserve(s.context, 8 * (size_t)t->depth + 8, sizeof *s.stack);
    if (s.pairs == NULL || s.stack == NULL) {
        volume_search_close(&s);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = s;
    return CSCD_OK;
}

void volume_search_close(volume_search *s) {
    if (s->context == NULL) return;
    context_free(s->context, s->pairs);
    context_free(s->context, s->stack);
    *s = (volume_search){0};
}

void volume_search_grow(volume_search *s) {
    uint32_t(*grown)[2] = context_grow(s->context, s->pairs, s->capacity, 2 * s->capacity, sizeof *grown);
    if (grown == NULL) {
        s->out_of_memory = true;
        s->count = 0; /* what follows is of no use */
        return;
    }
    s->pairs = grown;
    s->capacity *= 2;
}
