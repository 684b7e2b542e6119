/* Trees that move over to another mesh: what is kept is renumbered and copied, what is missing gets a place. */
#include "runtime/bvh/bvh_parts.h"
#include "src/mesh/mesh_change.h"

#include <string.h>

/* ---- order -------------------------------------------------------------------------------------------- */

/* The tree that stands in each place: an old tree, or a region without one. */
typedef struct tree_order {
    uint32_t
        *trees; /* per new tree: the old one, or tree_count of the old BVH plus the place in move->fresh */
    uint32_t *first,
        *next; /* lists of fresh regions, by the old region that they follow and by the place of the last one */
    uint32_t count;
} tree_order;

static array_list order_arrays(const bvh_move *move, tree_order *o) {
    return (array_list){{ARRAY(o->trees, move->region_count),
                         ARRAY(o->first, (size_t)move->old_region_count + 1),
                         ARRAY(o->next, move->fresh_count)}};
}

static void add_list(const bvh *hierarchy, tree_order *o, uint32_t first) {
    for (uint32_t i = first; i != UINT32_MAX; i = o->next[i])
        o->trees[o->count++] = hierarchy->tree_count + i;
}

static void order_trees(const bvh *hierarchy, const bvh_move *move, tree_order *o) {
    memset(o->first, 0xff, ((size_t)move->old_region_count + 1) * sizeof *o->first);
    for (uint32_t i = move->fresh_count; i-- > 0;) {
        uint32_t after = move->fresh[i].after;
        uint32_t *first = &o->first[after != UINT32_MAX ? after : move->old_region_count];
        o->next[i] = *first;
        *first = i;
    }
    for (uint32_t i = 0; i < hierarchy->tree_count; i++) {
        if (move->regions[hierarchy->trees[i].region] != UINT32_MAX) o->trees[o->count++] = i;
        add_list(hierarchy, o, o->first[hierarchy->trees[i].region]);
    }
    add_list(hierarchy, o, o->first[move->old_region_count]);
}

/* ---- places ------------------------------------------------------------------------------------------- */

static uint32_t rounded_up(uint32_t count) {
    return (count + LANES - 1) / LANES * LANES;
}

static bvh_tree place_of(const bvh *hierarchy, const bvh_move *move, uint32_t item) {
    if (item >= hierarchy->tree_count) {
        const fresh_region *fresh = &move->fresh[item - hierarchy->tree_count];
        return (bvh_tree){.region = fresh->region,
                          .object = OBJECT_UNKNOWN,
                          .missing = fresh->triangle_count,
                          .leaf_count = rounded_up(fresh->triangle_count) / LANES,
                          .record_count = rounded_up(fresh->vertex_count)};
    }
    const bvh_tree *old = &hierarchy->trees[item];
    bool unknown = old->object == OBJECT_UNKNOWN;
    return (bvh_tree){.region = move->regions[old->region],
                      .object = unknown ? OBJECT_UNKNOWN : move->change->objects.to_new[old->object],
                      .missing = old->missing,
                      .leaf_count = old->leaf_count,
                      .record_count = old->record_count};
}

static void place_trees(const bvh *hierarchy, const bvh_move *move, const tree_order *o, bvh *out) {
    for (uint32_t i = 0; i < o->count; i++) {
        bvh_tree tree = place_of(hierarchy, move, o->trees[i]);
        tree.first_leaf = out->leaf_count;
        tree.first_record = out->record_count;
        out->leaf_count += tree.leaf_count;
        out->record_count += tree.record_count;
        out->trees[out->tree_count++] = tree;
    }
}

/* Missing trees are of objects that have changed, or were missing already. */
static void find_missing(const bvh *hierarchy, const cscd_mesh_change *change, bvh *out) {
    out->missing_begin = bvh_count_missing(hierarchy) > 0 ? 0 : UINT32_MAX;
    out->missing_end = bvh_count_missing(hierarchy) > 0 ? out->mesh->triangle_count : 0;
    for (uint32_t i = 0; i < change->described_count; i++) {
        const object_range *range = &change->described[i];
        uint32_t begin = range->triangle, end = begin + range->triangle_count;
        if (begin < out->missing_begin) out->missing_begin = begin;
        if (end > out->missing_end) out->missing_end = end;
    }
}

