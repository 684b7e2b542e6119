/* The visit of a pair of blocks: eight children are compared with eight.
 *
 *     block a        block b          visit_blocks(a, b), for each used lane i of a:
 *     +-+-+-+-+      +-+-+-+-+          lanes = lanes_to_compare(i)     by flags: orientation, obstacles, activity, hidden pairs
 *     |0|1|2|.|      |0|1|2|.|          lanes &= ~lanes_apart(a[i], b)  eight volumes of b in one comparison
 *     +-+-+-+-+      +-+-+-+-+          visit_children(a[i], lanes of b)
 *        |  .         .  |                on a higher level: the pair (a[i], b[j]) goes on the stack for later
 *        |    .     .    |                on level 0: two leaves are compared at once, triangle i with eight triangles,
 *     +-+-+-+-+ .. +-+-+-+-+              by their boxes, then by their diagonals; the pairs left go to the batch
 *     |       |    |       |
 *
 * A block that is visited with itself compares lane i with the lanes after i, and its children with themselves. Blocks
 * of two trees are in two frames: a displacement moves the volumes of a into the frame of b. */
#include "runtime/bvh/bvh_simd.h"

/* ---- lanes --------------------------------------------------------------------------------------------- */

/* Chooses the lanes of two blocks, or of two leaves, that are compared at all: by flags, obstacles, activity, objects and hidden pairs. */

/* A pair of blocks or of leaves whose lanes are compared. */
typedef struct lane_comparison {
    lane_flags a, b;
    lane_flags before_a, before_b; /* flags of leaves before, in the pass NEWLY_KEPT */
    uint64_t self_pairs;
    /* For blocks: lanes that hold obstacles only, lanes without active triangles and lanes of collapsed components, where
     * the pass skips pairs of two of these, and all of them. */
    uint32_t obstacles_a, obstacles_b, inactive_a, inactive_b, collapsed_a, collapsed_b, resting_a;
    bool itself, one_tree, leaves;
    traversal_pass pass;
} lane_comparison;

static inline uint32_t one_sign(uint32_t plus_a, uint32_t minus_a, uint32_t plus_b, uint32_t minus_b, int i) {
    return (plus_a >> i & 1) != 0 ? plus_b : (minus_a >> i & 1) != 0 ? minus_b : 0;
}

/* Returns those of the lanes of b whose objects are looked at with some of a's. */
static inline uint32_t lanes_looked_at(const object_set *a, const object_set *b, uint32_t lanes) {
    uint32_t kept = 0;
    for (; lanes != 0; lanes &= lanes - 1) {
        int lane = __builtin_ctz(lanes);
        kept |= (uint32_t)object_sets_may_meet(a, &b[lane]) << lane;
    }
    return kept;
}

/* Returns the lanes of b that hold obstacles, nothing active, or collapsed components, as lane i of a. */
static inline uint32_t lanes_at_rest(const lane_comparison *c, int i) {
    uint32_t obstacles = (c->obstacles_a >> i & 1) != 0 ? c->obstacles_b : 0;
    uint32_t inactive = (c->inactive_a >> i & 1) != 0 ? c->inactive_b : 0;
    return obstacles | inactive | ((c->collapsed_a >> i & 1) != 0 ? c->collapsed_b : 0);
}

/* Returns the lanes of b that are to be compared with lane i of a. */
static inline uint32_t lanes_to_compare(const lane_comparison *c, int i) {
    uint32_t lanes = c->b.used;
    if ((c->resting_a >> i & 1) != 0) lanes &= ~lanes_at_rest(c, i);
    if (c->itself) lanes &= (uint32_t)(c->self_pairs >> (8 * i)) & ((uint32_t)ALL_LANES << (i + 1));
    if (c->pass == TRAVERSAL_UNPROVEN) return (c->a.newly_kept >> i & 1) != 0 ? lanes & c->b.newly_kept : 0;
    if (c->pass == TRAVERSAL_NEWLY_KEPT) {
        if (!c->one_tree) return 0;
        if ((c->a.newly_kept >> i & 1) == 0) lanes &= c->b.newly_kept;
        if (c->leaves)
            lanes &= one_sign(c->before_a.plus, c->before_a.minus, c->before_b.plus, c->before_b.minus, i);
    } else if (c->one_tree) {
        lanes &= ~one_sign(c->a.plus, c->a.minus, c->b.plus, c->b.minus, i);
    }
    return lanes;
}

