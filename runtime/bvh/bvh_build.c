/* Builds the trees: the order of triangles, leaves, blocks and records. */
#include "runtime/bvh/bvh.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { CHUNK_RECORDS = 1024 };

/* Items to be ordered so that neighbours are near each other: the triangles of a region, or regions. */
typedef struct ordering {
    uint32_t *items;
    float (*centres)[3]; /* indexed by what items holds */
} ordering;

typedef struct builder {
    cscd_context *context;
    const cscd_mesh *mesh;
    bvh_regions given;
    ordering triangles, regions;
    uint32_t *region_offsets; /* the triangles of region r: items[offsets[r] .. offsets[r + 1]) */
    uint32_t *record_of;      /* per vertex: its last record; in an earlier tree if below the tree's first */
} builder;

/* ---- order --------------------------------------------------------------------------------------------- */

static int longest_axis(const ordering *o, uint32_t begin, uint32_t end) {
    float longest_extent = -1.0f;
    int longest = 0;
    for (int k = 0; k < 3; k++) {
        float low = INFINITY, high = -INFINITY;
        for (uint32_t i = begin; i < end; i++) {
            float value = o->centres[o->items[i]][k];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        if (high - low > longest_extent) {
            longest_extent = high - low;
            longest = k;
        }
    }
    return longest;
}

static bool comes_before(const ordering *o, int axis, uint32_t a, uint32_t b) {
    float x = o->centres[a][axis], y = o->centres[b][axis];
    return x != y ? x < y : a < b;
}

static void swap_items(uint32_t *items, uint32_t i, uint32_t j) {
    uint32_t item = items[i];
    items[i] = items[j];
    items[j] = item;
}

/* Hoare's selection: moves the items of the least coordinates before position nth. */
static void select_nth(const ordering *o, int axis, uint32_t begin, uint32_t end, uint32_t nth) {
    uint32_t *items = o->items;
    while (end - begin > 1) {
        uint32_t pivot = items[begin + (end - begin) / 2], i = begin, j = end - 1;
        for (;;) {
            while (comes_before(o, axis, items[i], pivot)) i++;
            while (comes_before(o, axis, pivot, items[j])) j--;
            if (i >= j) break;
            swap_items(items, i++, j--);
        }
        /* If i and j end on the same item, this is the pivot and already in its place. */
        if (i == j && nth == i) return;
        if (nth < i)
            end = i;
        else
            begin = j + 1;
    }
}

/* Returns the number of items in the first half of a run: the largest power of two below count. So runs of 8^k items
 * begin at multiples of 8^k, and all runs at multiples of their size. */
static uint32_t first_share(uint32_t count) {
    uint32_t share = 1;
    while (share < count - share) share *= 2;
    return share;
}

/* Splits at the middle of the longest extent, then each side, down to single items. */
static void order_run(const ordering *o, uint32_t begin, uint32_t end) {
    uint32_t begins[64], ends[64], depth = 0;
    begins[depth] = begin;
    ends[depth++] = end;
    while (depth > 0) {
        depth--;
        uint32_t from = begins[depth], to = ends[depth];
        if (to - from < 2) continue;
        uint32_t middle = from + first_share(to - from);
        select_nth(o, longest_axis(o, from, to), from, to, middle);
        /* The longer side is pushed first, so the stack holds at most one side per halving. */
        bool first_longer = middle - from > to - middle;
        begins[depth] = first_longer ? from : middle;
        ends[depth++] = first_longer ? middle : to;
        begins[depth] = first_longer ? middle : from;
        ends[depth++] = first_longer ? to : middle;
    }
}

/* Computes the centres of triangles relative to the first corner, scaled to floats; those of regions are their means. */
static void find_centres(builder *b, const double *positions, double scale) {
    const cscd_mesh *mesh = b->mesh;
    const double *origin = positions + (size_t)mesh->triangles[0][0] * 3;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t region = b->given.of_triangle[t];
        float share = 1.0f / (float)(b->region_offsets[region + 1] - b->region_offsets[region]);
        for (size_t k = 0; k < 3; k++) {
            double sum = 0.0;
            for (int i = 0; i < 3; i++) sum += positions[(size_t)mesh->triangles[t][i] * 3 + k] - origin[k];
            b->triangles.centres[t][k] = (float)(sum / 3.0 * scale);
            b->regions.centres[region][k] += share * b->triangles.centres[t][k];
        }
    }
}

