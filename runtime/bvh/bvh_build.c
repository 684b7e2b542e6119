/* Builds the trees: the order of triangles, leaves, blocks and records. */
#include "runtime/bvh/bvh.h"
#include "runtime/bvh/bvh_hubs.h"
#include "runtime/bvh/bvh_order.h"
#include "runtime/bvh/bvh_slivers.h"

#include <assert.h>
#include <math.h>
#include <string.h>

typedef struct builder {
    cscd_context *context;
    const cscd_mesh *mesh;
    bvh_regions given;
    placed_item *triangles, *regions;
    uint32_t *region_offsets; /* the triangles of region r: triangles[offsets[r] .. offsets[r + 1]) */
    uint32_t *record_of;      /* per vertex: its last record; in an earlier tree if below the tree's first */
} builder;

/* ---- order ------------------------------------------------------------------------------------------- */

/* What threads share to find centres. */
typedef struct centre_work {
    const cscd_mesh *mesh;
    const double *positions;
    double scale;
    placed_item *items;
    uint32_t count;
} centre_work;

enum { CENTRES_PER_TASK = 4096 };

/* Computes the centre of a triangle relative to the first corner, scaled to floats. */
static void find_centre(const centre_work *work, placed_item *item) {
    const uint32_t *corners = work->mesh->triangles[item->name];
    const double *origin = work->positions + (size_t)work->mesh->triangles[0][0] * 3;
    for (size_t k = 0; k < 3; k++) {
        double sum = 0.0;
        for (int i = 0; i < 3; i++) sum += work->positions[(size_t)corners[i] * 3 + k] - origin[k];
        item->centre[k] = (float)(sum / 3.0 * work->scale);
    }
}

static void find_some_centres(void *data, uint32_t index) {
    const centre_work *work = data;
    uint32_t begin = index * CENTRES_PER_TASK, rest = work->count - begin;
    for (uint32_t i = 0; i < rest && i < CENTRES_PER_TASK; i++) find_centre(work, &work->items[begin + i]);
}

static void find_centres(const builder *b, const double *positions, double scale, uint32_t count) {
    centre_work work = {b->mesh, positions, scale, b->triangles, count};
    parallel_run(b->context->threads, (count + CENTRES_PER_TASK - 1) / CENTRES_PER_TASK, find_some_centres,
                 &work);
}

/* The centres of regions are the means of those of their triangles. */
static void place_regions(builder *b) {
    for (uint32_t r = 0; r < b->given.count; r++) {
        uint32_t begin = b->region_offsets[r], end = b->region_offsets[r + 1];
        float share = 1.0f / (float)(end - begin);
        for (uint32_t i = begin; i < end; i++) {
            for (size_t k = 0; k < 3; k++) b->regions[r].centre[k] += share * b->triangles[i].centre[k];
        }
    }
}

/* An order of the regions is one run. */
static bool order_items(builder *b) {
    const uint32_t all[2] = {0, b->given.count};
    return bvh_order_runs(b->context, (item_runs){b->regions, all, 1}) &&
           bvh_order_runs(b->context, (item_runs){b->triangles, b->region_offsets, b->given.count});
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
        b->regions[r].name = r;
        next[r] = sum;
        sum += size;
    }
    for (uint32_t t = 0; t < triangle_count; t++) b->triangles[next[b->given.of_triangle[t]]++].name = t;
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

static void fill_leaf(builder *b, bvh *f, const bvh_tree *tree, const placed_item *items, uint32_t count) {
    uint32_t index = f->leaf_count++;
    bvh_leaf *out = &f->leaves[index];
    f->leaf_trees[index] = (uint32_t)(tree - f->trees);
    f->leaf_flags[index] = (lane_flags){.used = (uint8_t)((1u << count) - 1)};
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t t = items[lane < count ? lane : 0].name;
        out->triangles[lane] = lane < count ? t : UINT32_MAX;
        for (int i = 0; i < 3; i++) {
            uint32_t record = record_of(b, f, tree, b->mesh->triangles[t][i]);
            out->corners[i][lane] = record;
            if (lane < count) f->record_weights[record] += (float)(b->given.triangle_weights[t] / 3.0);
        }
        if (lane < count) f->slots[t] = index * LANES + lane;
    }
}

/* Cuts the records of all trees into chunks. */
static void cut_chunks(bvh *f) {
    f->chunk_count = 0;
    for (uint32_t index = 0; index < f->tree_count; index++) {
        uint32_t begin = f->trees[index].first_record, end = begin + f->trees[index].record_count;
        for (uint32_t i = begin; i < end; i += BVH_CHUNK_RECORDS) {
            uint32_t stop = end - i < BVH_CHUNK_RECORDS ? end : i + BVH_CHUNK_RECORDS;
            f->chunks[f->chunk_count++] = (record_chunk){.tree = index, .begin = i, .end = stop};
        }
    }
}

enum { TRIANGLES_PER_ASK = 1 << 13 };