/* ---- places of trees ----------------------------------------------------------------------------------- */

/* The place of tree b relative to tree a: per axis at both ends of the interval, off by at most slack, and between
 * low and high throughout. Volumes of a are moved back by as much and then compared with those of b. */
typedef struct displacement {
    float at[2][KDOP_AXES], slack, low[KDOP_AXES], high[KDOP_AXES];
} displacement;

/* Rounding: differences of origins are off by 2^-52 of these, floats by 2^-24 of the sums, and a moved volume by as
 * much. The slack that covers all of it, three times over along diagonals, is 2^-20 of all lengths involved. */
static displacement displacement_between(const bvh *hierarchy, const bvh_tree *a, const bvh_tree *b) {
    displacement out;
    double start[3], end[3], size = (double)a->reach + (double)b->reach;
    for (int k = 0; k < 3; k++) {
        start[k] = (b->origin[0][k] - a->origin[0][k]) * hierarchy->scale;
        end[k] = (b->origin[1][k] - a->origin[1][k]) * hierarchy->scale;
        size += (start[k] < 0 ? -start[k] : start[k]) + (end[k] < 0 ? -end[k] : end[k]);
        for (int e = 0; e < 2; e++) {
            double from = a->origin[e][k] * hierarchy->scale, to = b->origin[e][k] * hierarchy->scale;
            size += 0x1p-30 * ((from < 0 ? -from : from) + (to < 0 ? -to : to));
        }
    }
    out.slack = (float)(size * 0x1p-20);
    for (int axis = 0; axis < KDOP_AXES; axis++) {
        out.at[0][axis] = (float)kdop_along(start, axis);
        out.at[1][axis] = (float)kdop_along(end, axis);
        bool forward = out.at[0][axis] < out.at[1][axis];
        out.low[axis] = out.at[forward ? 0 : 1][axis] - out.slack;
        out.high[axis] = out.at[forward ? 1 : 0][axis] + out.slack;
    }
    return out;
}

/* Returns the lanes of b whose volumes over the interval do not overlap that of lane i of a. */
static inline uint32_t lanes_apart(const float *a, const float *b, int i, int axis_count,
                                   const displacement *d) {
    uint32_t lanes = 0;
    for (int k = 0; k < axis_count; k++) {
        float low = a[2 * k * LANES + i], high = a[(2 * k + 1) * LANES + i];
        if (d != NULL) {
            low -= d->high[k];
            high -= d->low[k];
        }
        lanes |= f32x8_below(f32x8_all(high), f32x8_load(b + 2 * k * LANES));
        lanes |= f32x8_below(f32x8_load(b + (2 * k + 1) * LANES), f32x8_all(low));
    }
    return lanes;
}

/* Returns the lanes of b that lie on one side of lane i of a at both ends, along one of the axes from first on. They
 * do so throughout the interval, because points move linearly. still: both ends are the same. */
static inline uint32_t apart_at_ends(const leaf_volumes *a, const leaf_volumes *b, int i, int first,
                                     int axis_end, bool still, const displacement *d) {
    uint32_t lanes = 0;
    for (int k = first; k < axis_end; k++) {
        uint32_t before = ALL_LANES, behind = ALL_LANES;
        for (int e = 0; e < (still ? 1 : 2); e++) {
            float low = a->low[e][k][i], high = a->high[e][k][i];
            if (d != NULL) {
                low -= d->at[e][k] + d->slack;
                high -= d->at[e][k] - d->slack;
            }
            before &= f32x8_below(f32x8_all(high), b->low[e][k]);
            behind &= f32x8_below(b->high[e][k], f32x8_all(low));
        }
        lanes |= before | behind;
    }
    return lanes;
}