/* Sorts the triangles by region. */
static void list_triangles(builder *b) {
    uint32_t triangle_count = b->mesh->triangle_count, sum = 0;
    uint32_t *next =
        b->region_offsets +
        1; /* first counts, then the next free place of each run, and in the end the runs' ends */
    for (uint32_t t = 0; t < triangle_count; t++) next[b->given.of_triangle[t]]++;
    for (uint32_t r = 0; r < b->given.count; r++) {
        uint32_t size = next[r];
        b->regions.items[r] = r;
        next[r] = sum;
        sum += size;
    }
    for (uint32_t t = 0; t < triangle_count; t++) b->triangles.items[next[b->given.of_triangle[t]]++] = t;
}

/* ---- trees, leaves, records ---------------------------------------------------------------------------- */

static uint32_t rounded_up(uint32_t count) {
    return (count + LANES - 1) / LANES * LANES;
}

static uint32_t record_of(builder *b, bvh *f, const bvh_tree *tree, uint32_t vertex) {
    uint32_t known = b->record_of[vertex];
    if (known != UINT32_MAX && known >= tree->first_record) return known;
    f->record_vertices[f->record_count] = vertex;
    return b->record_of[vertex] = f->record_count++;
}

static void fill_leaf(builder *b, bvh *f, const bvh_tree *tree, const uint32_t *triangles, uint32_t count) {
    uint32_t index = f->leaf_count++;
    bvh_leaf *out = &f->leaves[index];
    f->leaf_trees[index] = (uint32_t)(tree - f->trees);
    f->leaf_flags[index].used = (uint8_t)((1u << count) - 1);
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t t = triangles[lane < count ? lane : 0];
        out->triangles[lane] = lane < count ? t : UINT32_MAX;
        for (int i = 0; i < 3; i++) {
            uint32_t record = record_of(b, f, tree, b->mesh->triangles[t][i]);
            out->corners[i][lane] = record;
            if (lane < count) f->record_weights[record] += (float)(b->given.triangle_weights[t] / 3.0);
        }
        if (lane < count) f->slots[t] = index * LANES + lane;
    }
}

/* Cuts the records of a tree into chunks. */
static void add_chunks(bvh *f, uint32_t index) {
    const bvh_tree *tree = &f->trees[index];
    uint32_t end = tree->first_record + tree->record_count;
    for (uint32_t i = tree->first_record; i < end; i += CHUNK_RECORDS) {
        uint32_t stop = end - i < CHUNK_RECORDS ? end : i + CHUNK_RECORDS;
        f->chunks[f->chunk_count++] = (record_chunk){.tree = index, .begin = i, .end = stop};
    }
}

static void fill_tree(builder *b, bvh *f, uint32_t index) {
    bvh_tree *tree = &f->trees[index];
    uint32_t region = b->regions.items[index];
    uint32_t begin = b->region_offsets[region], end = b->region_offsets[region + 1];
    order_run(&b->triangles, begin, end);
    *tree = (bvh_tree){.region = region, .first_leaf = f->leaf_count, .first_record = f->record_count};
    for (uint32_t i = begin; i < end; i += LANES)
        fill_leaf(b, f, tree, b->triangles.items + i, end - i < LANES ? end - i : LANES);
    tree->leaf_count = f->leaf_count - tree->first_leaf;
    while (f->record_count % LANES != 0)
        f->record_vertices[f->record_count++] = f->record_vertices[tree->first_record];
    tree->record_count = f->record_count - tree->first_record;
    add_chunks(f, index);
}

/* ---- levels -------------------------------------------------------------------------------------------- */

static uint32_t blocks_over(uint32_t children) {
    return (children + LANES - 1) / LANES;
}

static bool allocate_level(cscd_context *context, bvh_level *level, uint32_t block_count, int axis_count) {
    size_t floats = (size_t)axis_count * 2 * LANES;
    level->block_count = block_count;
    level->first_children = context_allocate(context, block_count, sizeof *level->first_children);
    level->bounds = context_allocate(context, block_count * floats, sizeof *level->bounds);
    level->flags = context_allocate(context, block_count, sizeof *level->flags);
    return level->first_children != NULL && level->bounds != NULL && level->flags != NULL;
}

static uint32_t add_blocks(bvh_level *level, uint32_t at, uint32_t first_child, uint32_t child_count) {
    for (uint32_t i = 0; i < child_count; i += LANES, at++) {
        uint32_t count = child_count - i < LANES ? child_count - i : LANES;
        level->first_children[at] = first_child + i;
        level->flags[at].used = (uint8_t)((1u << count) - 1);
    }
    return at;
}