/* Asks whether the call goes on; false: it does not, and the tree is not whole. */
static bool fill_run(builder *b, bvh *f, bvh_tree *tree, uint32_t region, uint32_t begin, uint32_t end,
                     progress *asked) {
    *tree = (bvh_tree){.region = region,
                       .object = OBJECT_UNKNOWN,
                       .first_leaf = f->leaf_count,
                       .first_record = f->record_count};
    for (uint32_t i = begin; i < end; i += LANES) {
        if ((i - begin) % TRIANGLES_PER_ASK == 0 && asked != NULL && !progress_go_on(asked, 0.0))
            return false;
        fill_leaf(b, f, tree, b->triangles + i, end - i < LANES ? end - i : LANES);
    }
    tree->leaf_count = f->leaf_count - tree->first_leaf;
    while (f->record_count % LANES != 0)
        f->record_vertices[f->record_count++] = f->record_vertices[tree->first_record];
    tree->record_count = f->record_count - tree->first_record;
    return true;
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

static bool allocate_builder(builder *b) {
    cscd_context *context = b->context;
    uint32_t triangle_count = b->mesh->triangle_count, region_count = b->given.count;
    b->triangles = context_allocate(context, triangle_count, sizeof *b->triangles);
    b->regions = context_allocate(context, region_count, sizeof *b->regions);
    b->region_offsets = context_allocate(context, (size_t)region_count + 1, sizeof(uint32_t));
    b->record_of = context_allocate(context, b->mesh->vertex_count, sizeof(uint32_t));
    if (b->record_of != NULL) memset(b->record_of, 0xff, b->mesh->vertex_count * sizeof(uint32_t));
    return b->triangles != NULL && b->regions != NULL && b->region_offsets != NULL && b->record_of != NULL;
}

static void free_builder(builder *b) {
    void *blocks[] = {b->triangles, b->regions, b->region_offsets, b->record_of};
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
    f->record_capacity = record_count;
    f->chunks =
        context_allocate(context, record_count / BVH_CHUNK_RECORDS + f->tree_count, sizeof *f->chunks);
    f->slots = context_allocate(context, f->mesh->triangle_count, sizeof *f->slots);
    return f->trees != NULL && f->leaves != NULL && f->leaf_flags != NULL && f->flags_before != NULL &&
           f->leaf_trees != NULL && f->record_vertices != NULL && f->record_weights != NULL &&
           f->records != NULL && f->chunks != NULL && f->slots != NULL;
}

/* Returns the power of two that brings the extent of these triangles' positions near 1. */
static double scale_for(const cscd_mesh *mesh, const double *positions, const placed_item *items,
                        uint32_t count) {
    const double *origin = positions + (size_t)mesh->triangles[0][0] * 3;
    double extent = 0.0;
    int exponent = 0;
    for (size_t i = 0; i < (size_t)count * 3; i++) {
        const uint32_t *corners = mesh->triangles[items[i / 3].name];
        for (size_t k = 0; k < 3; k++) {
            double distance = fabs(positions[(size_t)corners[i % 3] * 3 + k] - origin[k]);
            extent = distance > extent ? distance : extent;
        }
    }
    frexp(extent, &exponent);
    return ldexp(1.0, -exponent);
}

/* Why there are no trees. */
static cscd_status failure_of(cscd_context *context) {
    cscd_status status = context_progress_status(context);
    return status != CSCD_OK ? status : CSCD_OUT_OF_MEMORY;
}

cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, int axis_count,
                      bvh *out) {
    builder b = {.context = mesh->context, .mesh = mesh, .given = regions};
    bvh f = {.mesh = mesh,
             .kernels = bvh_kernels_of(mesh->context),
             .axis_count = axis_count,
             .tree_count = regions.count};
    bool made = allocate_builder(&b);
    if (made) {
        list_triangles(&b);
        f.scale = scale_for(mesh, positions, b.triangles, mesh->triangle_count);
        find_centres(&b, positions, f.scale, mesh->triangle_count);
        place_regions(&b);
        made = order_items(&b) && allocate_bvh(&b, &f);
        for (uint32_t p = 0; made && p < f.tree_count; p++) {
            uint32_t region = b.regions[p].name;
            made = fill_run(&b, &f, &f.trees[p], region, b.region_offsets[region],
                            b.region_offsets[region + 1], &mesh->context->progress);
        }
        if (made) cut_chunks(&f);
        made = made && bvh_build_levels(&f, b.region_offsets) && bvh_mark_objects(&f) &&
               bvh_allocate_hubs(&f) && bvh_allocate_slivers(&f, positions);
    }
    free_builder(&b);
    if (!made) {
        bvh_free(&f);
        return failure_of(mesh->context);
    }
    assert(bvh_validate(&f, false) == NULL);
    *out = f;
    return CSCD_OK;
}

/* ---- trees that are missing ---------------------------------------------------------------------------- */