static bool allocate_places(bvh *out) {
    cscd_context *context = out->mesh->context;
    size_t leaves = out->leaf_count, records = out->record_count;
    out->flags_before = context_allocate(context, leaves, sizeof *out->flags_before);
    if (out->flags_before == NULL) return false;
    array_list list = {{ARRAY(out->leaves, leaves), ARRAY(out->leaf_flags, leaves),
                        ARRAY(out->leaf_trees, leaves), ARRAY(out->record_vertices, records),
                        ARRAY(out->record_weights, records),
                        ARRAY(out->chunks, records / BVH_CHUNK_RECORDS + out->tree_count),
                        ARRAY(out->slots, out->mesh->triangle_count)}};
    return context_reserve_all(context, list);
}

/* ---- copies ------------------------------------------------------------------------------------------- */

/* Lanes that are not used stay so. */
static void shift_triangles(const uint32_t *from, uint32_t by, uint32_t *to) {
    for (int lane = 0; lane < LANES; lane++)
        to[lane] = from[lane] != UINT32_MAX ? from[lane] + by : UINT32_MAX;
}

static void map_triangles(const uint32_t *from, const uint32_t *map, uint32_t *to) {
    for (int lane = 0; lane < LANES; lane++)
        to[lane] = from[lane] != UINT32_MAX ? map[from[lane]] : UINT32_MAX;
}

/* run: that of its triangles; NULL: their object has changed. */
static void move_leaf(const bvh_leaf *from, const bvh_move *move, const number_run *run, uint32_t records,
                      bvh_leaf *to) {
    for (int i = 0; i < 3; i++) {
        for (int lane = 0; lane < LANES; lane++) to->corners[i][lane] = from->corners[i][lane] + records;
    }
    if (run != NULL)
        shift_triangles(from->triangles, run->to - run->from, to->triangles);
    else
        map_triangles(from->triangles, move->change->triangles.to_new, to->triangles);
}

static void move_leaves(const bvh *hierarchy, const bvh_move *move, const bvh_tree *from,
                        const number_run *run, const bvh_tree *to, bvh *out) {
    uint32_t records = to->first_record - from->first_record;
    for (uint32_t i = 0; i < to->leaf_count; i++) {
        bvh_leaf *leaf = &out->leaves[to->first_leaf + i];
        uint8_t used = hierarchy->leaf_flags[from->first_leaf + i].used;
        move_leaf(&hierarchy->leaves[from->first_leaf + i], move, run, records, leaf);
        for (uint32_t lane = 0; lane < LANES && (used >> lane & 1) != 0; lane++)
            out->slots[leaf->triangles[lane]] = (to->first_leaf + i) * LANES + lane;
        out->leaf_flags[to->first_leaf + i] = (lane_flags){.used = used};
    }
}

static void move_records(const bvh *hierarchy, const bvh_move *move, const bvh_tree *from, const bvh_tree *to,
                         bvh *out) {
    const uint32_t *vertices = hierarchy->record_vertices + from->first_record;
    const number_run *run = number_map_run(&move->change->vertices, vertices[0]);
    uint32_t *moved = out->record_vertices + to->first_record;
    if (run != NULL) copy_shifted(vertices, to->record_count, run->to - run->from, moved);
    for (uint32_t i = 0; run == NULL && i < to->record_count; i++)
        moved[i] = move->change->vertices.to_new[vertices[i]];
    memcpy(out->record_weights + to->first_record, hierarchy->record_weights + from->first_record,
           to->record_count * sizeof *out->record_weights);
}

/* All triangles of a tree that is kept are of one component. */
static void move_tree(const bvh *hierarchy, const bvh_move *move, const bvh_tree *from, uint32_t index,
                      bvh *out) {
    const bvh_tree *to = &out->trees[index];
    for (uint32_t i = 0; i < to->leaf_count; i++) out->leaf_trees[to->first_leaf + i] = index;
    if (from == NULL || from->missing > 0) return;
    const number_run *run =
        number_map_run(&move->change->triangles, hierarchy->leaves[from->first_leaf].triangles[0]);
    move_leaves(hierarchy, move, from, run, to, out);
    move_records(hierarchy, move, from, to, out);
}

