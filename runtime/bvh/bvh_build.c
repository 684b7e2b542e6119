/* Builds the trees: leaves, records, and the blocks above the leaves, level by level. */
#include "runtime/bvh/bvh_parts.h"

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

/* The arrays that threads share to find centres. */
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

static uint32_t record_of(builder *b, bvh *hierarchy, const bvh_tree *tree, uint32_t vertex) {
    uint32_t known = b->record_of[vertex];
    if (known != UINT32_MAX && known >= tree->first_record) return known;
    hierarchy->record_vertices[hierarchy->record_count] = vertex;
    return b->record_of[vertex] = hierarchy->record_count++;
}

static void fill_leaf(builder *b, bvh *hierarchy, const bvh_tree *tree, const placed_item *items,
                      uint32_t count) {
    uint32_t index = hierarchy->leaf_count++;
    bvh_leaf *out = &hierarchy->leaves[index];
    hierarchy->leaf_trees[index] = (uint32_t)(tree - hierarchy->trees);
    hierarchy->leaf_flags[index] = (lane_flags){.used = (uint8_t)((1u << count) - 1)};
    for (uint32_t lane = 0; lane < LANES; lane++) {
        uint32_t t = items[lane < count ? lane : 0].name;
        out->triangles[lane] = lane < count ? t : UINT32_MAX;
        for (int i = 0; i < 3; i++) {
            uint32_t record = record_of(b, hierarchy, tree, b->mesh->triangles[t][i]);
            out->corners[i][lane] = record;
            if (lane < count)
                hierarchy->record_weights[record] += (float)(b->given.triangle_weights[t] / 3.0);
        }
        if (lane < count) hierarchy->slots[t] = index * LANES + lane;
    }
}

/* Cuts the records of all trees into chunks. */
static void cut_chunks(bvh *hierarchy) {
    hierarchy->chunk_count = 0;
    for (uint32_t index = 0; index < hierarchy->tree_count; index++) {
        uint32_t begin = hierarchy->trees[index].first_record,
                 end = begin + hierarchy->trees[index].record_count;
        for (uint32_t i = begin; i < end; i += BVH_CHUNK_RECORDS) {
            uint32_t stop = end - i < BVH_CHUNK_RECORDS ? end : i + BVH_CHUNK_RECORDS;
            hierarchy->chunks[hierarchy->chunk_count++] =
                (record_chunk){.tree = index, .begin = i, .end = stop};
        }
    }
}

enum { TRIANGLES_PER_ASK = 1 << 13 };

/* Asks whether the call goes on; false: it does not, and the tree is not whole. */
static bool fill_run(builder *b, bvh *hierarchy, bvh_tree *tree, uint32_t region, uint32_t begin,
                     uint32_t end, progress *asked) {
    *tree = (bvh_tree){.region = region,
                       .object = OBJECT_UNKNOWN,
                       .first_leaf = hierarchy->leaf_count,
                       .first_record = hierarchy->record_count};
    for (uint32_t i = begin; i < end; i += LANES) {
        if ((i - begin) % TRIANGLES_PER_ASK == 0 && asked != NULL && !progress_go_on(asked, 0.0))
            return false;
        fill_leaf(b, hierarchy, tree, b->triangles + i, end - i < LANES ? end - i : LANES);
    }
    tree->leaf_count = hierarchy->leaf_count - tree->first_leaf;
    while (hierarchy->record_count % LANES != 0)
        hierarchy->record_vertices[hierarchy->record_count++] =
            hierarchy->record_vertices[tree->first_record];
    tree->record_count = hierarchy->record_count - tree->first_record;
    return true;
}

/* ---- levels ------------------------------------------------------------------------------------------------ */

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
static int height_of(const bvh *hierarchy) {
    int height = 1;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        int own = 1;
        for (uint32_t n = blocks_over(hierarchy->trees[p].leaf_count); n > 1; n = blocks_over(n)) own++;
        height = own > height ? own : height;
    }
    return height;
}

/* Adds the blocks of one level of all trees. On entry counts holds the number of children of each tree on this
 * level, on return the number of its blocks. */