uint32_t bvh_count_missing(const bvh *f) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < f->tree_count; i++) sum += f->trees[i].missing;
    return sum;
}

/* Lists the triangles of missing trees by region, as runs; other regions have empty ones. */
static void list_missing(builder *b, const bvh *f) {
    uint32_t sum = 0, *offsets = b->region_offsets, *next = offsets + 1;
    for (uint32_t i = 0; i < f->tree_count; i++) next[f->trees[i].region] = f->trees[i].missing;
    for (uint32_t r = 0; r < b->given.count; r++) {
        uint32_t size = next[r];
        next[r] = size > 0 ? sum : UINT32_MAX;
        sum += size;
    }
    for (uint32_t t = f->missing_begin; t < f->missing_end; t++) {
        uint32_t *place = &next[b->given.of_triangle[t]];
        if (*place != UINT32_MAX) b->triangles[(*place)++].name = t;
    }
    for (uint32_t r = 0; r < b->given.count; r++) next[r] = next[r] == UINT32_MAX ? offsets[r] : next[r];
}

/* Fills the place that a missing tree has been given. */
static void fill_missing(builder *b, bvh *f, uint32_t index) {
    bvh_tree place = f->trees[index], *tree = &f->trees[index];
    uint32_t leaves = f->leaf_count, records = f->record_count, begin = b->region_offsets[place.region];
    memset(f->record_weights + place.first_record, 0, place.record_count * sizeof *f->record_weights);
    f->leaf_count = place.first_leaf;
    f->record_count = place.first_record;
    fill_run(b, f, tree, place.region, begin, begin + place.missing, NULL);
    assert(tree->leaf_count == place.leaf_count && tree->record_count == place.record_count);
    f->leaf_count = leaves;
    f->record_count = records;
}

static void drop_levels(bvh *f) {
    cscd_context *context = f->mesh->context;
    bvh_free_objects(f);
    bvh_free_collapsed(f);
    bvh_free_hubs(f);
    bvh_free_slivers(f);
    bvh_free_levels(f);
    context_free(context, f->block_trees);
    f->block_trees = NULL;
    f->level_count = 0;
}

static bool allocate_missing(builder *b, bvh *f, uint32_t missing) {
    cscd_context *context = b->context;
    b->triangles = context_allocate(context, missing, sizeof *b->triangles);
    b->region_offsets = context_allocate(context, (size_t)b->given.count + 1, sizeof(uint32_t));
    b->record_of = context_reserve(context, b->mesh->vertex_count, sizeof(uint32_t));
    if (f->records == NULL) {
        f->record_capacity = f->record_count + f->record_count / 16;
        f->records = context_allocate(context, f->record_capacity, sizeof *f->records);
    }
    return b->triangles != NULL && b->region_offsets != NULL && b->record_of != NULL && f->records != NULL;
}

static bool fill_all_missing(builder *b, bvh *f, const double *positions, uint32_t missing) {
    memset(b->record_of, 0xff, b->mesh->vertex_count * sizeof(uint32_t));
    list_missing(b, f);
    f->scale = fmin(f->scale, scale_for(b->mesh, positions, b->triangles, missing));
    find_centres(b, positions, f->scale, missing);
    if (!bvh_order_runs(b->context, (item_runs){b->triangles, b->region_offsets, b->given.count}))
        return false;
    for (uint32_t i = 0; i < f->tree_count; i++) {
        if (f->trees[i].missing > 0) fill_missing(b, f, i);
    }
    return true;
}

cscd_status bvh_finish(bvh *f, bvh_regions regions, const object_set *sets, const bool *active,
                       const double *positions) {
    builder b = {.context = f->mesh->context, .mesh = f->mesh, .given = regions};
    uint32_t missing = bvh_count_missing(f);
    bool made = allocate_missing(&b, f, missing) && fill_all_missing(&b, f, positions, missing);
    if (made) {
        cut_chunks(f);
        made = bvh_build_levels(f, b.region_offsets) && bvh_mark_objects(f) && bvh_allocate_hubs(f) &&
               bvh_allocate_slivers(f, positions) && bvh_set_objects(f, sets) && bvh_set_active(f, active);
        if (!made) drop_levels(f);
    }
    free_builder(&b);
    assert(!made || bvh_validate(f, false) == NULL);
    return made ? CSCD_OK : failure_of(f->mesh->context);
}

void bvh_free(bvh *f) {
    if (f->mesh == NULL) return;
    cscd_context *context = f->mesh->context;
    void *blocks[] = {f->trees,           f->leaves,      f->leaf_flags,      f->flags_before,
                      f->leaf_self_pairs, f->block_trees, f->record_vertices, f->record_weights,
                      f->records,         f->slots,       f->chunks,          f->leaf_trees,
                      f->leaf_inactive};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
    bvh_free_objects(f);
    bvh_free_collapsed(f);
    bvh_free_hubs(f);
    bvh_free_slivers(f);
    bvh_free_levels(f);
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