static bool move_all(const bvh *hierarchy, const bvh_move *move, const tree_order *o, bvh *out) {
    out->trees = context_allocate(out->mesh->context, move->region_count, sizeof *out->trees);
    if (out->trees == NULL) return false;
    place_trees(hierarchy, move, o, out);
    find_missing(hierarchy, move->change, out);
    if (!allocate_places(out)) return false;
    for (uint32_t i = 0; i < o->count; i++)
        move_tree(hierarchy, move,
                  o->trees[i] < hierarchy->tree_count ? &hierarchy->trees[o->trees[i]] : NULL, i, out);
    return true;
}

cscd_status bvh_move_over(const bvh *hierarchy, const bvh_move *move, bvh *out) {
    bvh moved = {.mesh = move->mesh,
                 .kernels = hierarchy->kernels,
                 .axis_count = hierarchy->axis_count,
                 .scale = hierarchy->scale};
    tree_order order = {.count = 0};
    if (!context_allocate_all(move->mesh->context, order_arrays(move, &order))) return CSCD_OUT_OF_MEMORY;
    order_trees(hierarchy, move, &order);
    bool made = move_all(hierarchy, move, &order, &moved);
    context_free_all(move->mesh->context, order_arrays(move, &order));
    if (!made) {
        bvh_free(&moved);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = moved;
    return CSCD_OK;
}

void bvh_take_records(bvh *hierarchy, bvh *from) {
    if (from->records == NULL || from->record_capacity < hierarchy->record_count ||
        hierarchy->records != NULL)
        return;
    hierarchy->records = from->records;
    hierarchy->record_capacity = from->record_capacity;
    from->records = NULL;
}

/* ---- copies of all ------------------------------------------------------------------------------------- */

static array_list bvh_arrays(bvh *hierarchy) {
    size_t leaves = hierarchy->leaf_count, records = hierarchy->record_capacity,
           blocks = hierarchy->levels[0].block_count;
    return (array_list){
        {ARRAY(hierarchy->trees, hierarchy->tree_count), ARRAY(hierarchy->leaves, leaves),
         ARRAY(hierarchy->leaf_flags, leaves), ARRAY(hierarchy->flags_before, leaves),
         ARRAY(hierarchy->leaf_self_pairs, leaves), ARRAY(hierarchy->leaf_inactive, leaves),
         ARRAY(hierarchy->block_trees, blocks), ARRAY(hierarchy->leaf_trees, leaves),
         ARRAY(hierarchy->record_vertices, hierarchy->record_count),
         ARRAY(hierarchy->record_weights, hierarchy->record_count),
         ARRAY(hierarchy->chunks, hierarchy->record_count / BVH_CHUNK_RECORDS + hierarchy->tree_count),
         ARRAY(hierarchy->records, records), ARRAY(hierarchy->slots, hierarchy->mesh->triangle_count)}};
}

static array_list level_arrays(bvh_level *level, int axis_count) {
    size_t blocks = level->block_count;
    return (array_list){
        {ARRAY(level->first_children, blocks), ARRAY(level->bounds, blocks * (size_t)axis_count * 2 * LANES),
         ARRAY(level->flags, blocks), ARRAY(level->self_pairs, blocks), ARRAY(level->obstacle_lanes, blocks),
         ARRAY(level->child_sets, blocks * LANES), ARRAY(level->inactive_lanes, blocks),
         ARRAY(level->collapsed_lanes, blocks), ARRAY(level->child_hubs, blocks * LANES),
         ARRAY(level->child_slivers, blocks * LANES)}};
}

/* A level that is not whole belongs to the other BVH. */
static bool copy_levels(cscd_context *context, bvh *hierarchy) {
    bool whole = true;
    for (int i = 0; i < BVH_LEVEL_MAX; i++) {
        if (whole)
            whole = context_copy_all(context, level_arrays(&hierarchy->levels[i], hierarchy->axis_count));
        if (!whole) hierarchy->levels[i] = (bvh_level){.block_count = 0};
    }
    return whole;
}

cscd_status bvh_copy(const bvh *hierarchy, const cscd_mesh *mesh, bvh *out) {
    bvh copy = *hierarchy;
    copy.mesh = mesh;
    copy.kernels = bvh_kernels_of(mesh->context);
    bool arrays = context_copy_all(mesh->context, bvh_arrays(&copy));
    bool levels = copy_levels(mesh->context, &copy);
    if (!arrays || !levels) {
        bvh_free(&copy);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = copy;
    return CSCD_OK;
}
