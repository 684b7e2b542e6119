/* Which leaves hold triangles whose neighbours share a vertex. */
#include "runtime/near_leaves.h"

enum { NEAR_PER_LEAF = 64 };

/* Marks hold 1 + the leaf that was last there. */
typedef struct finder {
    const forest *forest;
    uint32_t *triangle_marks, *vertex_marks, *leaf_marks;
    near_leaves *out;
    size_t count, capacity;
} finder;

static bool mark(uint32_t *marks, uint32_t i, uint32_t leaf) {
    bool fresh = marks[i] != leaf + 1;
    marks[i] = leaf + 1;
    return fresh;
}

static bool add(finder *f, uint32_t leaf) {
    cscd_context *context = f->forest->mesh->context;
    if (f->count == f->capacity) {
        size_t capacity = f->capacity * 2;
        uint32_t *grown = context_grow(context, f->out->leaves, f->count, capacity, sizeof *f->out->leaves);
        if (grown == NULL) return false;
        f->out->leaves = grown;
        f->capacity = capacity;
    }
    f->out->leaves[f->count++] = leaf;
    return true;
}

/* The leaves of all triangles at a vertex. */
static bool add_star(finder *f, uint32_t vertex, uint32_t leaf) {
    const cscd_mesh *mesh = f->forest->mesh;
    for (uint32_t i = mesh->vertex_star_offsets[vertex]; i < mesh->vertex_star_offsets[vertex + 1]; i++) {
        uint32_t other = f->forest->slots[mesh->vertex_stars[i]] / FOREST_LANES;
        if (mark(f->leaf_marks, other, leaf) && !add(f, other)) return false;
    }
    return true;
}

/* Those of the triangles at the vertices of a triangle that shares one with the leaf. */
static bool add_around(finder *f, uint32_t neighbour, uint32_t leaf) {
    const cscd_mesh *mesh = f->forest->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t vertex = mesh->triangles[neighbour][i];
        if (mark(f->vertex_marks, vertex, leaf) && !add_star(f, vertex, leaf)) return false;
    }
    return true;
}

static bool find_near(finder *f, uint32_t leaf) {
    const cscd_mesh *mesh = f->forest->mesh;
    for (int lane = 0; lane < FOREST_LANES; lane++) {
        uint32_t t = f->forest->leaves[leaf].triangles[lane];
        for (int i = 0; t != UINT32_MAX && i < 3; i++) {
            uint32_t v = mesh->triangles[t][i];
            for (uint32_t s = mesh->vertex_star_offsets[v]; s < mesh->vertex_star_offsets[v + 1]; s++) {
                uint32_t neighbour = mesh->vertex_stars[s];
                if (mark(f->triangle_marks, neighbour, leaf) && !add_around(f, neighbour, leaf)) return false;
            }
        }
    }
    return true;
}

static bool allocate(finder *f) {
    const forest *trees = f->forest;
    cscd_context *context = trees->mesh->context;
    f->capacity = (size_t)trees->leaf_count * 16;
    f->out->offsets = context_allocate(context, (size_t)trees->leaf_count + 1, sizeof *f->out->offsets);
    f->out->leaves = context_allocate(context, f->capacity, sizeof *f->out->leaves);
    f->triangle_marks = context_allocate(context, trees->mesh->triangle_count, sizeof *f->triangle_marks);
    f->vertex_marks = context_allocate(context, trees->mesh->vertex_count, sizeof *f->vertex_marks);
    f->leaf_marks = context_allocate(context, trees->leaf_count, sizeof *f->leaf_marks);
    return f->out->offsets != NULL && f->out->leaves != NULL && f->triangle_marks != NULL &&
           f->vertex_marks != NULL && f->leaf_marks != NULL;
}

cscd_status near_leaves_create(const forest *f, near_leaves *out, bool *too_many) {
    cscd_context *context = f->mesh->context;
    finder work = {.forest = f, .out = out};
    *out = (near_leaves){.offsets = NULL};
    *too_many = false;
    bool good = allocate(&work);
    for (uint32_t leaf = 0; good && !*too_many && leaf < f->leaf_count; leaf++) {
        good = find_near(&work, leaf);
        out->offsets[leaf + 1] = (uint32_t)work.count;
        *too_many = work.count > (size_t)(leaf + 1) * NEAR_PER_LEAF + f->leaf_count;
    }
    context_free(context, work.triangle_marks);
    context_free(context, work.vertex_marks);
    context_free(context, work.leaf_marks);
    if (!good || *too_many) near_leaves_free(context, out);
    return good ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

void near_leaves_free(cscd_context *context, near_leaves *near) {
    context_free(context, near->offsets);
    context_free(context, near->leaves);
    *near = (near_leaves){.offsets = NULL};
}