static bool add_tree_level(bvh *hierarchy, int level, uint32_t *counts) {
    uint32_t total = 0, at = 0, child = 0;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) total += blocks_over(counts[p]);
    if (!allocate_level(hierarchy->mesh->context, &hierarchy->levels[level], total, hierarchy->axis_count))
        return false;
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        uint32_t first = hierarchy->trees[p].first_blocks[level] = at;
        at = add_blocks(&hierarchy->levels[level], at, child, counts[p]);
        for (uint32_t i = first; level == 0 && i < at; i++) hierarchy->block_trees[i] = p;
        child += counts[p];
        counts[p] = at - first;
    }
    return true;
}

/* Adds all blocks above the leaves; counts: scratch, one number per tree. False: no memory. */
static bool build_levels(bvh *hierarchy, uint32_t *counts) {
    uint32_t blocks = 0;
    hierarchy->tree_level = hierarchy->level_count = height_of(hierarchy);
    for (uint32_t p = 0; p < hierarchy->tree_count; p++) {
        counts[p] = hierarchy->trees[p].leaf_count;
        blocks += blocks_over(counts[p]);
    }
    hierarchy->block_trees =
        context_allocate(hierarchy->mesh->context, blocks, sizeof *hierarchy->block_trees);
    if (hierarchy->block_trees == NULL) return false;
    for (int level = 0; level < hierarchy->tree_level; level++) {
        if (!add_tree_level(hierarchy, level, counts)) return false;
    }
    uint32_t children = hierarchy->tree_count;
    do {
        bvh_level *level = &hierarchy->levels[hierarchy->level_count++];
        if (!allocate_level(hierarchy->mesh->context, level, blocks_over(children), hierarchy->axis_count))
            return false;
        add_blocks(level, 0, 0, children);
        children = level->block_count;
    } while (children > 1);
    return true;
}

static void free_levels(bvh *hierarchy) {
    cscd_context *context = hierarchy->mesh->context;
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        context_free(context, hierarchy->levels[i].first_children);
        context_free(context, hierarchy->levels[i].bounds);
        context_free(context, hierarchy->levels[i].flags);
        context_free(context, hierarchy->levels[i].self_pairs);
        context_free(context, hierarchy->levels[i].inactive_lanes);
        hierarchy->levels[i] = (bvh_level){0};
    }
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