/* ---- triangles of leaves ------------------------------------------------------------------------------- */

_Static_assert(sizeof(leaf_volumes) == LEAF_VOLUME_FLOATS * sizeof(float), "bvh.h makes room for these");

static const leaf_volumes *leaf_volumes_of(const bvh *hierarchy, leaf_cache *cache, uint32_t index,
                                           const bvh_tree *tree) {
    uint32_t place = index % LEAF_CACHE_SIZE;
    leaf_volumes *out = (leaf_volumes *)cache->volumes + place;
    if (cache->tags[place] == index + 1) return out;
    leaf_corners corners;
    load_corners(hierarchy, &hierarchy->leaves[index], corners);
    if (hierarchy->still)
        volumes_of(corners, tree->slack, true, out);
    else
        volumes_of(corners, tree->slack, false, out);
    cache->tags[place] = index + 1;
    return out;
}

/* Returns the triangles of a leaf whose boxes overlap lane i of the bounds of a block. */
static inline uint32_t near_lane(const leaf_volumes *volumes, const float *bounds, int i,
                                 const displacement *d) {
    return ~lanes_apart(bounds, (const float *)volumes->swept, i, BOX_AXES, d) & ALL_LANES;
}

static inline void add_pairs(traversal_worker *worker, uint32_t slot, uint32_t first, uint32_t lanes) {
    while (lanes != 0) {
        worker->pairs[worker->pair_count++] = (triangle_pair){slot, first + (uint32_t)__builtin_ctz(lanes)};
        lanes &= lanes - 1;
    }
}

typedef struct leaf_pair {
    uint32_t a, b;
    const leaf_volumes *volumes_a, *volumes_b;
    uint32_t rows, columns; /* the lanes of a and of b that are compared */
} leaf_pair;

/* As lanes_without_shared_vertex, but a hub does not count as shared. */
static __attribute__((noinline)) uint32_t
lanes_without_small_star(const bvh *hierarchy, const leaf_pair *pair, int i, uint32_t lanes) {
    const cscd_mesh *mesh = hierarchy->mesh;
    const uint32_t *corners = mesh->triangles[hierarchy->leaves[pair->a].triangles[i]];
    uint32_t kept = lanes;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
        int lane = __builtin_ctz(rest);
        const uint32_t *others = mesh->triangles[hierarchy->leaves[pair->b].triangles[lane]];
        bool shared = false;
        for (int j = 0; j < 3; j++)
            shared |= triangle_contains(others, corners[j]) && !vertex_is_hub(mesh, corners[j]);
        kept ^= (uint32_t)shared << lane;
    }
    return kept;
}

/* Returns the given lanes of b, without those whose triangles share a vertex with triangle i of a. */
static inline uint32_t lanes_without_shared_vertex(const bvh *hierarchy, const leaf_pair *pair, int i,
                                                   uint32_t lanes, bool one_tree) {
    const bvh_leaf *a = &hierarchy->leaves[pair->a], *b = &hierarchy->leaves[pair->b];
    if (one_tree) {
        i32x8 shared = {0};
        for (int j = 0; j < 3; j++) {
            i32x8 corner = i32x8_load(b->corners[j]);
            for (int k = 0; k < 3; k++) shared |= i32x8_equal(corner, i32x8_all((int32_t)a->corners[k][i]));
        }
        return lanes & ~i32x8_negative(shared);
    }
    uint32_t kept = lanes;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
        int lane = __builtin_ctz(rest);
        bool shared = false;
        for (int j = 0; j < 9; j++)
            shared |= hierarchy->record_vertices[a->corners[j / 3][i]] ==
                      hierarchy->record_vertices[b->corners[j % 3][lane]];
        kept ^= (uint32_t)shared << lane;
    }
    return kept;
}