/* Returns the number of levels of the largest tree, at least one. */
static int height_of(const bvh *f) {
    int height = 1;
    for (uint32_t p = 0; p < f->tree_count; p++) {
        int own = 1;
        for (uint32_t n = blocks_over(f->trees[p].leaf_count); n > 1; n = blocks_over(n)) own++;
        height = own > height ? own : height;
    }
    return height;
}

/* Adds the blocks of one level of all trees. On entry counts holds the number of children of each tree on this
 * level, on return the number of its blocks. */
static bool add_tree_level(bvh *f, int level, uint32_t *counts) {
    uint32_t total = 0, at = 0, child = 0;
    for (uint32_t p = 0; p < f->tree_count; p++) total += blocks_over(counts[p]);
    if (!allocate_level(f->mesh->context, &f->levels[level], total, f->axis_count)) return false;
    for (uint32_t p = 0; p < f->tree_count; p++) {
        uint32_t first = f->trees[p].first_blocks[level] = at;
        at = add_blocks(&f->levels[level], at, child, counts[p]);
        for (uint32_t i = first; level == 0 && i < at; i++) f->block_trees[i] = p;
        child += counts[p];
        counts[p] = at - first;
    }
    return true;
}

static bool build_levels(bvh *f, uint32_t *counts) {
    uint32_t blocks = 0;
    f->tree_level = f->level_count = height_of(f);
    for (uint32_t p = 0; p < f->tree_count; p++) {
        counts[p] = f->trees[p].leaf_count;
        blocks += blocks_over(counts[p]);
    }
    f->block_trees = context_allocate(f->mesh->context, blocks, sizeof *f->block_trees);
    if (f->block_trees == NULL) return false;
    for (int level = 0; level < f->tree_level; level++) {
        if (!add_tree_level(f, level, counts)) return false;
    }
    uint32_t children = f->tree_count;
    do {
        bvh_level *level = &f->levels[f->level_count++];
        if (!allocate_level(f->mesh->context, level, blocks_over(children), f->axis_count)) return false;
        add_blocks(level, 0, 0, children);
        children = level->block_count;
    } while (children > 1);
    return true;
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

static bool allocate_builder(builder *b) {
    cscd_context *context = b->context;
    uint32_t triangle_count = b->mesh->triangle_count, region_count = b->given.count;
    b->triangles.items = context_allocate(context, triangle_count, sizeof(uint32_t));
    b->triangles.centres = context_allocate(context, triangle_count, sizeof(float[3]));
    b->regions.items = context_allocate(context, region_count, sizeof(uint32_t));
    b->regions.centres = context_allocate(context, region_count, sizeof(float[3]));
    b->region_offsets = context_allocate(context, (size_t)region_count + 1, sizeof(uint32_t));
    b->record_of = context_allocate(context, b->mesh->vertex_count, sizeof(uint32_t));
    if (b->record_of != NULL) memset(b->record_of, 0xff, b->mesh->vertex_count * sizeof(uint32_t));
    return b->triangles.items != NULL && b->triangles.centres != NULL && b->regions.items != NULL &&
           b->regions.centres != NULL && b->region_offsets != NULL && b->record_of != NULL;
}

static void free_builder(builder *b) {
    void *blocks[] = {b->triangles.items, b->triangles.centres, b->regions.items,
                      b->regions.centres, b->region_offsets,    b->record_of};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(b->context, blocks[i]);
}

/* A vertex has a record in each tree that it is in: at most one per corner. */
static uint32_t most_records(const builder *b) {
    const cscd_mesh *mesh = b->mesh;
    uint64_t sum = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t begin = mesh->vertex_star_offsets[v], end = mesh->vertex_star_offsets[v + 1], several = 1;
        for (uint32_t i = begin; i < end; i++) {
            bool other = b->given.of_triangle[mesh->vertex_stars[i]] !=
                         b->given.of_triangle[mesh->vertex_stars[begin]];
            several = other ? end - begin : several;
        }
        sum += several;
    }
    return (uint32_t)sum + b->given.count * LANES;
}

static uint32_t all_leaves(const builder *b) {
    uint32_t sum = 0;
    for (uint32_t r = 0; r < b->given.count; r++)
        sum += rounded_up(b->region_offsets[r + 1] - b->region_offsets[r]) / LANES;
    return sum;
}