static bool allocate_bvh(const builder *b, bvh *hierarchy) {
    cscd_context *context = b->context;
    uint32_t leaf_count = all_leaves(b), record_count = most_records(b);
    hierarchy->trees = context_allocate(context, hierarchy->tree_count, sizeof *hierarchy->trees);
    hierarchy->leaves = context_allocate(context, leaf_count, sizeof *hierarchy->leaves);
    hierarchy->leaf_flags = context_allocate(context, leaf_count, sizeof *hierarchy->leaf_flags);
    hierarchy->flags_before = context_allocate(context, leaf_count, sizeof *hierarchy->flags_before);
    hierarchy->leaf_trees = context_allocate(context, leaf_count, sizeof *hierarchy->leaf_trees);
    hierarchy->record_vertices = context_allocate(context, record_count, sizeof *hierarchy->record_vertices);
    hierarchy->record_weights = context_allocate(context, record_count, sizeof *hierarchy->record_weights);
    hierarchy->records = context_allocate(context, record_count, sizeof *hierarchy->records);
    hierarchy->record_capacity = record_count;
    hierarchy->chunks = context_allocate(context, record_count / BVH_CHUNK_RECORDS + hierarchy->tree_count,
                                         sizeof *hierarchy->chunks);
    hierarchy->slots = context_allocate(context, hierarchy->mesh->triangle_count, sizeof *hierarchy->slots);
    return hierarchy->trees != NULL && hierarchy->leaves != NULL && hierarchy->leaf_flags != NULL &&
           hierarchy->flags_before != NULL && hierarchy->leaf_trees != NULL &&
           hierarchy->record_vertices != NULL && hierarchy->record_weights != NULL &&
           hierarchy->records != NULL && hierarchy->chunks != NULL && hierarchy->slots != NULL;
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

/* The reason why there are no trees. */
static cscd_status failure_of(cscd_context *context) {
    cscd_status status = context_progress_status(context);
    return status != CSCD_OK ? status : CSCD_OUT_OF_MEMORY;
}

cscd_status bvh_build(const cscd_mesh *mesh, bvh_regions regions, const double *positions, int axis_count,
                      bvh *out) {
    builder b = {.context = mesh->context, .mesh = mesh, .given = regions};
    bvh hierarchy = {.mesh = mesh,
                     .kernels = bvh_kernels_of(mesh->context),
                     .axis_count = axis_count,
                     .tree_count = regions.count};
    bool made = allocate_builder(&b);
    if (made) {
        list_triangles(&b);
        hierarchy.scale = scale_for(mesh, positions, b.triangles, mesh->triangle_count);
        find_centres(&b, positions, hierarchy.scale, mesh->triangle_count);
        place_regions(&b);
        made = order_items(&b) && allocate_bvh(&b, &hierarchy);
        for (uint32_t p = 0; made && p < hierarchy.tree_count; p++) {
            uint32_t region = b.regions[p].name;
            made = fill_run(&b, &hierarchy, &hierarchy.trees[p], region, b.region_offsets[region],
                            b.region_offsets[region + 1], &mesh->context->progress);
        }
        if (made) cut_chunks(&hierarchy);
        made = made && build_levels(&hierarchy, b.region_offsets) && bvh_mark_objects(&hierarchy) &&
               bvh_allocate_second_volumes(&hierarchy, positions);
    }
    free_builder(&b);
    if (!made) {
        bvh_free(&hierarchy);
        return failure_of(mesh->context);
    }
    assert(bvh_validate(&hierarchy, false) == NULL);
    *out = hierarchy;
    return CSCD_OK;
}

/* ---- trees that are missing ---------------------------------------------------------------------------- */

uint32_t bvh_count_missing(const bvh *hierarchy) {
    uint32_t sum = 0;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) sum += hierarchy->trees[i].missing;
    return sum;
}

/* Lists the triangles of missing trees by region, as runs; other regions have empty ones. */
static void list_missing(builder *b, const bvh *hierarchy) {
    uint32_t sum = 0, *offsets = b->region_offsets, *next = offsets + 1;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++)
        next[hierarchy->trees[i].region] = hierarchy->trees[i].missing;
    for (uint32_t r = 0; r < b->given.count; r++) {
        uint32_t size = next[r];
        next[r] = size > 0 ? sum : UINT32_MAX;
        sum += size;
    }
    for (uint32_t t = hierarchy->missing_begin; t < hierarchy->missing_end; t++) {
        uint32_t *place = &next[b->given.of_triangle[t]];
        if (*place != UINT32_MAX) b->triangles[(*place)++].name = t;
    }
    for (uint32_t r = 0; r < b->given.count; r++) next[r] = next[r] == UINT32_MAX ? offsets[r] : next[r];
}

/* Fills the place that a missing tree has been given. */
static void fill_missing(builder *b, bvh *hierarchy, uint32_t index) {
    bvh_tree place = hierarchy->trees[index], *tree = &hierarchy->trees[index];
    uint32_t leaves = hierarchy->leaf_count, records = hierarchy->record_count,
             begin = b->region_offsets[place.region];
    memset(hierarchy->record_weights + place.first_record, 0,
           place.record_count * sizeof *hierarchy->record_weights);
    hierarchy->leaf_count = place.first_leaf;
    hierarchy->record_count = place.first_record;
    fill_run(b, hierarchy, tree, place.region, begin, begin + place.missing, NULL);
    assert(tree->leaf_count == place.leaf_count && tree->record_count == place.record_count);
    hierarchy->leaf_count = leaves;
    hierarchy->record_count = records;
}

static void drop_levels(bvh *hierarchy) {
    cscd_context *context = hierarchy->mesh->context;
    bvh_free_objects(hierarchy);
    bvh_free_collapsed(hierarchy);
    bvh_free_second_volumes(hierarchy);
    free_levels(hierarchy);
    context_free(context, hierarchy->block_trees);
    hierarchy->block_trees = NULL;
    hierarchy->level_count = 0;
}