static inline void compare_leaves(const traversal *t, traversal_worker *worker, const leaf_pair *pair,
                                  bool skip_adjacent, bool one_tree, bool still, const displacement *d) {
    const bvh *hierarchy = t->bvh;
    const lane_comparison c = {
        .a = hierarchy->leaf_flags[pair->a],
        .b = hierarchy->leaf_flags[pair->b],
        .before_a = hierarchy->flags_before[pair->a],
        .before_b = hierarchy->flags_before[pair->b],
        .self_pairs = hierarchy->leaf_self_pairs != NULL ? hierarchy->leaf_self_pairs[pair->a] : UINT64_MAX,
        .itself = pair->a == pair->b,
        .one_tree = one_tree,
        .leaves = true,
        .pass = t->pass};
    for (uint32_t rows = pair->rows & c.a.used; rows != 0; rows &= rows - 1) {
        int i = __builtin_ctz(rows);
        uint32_t lanes = lanes_to_compare(&c, i) & pair->columns;
        if (lanes == 0) continue;
        worker->boxes_tested += (uint32_t)__builtin_popcount(lanes);
        lanes &= ~apart_at_ends(pair->volumes_a, pair->volumes_b, i, 0, BOX_AXES, still, d);
        if (lanes != 0 && skip_adjacent) {
            uint32_t kept = hierarchy->keeps_hub_pairs
                                ? lanes_without_small_star(hierarchy, pair, i, lanes)
                                : lanes_without_shared_vertex(hierarchy, pair, i, lanes, one_tree);
            worker->adjacent += (uint32_t)__builtin_popcount(lanes & ~kept);
            lanes = kept;
        }
        if (lanes == 0) continue;
        lanes &= ~apart_at_ends(pair->volumes_a, pair->volumes_b, i, BOX_AXES, KDOP_AXES, still, d);
        add_pairs(worker, pair->a * LANES + (uint32_t)i, pair->b * LANES, lanes);
    }
}

/* First the active triangles of a with all of b, then the others with the active ones of b. */
static void compare_active(const traversal *t, traversal_worker *worker, const leaf_pair *pair,
                           bool skip_adjacent, const displacement *d) {
    uint32_t inactive_a = t->bvh->leaf_inactive[pair->a], inactive_b = t->bvh->leaf_inactive[pair->b];
    for (int i = 0; i < 2; i++) {
        leaf_pair part = *pair;
        part.rows &= i == 0 ? ~inactive_a : inactive_a;
        if (i == 1) part.columns &= ~inactive_b;
        if (part.rows == 0 || part.columns == 0) continue;
        if (d == NULL)
            compare_leaves(t, worker, &part, skip_adjacent, true, false, NULL);
        else
            compare_leaves(t, worker, &part, skip_adjacent, false, false, d);
    }
}

/* Where inactive triangles are skipped, or volumes are those of a moment, of which one end is enough. Not inline, so that
 * nothing of it is in the way of other passes. */
static __attribute__((noinline)) void compare_leaves_otherwise(const traversal *t, traversal_worker *worker,
                                                               const leaf_pair *pair, bool skip_adjacent,
                                                               const displacement *d) {
    if (t->skips_inactive)
        compare_active(t, worker, pair, skip_adjacent, d);
    else if (d == NULL)
        compare_leaves(t, worker, pair, skip_adjacent, true, true, NULL);
    else
        compare_leaves(t, worker, pair, skip_adjacent, false, true, d);
}

/* Returns those of the lanes of b whose hub volumes do not overlap that of lane i of a. */
static __attribute__((noinline)) uint32_t lanes_apart_at_hub(const bvh *hierarchy, const hub_volume *a,
                                                             const hub_volume *b, uint32_t lanes) {
    uint32_t apart = 0;
    for (uint32_t rest = a->hub != NO_HUB ? lanes : 0; rest != 0; rest &= rest - 1) {
        int lane = __builtin_ctz(rest);
        apart |= (uint32_t)hub_volumes_apart(a, &b[lane], hierarchy->hub_distance) << lane;
    }
    return apart;
}

/* The same of sliver volumes. */
static __attribute__((noinline)) uint32_t lanes_apart_as_slivers(const bvh *hierarchy, const sliver_volume *a,
                                                                 const sliver_volume *b, uint32_t lanes) {
    uint32_t apart = 0;
    for (uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
        int lane = __builtin_ctz(rest);
        apart |= (uint32_t)sliver_volumes_apart(a, &b[lane], hierarchy->hub_distance) << lane;
    }
    return apart;
}

