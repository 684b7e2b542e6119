/* A binary tree over the triangles of a mesh, whose leaves are single triangles: how it is built, oriented and freed. */
#include "benchmarks/lib/volume_tree.h"

#include "runtime/bvh/bvh.h"

#include <math.h>
#include <stdlib.h>

const char *volume_kind_name(volume_kind kind) {
    static const char *const names[VOLUME_KINDS] = {"sphere", "box", "14-DOP", "18-DOP", "26-DOP"};
    return names[kind];
}

/* ---- building ---------------------------------------------------------------------------------------- */

/* Triangles that are still to be put into the tree: their centres, and their regions. */
typedef struct tree_builder {
    volume_tree *tree;
    uint32_t *order;
    double (*centres)[3];
    const uint32_t *regions;
} tree_builder;

static void find_centres(const volume_tree *t, const double *positions, double (*centres)[3]) {
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            centres[i][k] = 0.0;
            for (int j = 0; j < 3; j++)
                centres[i][k] += positions[t->triangles[i][j] * 3 + (uint32_t)k] / 3.0;
        }
    }
}

/* Moves those that are below to the front; returns how many they are. */
static uint32_t part_order(const tree_builder *b, uint32_t begin, uint32_t end, int axis, double middle) {
    uint32_t at = begin;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t triangle = b->order[i];
        double value = axis < 3 ? b->centres[triangle][axis] : (double)b->regions[triangle];
        if (value >= middle) continue;
        b->order[i] = b->order[at];
        b->order[at++] = triangle;
    }
    return at - begin;
}

static void find_range(const tree_builder *b, uint32_t begin, uint32_t end, double least[4],
                       double greatest[4]) {
    for (int k = 0; k < 4; k++) {
        least[k] = INFINITY;
        greatest[k] = -INFINITY;
        for (uint32_t i = begin; i < end; i++) {
            uint32_t triangle = b->order[i];
            double value = k < 3 ? b->centres[triangle][k] : (double)b->regions[triangle];
            least[k] = fmin(least[k], value);
            greatest[k] = fmax(greatest[k], value);
        }
    }
}

/* Returns how many go to the first child: by region as long as there are several, then by the longest axis; where that
 * leaves nothing on one side, half of them. */
static uint32_t split_order(const tree_builder *b, uint32_t begin, uint32_t end) {
    double least[4], greatest[4];
    find_range(b, begin, end, least, greatest);
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        if (greatest[k] - least[k] > greatest[axis] - least[axis]) axis = k;
    }
    if (greatest[3] > least[3]) axis = 3;
    double middle = 0.5 * (least[axis] + greatest[axis]);
    if (axis == 3) middle = ceil(middle + 0.25);
    uint32_t count = part_order(b, begin, end, axis, middle);
    return count > 0 && count < end - begin ? count : (end - begin) / 2;
}

/* Fills in the node of these triangles and all below it. */
static void build_node(const tree_builder *b, uint32_t begin, uint32_t end, uint32_t depth) {
    volume_tree *t = b->tree;
    uint32_t at = t->node_count++;
    if (depth > t->depth) t->depth = depth;
    if (end - begin == 1) {
        uint32_t triangle = b->order[begin];
        t->nodes[at] = (volume_node){0, triangle, b->regions[triangle], 0};
        return;
    }
    uint32_t middle = begin + split_order(b, begin, end);
    build_node(b, begin, middle, depth + 1);
    uint32_t second = t->node_count;
    build_node(b, middle, end, depth + 1);
    bool one = t->nodes[at + 1].region == t->nodes[second].region;
    t->nodes[at] = (volume_node){second, 0, one ? t->nodes[second].region : UINT32_MAX, 0};
}

/* Rows of vectors begin at addresses that are multiples of their size. */
static void *allocate_rows(size_t count, size_t size) {
    size_t bytes = (count * size + 63) / 64 * 64;
    return aligned_alloc(64, bytes > 0 ? bytes : 64);
}

bool volume_tree_build(const cscd_mesh *mesh, const double *positions, const uint32_t *regions,
                       volume_tree *out) {
    uint32_t count = mesh->triangle_count;
    volume_tree t = {.vertex_count = mesh->vertex_count,
                     .triangle_count = count,
                     .triangles = (const uint32_t(*)[3])mesh->triangles};
    t.nodes = calloc(2 * (size_t)count, sizeof *t.nodes);
    t.records = allocate_rows(mesh->vertex_count, sizeof *t.records);
    t.vertex_volumes = allocate_rows(mesh->vertex_count, sizeof(float[VOLUME_FLOATS_MAX]));
    t.volumes = allocate_rows(2 * (size_t)count, sizeof(float[VOLUME_FLOATS_MAX]));
    tree_builder b = {&t, calloc(count, sizeof *b.order), calloc(count, sizeof *b.centres), regions};
    bool good = t.nodes != NULL && t.records != NULL && t.vertex_volumes != NULL && t.volumes != NULL &&
                b.order != NULL && b.centres != NULL;
    if (good) {
        find_centres(&t, positions, b.centres);
        for (uint32_t i = 0; i < count; i++) b.order[i] = i;
        build_node(&b, 0, count, 1);
        volume_tree_orient(&t, NULL);
    }
    free(b.order);
    free(b.centres);
    if (good)
        *out = t;
    else
        volume_tree_free(&t);
    return good;
}

void volume_tree_free(volume_tree *t) {
    free(t->nodes);
    free(t->records);
    free(t->vertex_volumes);
    free(t->volumes);
    *t = (volume_tree){0};
}

void volume_tree_orient(volume_tree *t, const uint8_t *orientations) {
    for (uint32_t i = t->node_count; i-- > 0;) {
        volume_node *n = &t->nodes[i];
        if (n->second == 0)
            n->facing = orientations != NULL ? orientations[n->triangle] : ORIENTATION_ZERO;
        else
            n->facing = t->nodes[i + 1].facing | t->nodes[n->second].facing;
    }
}

/* ---- searches ---------------------------------------------------------------------------------------- */

/* A visit takes one pair from the stack and puts at most four on it, each of which is one level deeper on one side at
 * least. */
bool volume_search_open(const volume_tree *t, volume_search *out) {
    volume_search s = {.capacity = 1024};
    s.pairs = malloc(s.capacity * sizeof *s.pairs);
    s.stack = malloc((8 * (size_t)t->depth + 8) * sizeof *s.stack);
    if (s.pairs == NULL || s.stack == NULL) {
        volume_search_close(&s);
        return false;
    }
    *out = s;
    return true;
}

void volume_search_close(volume_search *s) {
    free(s->pairs);
    free(s->stack);
    *s = (volume_search){0};
}

void volume_search_grow(volume_search *s) {
    uint32_t(*grown)[2] = realloc(s->pairs, 2 * s->capacity * sizeof *grown);
    if (grown == NULL) {
        s->out_of_memory = true;
        s->count = 0; /* what follows is of no use */
        return;
    }
    s->pairs = grown;
    s->capacity *= 2;
}