static bool allocate_missing(builder *b, bvh *hierarchy, uint32_t missing) {
    cscd_context *context = b->context;
    b->triangles = context_allocate(context, missing, sizeof *b->triangles);
    b->region_offsets = context_allocate(context, (size_t)b->given.count + 1, sizeof(uint32_t));
    b->record_of = context_reserve(context, b->mesh->vertex_count, sizeof(uint32_t));
    if (hierarchy->records == NULL) {
        hierarchy->record_capacity = hierarchy->record_count + hierarchy->record_count / 16;
        hierarchy->records =
            context_allocate(context, hierarchy->record_capacity, sizeof *hierarchy->records);
    }
    return b->triangles != NULL && b->region_offsets != NULL && b->record_of != NULL &&
           hierarchy->records != NULL;
}

static bool fill_all_missing(builder *b, bvh *hierarchy, const double *positions, uint32_t missing) {
    memset(b->record_of, 0xff, b->mesh->vertex_count * sizeof(uint32_t));
    list_missing(b, hierarchy);
    hierarchy->scale = fmin(hierarchy->scale, scale_for(b->mesh, positions, b->triangles, missing));
    find_centres(b, positions, hierarchy->scale, missing);
    if (!bvh_order_runs(b->context, (item_runs){b->triangles, b->region_offsets, b->given.count}))
        return false;
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        if (hierarchy->trees[i].missing > 0) fill_missing(b, hierarchy, i);
    }
    return true;
}

cscd_status bvh_finish(bvh *hierarchy, bvh_regions regions, const object_set *sets, const bool *active,
                       const double *positions) {
    builder b = {.context = hierarchy->mesh->context, .mesh = hierarchy->mesh, .given = regions};
    uint32_t missing = bvh_count_missing(hierarchy);
    bool made =
        allocate_missing(&b, hierarchy, missing) && fill_all_missing(&b, hierarchy, positions, missing);
    if (made) {
        cut_chunks(hierarchy);
        made = build_levels(hierarchy, b.region_offsets) && bvh_mark_objects(hierarchy) &&
               bvh_allocate_second_volumes(hierarchy, positions) && bvh_set_objects(hierarchy, sets) &&
               bvh_set_active(hierarchy, active);
        if (!made) drop_levels(hierarchy);
    }
    free_builder(&b);
    assert(!made || bvh_validate(hierarchy, false) == NULL);
    return made ? CSCD_OK : failure_of(hierarchy->mesh->context);
}

void bvh_free(bvh *hierarchy) {
    if (hierarchy->mesh == NULL) return;
    cscd_context *context = hierarchy->mesh->context;
    void *blocks[] = {hierarchy->trees,           hierarchy->leaves,          hierarchy->leaf_flags,
                      hierarchy->flags_before,    hierarchy->leaf_self_pairs, hierarchy->block_trees,
                      hierarchy->record_vertices, hierarchy->record_weights,  hierarchy->records,
                      hierarchy->slots,           hierarchy->chunks,          hierarchy->leaf_trees,
                      hierarchy->leaf_inactive};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
    bvh_free_objects(hierarchy);
    bvh_free_collapsed(hierarchy);
    bvh_free_second_volumes(hierarchy);
    free_levels(hierarchy);
    *hierarchy = (bvh){0};
}

bool bvh_allow_hiding(bvh *hierarchy) {
    cscd_context *context = hierarchy->mesh->context;
    if (hierarchy->leaf_self_pairs == NULL)
        hierarchy->leaf_self_pairs =
            context_allocate(context, hierarchy->leaf_count, sizeof *hierarchy->leaf_self_pairs);
    bool allocated = hierarchy->leaf_self_pairs != NULL;
    for (int i = 0; i < hierarchy->tree_level; i++) {
        bvh_level *level = &hierarchy->levels[i];
        if (level->self_pairs == NULL)
            level->self_pairs = context_allocate(context, level->block_count, sizeof *level->self_pairs);
        allocated &= level->self_pairs != NULL;
    }
    bvh_show_all(hierarchy);
    return allocated;
}