/* ---- blocks -------------------------------------------------------------------------------------------- */

/* Compares child i of block a with children of block b. */
static inline void visit_children(const traversal *t, traversal_worker *worker, const block_pair *at, int i,
                                  uint32_t lanes, const displacement *d) {
    const bvh *hierarchy = t->bvh;
    const bvh_level *level = &hierarchy->levels[at->level];
    uint32_t child_a = level->first_children[at->a] + (uint32_t)i, first_b = level->first_children[at->b];
    /* Tree b belongs to the same component, or no triangle of it is adjacent to one of tree a. */
    bool skip_adjacent = hierarchy->trees[at->tree_a].skip_adjacent;
    bool otherwise = t->skips_inactive || hierarchy->still;
    size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    for (; lanes != 0; lanes &= lanes - 1) {
        int j = __builtin_ctz(lanes);
        uint32_t child_b = first_b + (uint32_t)j;
        if (at->level > 0) {
            bool trees = at->level == hierarchy->tree_level;
            worker->stack[worker->stack_count++] = (block_pair){
                child_a, child_b, trees ? child_a : at->tree_a, trees ? child_b : at->tree_b, at->level - 1};
            continue;
        }
        leaf_pair pair = {child_a, child_b, NULL, NULL, ALL_LANES, ALL_LANES};
        pair.volumes_a = leaf_volumes_of(hierarchy, &worker->cache, child_a, &hierarchy->trees[at->tree_a]);
        if (child_a % LEAF_CACHE_SIZE == child_b % LEAF_CACHE_SIZE && child_a != child_b) {
            leaf_volumes *copy = (leaf_volumes *)worker->cache.volumes + LEAF_CACHE_SIZE;
            *copy = *pair.volumes_a;
            pair.volumes_a = copy;
        }
        pair.volumes_b = leaf_volumes_of(hierarchy, &worker->cache, child_b, &hierarchy->trees[at->tree_b]);
        if (child_a != child_b) {
            pair.columns = near_lane(pair.volumes_b, level->bounds + at->a * stride, i, d);
            if (pair.columns == 0) continue;
            if (d == NULL) pair.rows = near_lane(pair.volumes_a, level->bounds + at->b * stride, j, NULL);
        }
        if (otherwise)
            compare_leaves_otherwise(t, worker, &pair, skip_adjacent, d);
        else if (d == NULL) /* compiled separately, because it is most of the work */
            compare_leaves(t, worker, &pair, skip_adjacent, true, false, NULL);
        else
            compare_leaves(t, worker, &pair, skip_adjacent, false, false, d);
    }
}