static bool allocate_bvh(const builder *b, bvh *f) {
    cscd_context *context = b->context;
    uint32_t leaf_count = all_leaves(b), record_count = most_records(b);
    f->trees = context_allocate(context, f->tree_count, sizeof *f->trees);
    f->leaves = context_allocate(context, leaf_count, sizeof *f->leaves);
    f->leaf_flags = context_allocate(context, leaf_count, sizeof *f->leaf_flags);
    f->flags_before = context_allocate(context, leaf_count, sizeof *f->flags_before);
    f->leaf_trees = context_allocate(context, leaf_count, sizeof *f->leaf_trees);
    f->record_vertices = context_allocate(context, record_count, sizeof *f->record_vertices);
    f->record_weights = context_allocate(context, record_count, sizeof *f->record_weights);
    f->records = context_allocate(context, record_count, sizeof *f->records);
    f->chunks = context_allocate(context, record_count / CHUNK_RECORDS + f->tree_count, sizeof *f->chunks);
    f->slots = context_allocate(context, f->mesh->triangle_count, sizeof *f->slots);
    return f->trees != NULL && f->leaves != NULL && f->leaf_flags != NULL && f->flags_before != NULL &&
           f->leaf_trees != NULL && f->record_vertices != NULL && f->record_weights != NULL &&
           f->records != NULL && f->chunks != NULL && f->slots != NULL;
}

/* Returns the power of two that brings the extent of the positions near 1. */
static double scale_for(const cscd_mesh *mesh, const double *positions) {
    const uint32_t *corners = mesh->triangles[0];
    const double *origin = positions + (size_t)corners[0] * 3;
    double extent = 0.0;
    int exponent = 0;
    for (size_t i = 0; i < (size_t)mesh->triangle_count * 3; i++) {
        for (size_t k = 0; k < 3; k++) {
            double distance = fabs(positions[(size_t)corners[i] * 3 + k] - origin[k]);
            extent = distance > extent ? distance : extent;
        }
    }
    frexp(extent, &exponent);
    return ldexp(1.0, -exponent);
}

cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, int axis_count,
                      bvh *out) {
    builder b = {.context = mesh->context, .mesh = mesh, .given = regions};
    bvh f = {.mesh = mesh,
             .kernels = bvh_kernels_of(mesh->context),
             .axis_count = axis_count,
             .tree_count = regions.count,
             .scale = scale_for(mesh, positions)};
    bool made = allocate_builder(&b);
    if (made) {
        list_triangles(&b);
        find_centres(&b, positions, f.scale);
        order_run(&b.regions, 0, regions.count);
        made = allocate_bvh(&b, &f);
        for (uint32_t p = 0; made && p < f.tree_count; p++) fill_tree(&b, &f, p);
        made = made && build_levels(&f, b.regions.items) && bvh_mark_objects(&f);
    }
    free_builder(&b);
    if (!made) {
        bvh_free(&f);
        return CSCD_OUT_OF_MEMORY;
    }
    assert(bvh_validate(&f, false) == NULL);
    *out = f;
    return CSCD_OK;
}

void bvh_free(bvh *f) {
    if (f->mesh == NULL) return;
    cscd_context *context = f->mesh->context;
    void *blocks[] = {f->trees,           f->leaves,      f->leaf_flags,      f->flags_before,
                      f->leaf_self_pairs, f->block_trees, f->record_vertices, f->record_weights,
                      f->records,         f->slots,       f->chunks,          f->leaf_trees};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(context, f->levels[i].first_children);
        context_free(context, f->levels[i].bounds);
        context_free(context, f->levels[i].flags);
        context_free(context, f->levels[i].self_pairs);
    }
    bvh_free_objects(f);
    *f = (bvh){0};
}

bool bvh_allow_hiding(bvh *f) {
    cscd_context *context = f->mesh->context;
    if (f->leaf_self_pairs == NULL)
        f->leaf_self_pairs = context_allocate(context, f->leaf_count, sizeof *f->leaf_self_pairs);
    bool allocated = f->leaf_self_pairs != NULL;
    for (int i = 0; i < f->tree_level; i++) {
        bvh_level *level = &f->levels[i];
        if (level->self_pairs == NULL)
            level->self_pairs = context_allocate(context, level->block_count, sizeof *level->self_pairs);
        allocated &= level->self_pairs != NULL;
    }
    bvh_show_all(f);
    return allocated;
}