static inline void visit_blocks(const traversal *t, traversal_worker *worker, block_pair at) {
    const bvh *hierarchy = t->bvh;
    const bvh_level *level = &hierarchy->levels[at.level];
    bool below = at.level < hierarchy->tree_level, crosses = below && at.tree_a != at.tree_b;
    displacement between_trees;
    if (crosses)
        between_trees =
            displacement_between(hierarchy, &hierarchy->trees[at.tree_a], &hierarchy->trees[at.tree_b]);
    const displacement *d = crosses ? &between_trees : NULL;
    size_t stride = (size_t)hierarchy->axis_count * 2 * LANES;
    const float *bounds_a = level->bounds + at.a * stride, *bounds_b = level->bounds + at.b * stride;
    const object_set *sets = level->child_sets;
    const hub_volume *hubs = level->child_hubs;
    const sliver_volume *slivers = level->child_slivers;
    bool obstacles = level->obstacle_lanes != NULL && sets == NULL;
    uint32_t obstacles_a = obstacles ? level->obstacle_lanes[at.a] : 0;
    uint32_t inactive_a = t->skips_inactive ? level->inactive_lanes[at.a] : 0;
    bool collapsed = t->collapsed != COLLAPSED_FOUND && !below;
    uint32_t collapsed_a = collapsed ? level->collapsed_lanes[at.a] : 0;
    uint32_t collapsed_b = collapsed ? level->collapsed_lanes[at.b] : 0;
    lane_comparison c = {.a = level->flags[at.a],
                         .b = level->flags[at.b],
                         .self_pairs = level->self_pairs != NULL ? level->self_pairs[at.a] : UINT64_MAX,
                         .obstacles_a = obstacles_a,
                         .obstacles_b = obstacles ? level->obstacle_lanes[at.b] : 0,
                         .inactive_a = inactive_a,
                         .inactive_b = t->skips_inactive ? level->inactive_lanes[at.b] : 0,
                         .collapsed_a = collapsed_a,
                         .collapsed_b = collapsed_b,
                         .resting_a = obstacles_a | inactive_a | collapsed_a,
                         .itself = at.a == at.b,
                         .one_tree = below && !crosses,
                         .pass = t->pass};
    if (t->collapsed == COLLAPSED_LEFT) {
        c.a.used &= (uint8_t)~collapsed_a;
        c.b.used &= (uint8_t)~collapsed_b;
    }
    for (uint32_t rows = c.a.used; rows != 0; rows &= rows - 1) {
        int i = __builtin_ctz(rows);
        uint32_t lanes = lanes_to_compare(&c, i);
        const object_set *set = sets != NULL ? &sets[(size_t)at.a * LANES + (size_t)i] : NULL;
        if (set != NULL) lanes = lanes_looked_at(set, sets + (size_t)at.b * LANES, lanes);
        if (lanes != 0) {
            worker->boxes_tested += (uint32_t)__builtin_popcount(lanes);
            lanes &= ~lanes_apart(bounds_a, bounds_b, i, hierarchy->axis_count, d);
        }
        if (hubs != NULL && lanes != 0)
            lanes &= ~lanes_apart_at_hub(hierarchy, &hubs[(size_t)at.a * LANES + (size_t)i],
                                         hubs + (size_t)at.b * LANES, lanes);
        if (slivers != NULL && lanes != 0)
            lanes &= ~lanes_apart_as_slivers(hierarchy, &slivers[(size_t)at.a * LANES + (size_t)i],
                                             slivers + (size_t)at.b * LANES, lanes);
        if (c.itself) {
            bool own = (c.self_pairs >> (9 * i) & 1) != 0 && ((c.a.plus | c.a.minus) >> i & 1) == 0;
            if (t->pass != TRAVERSAL_KEPT) own = (c.a.newly_kept >> i & 1) != 0;
            if (set != NULL) own = own && object_sets_may_meet(set, set);
            if (own && (c.resting_a >> i & 1) == 0) lanes |= 1u << i;
        }
        if (lanes != 0) visit_children(t, worker, &at, i, lanes, d);
    }
}

void SIMD_NAME(search)(const traversal *t, traversal_worker *worker, size_t visits_max) {
    while (worker->stack_count > 0 && visits_max-- > 0) {
        if (worker->pair_count + TRAVERSAL_PAIRS_PER_VISIT > TRAVERSAL_BATCH_SIZE) return;
        if (worker->stack_count + TRAVERSAL_PUSHES_PER_VISIT > worker->stack_capacity) return;
        visit_blocks(t, worker, worker->stack[--worker->stack_count]);
    }
}

/* ---- the table of the kernels ------------------------------------------------------------------------------ */

const bvh_kernels SIMD_NAME(bvh_kernels) = {
    .copy_in = SIMD_NAME(copy_in),
    .refit = SIMD_NAME(refit),
    .extents_at_start = SIMD_NAME(extents_at_start),
    .orient = SIMD_NAME(orient),
    .orient_lasting = SIMD_NAME(orient_lasting),
    .skin_move = SIMD_NAME(skin_move),
    .skin_signs = SIMD_NAME(skin_signs),
    .near_children = SIMD_NAME(near_children),
    .near_triangles = SIMD_NAME(near_triangles),
    .search = SIMD_NAME(search),
};
