/* The pairs of wires and points that may touch: pairs with triangles, by the trees of these, and with each
 * other; and every pair, the reference. */
#include "runtime/loose/loose.h"

#include "src/core/floating.h"

/* A thread takes this number of elements at a time, which are neighbours in space. */
enum { ELEMENTS_AT_ONCE = 64 };

/* ---- a box in a tree's frame --------------------------------------------------------------------------- */

/* The box of an element at both ends, in the frame of a tree, rounded outward and widened by its half of the
 * distance. */
typedef struct framed_box {
    float low[2][3], high[2][3];
} framed_box;

/* In doubles the coordinates are off by 2^-51 of themselves, which the floats' 2^-23 cover. */
static framed_box box_in_frame(const swept_interval *interval, const loose_element *element,
                               const bvh_tree *tree) {
    const double *ends[2] = {interval->x0, interval->x1};
    double scale = interval->bvh->scale, reach = loose_reach(interval, element->object) * scale;
    framed_box box;
    for (int e = 0; e < 2; e++) {
        const double *a = ends[e] + (size_t)interval->mesh->edges[element->edge][0] * 3;
        const double *b = ends[e] + (size_t)interval->mesh->edges[element->edge][1] * 3;
        for (int k = 0; k < 3; k++) {
            double x = (a[k] - tree->origin[e][k]) * scale, y = (b[k] - tree->origin[e][k]) * scale;
            box.low[e][k] = float_below(fmin(x, y) - reach);
            box.high[e][k] = float_above(fmax(x, y) + reach);
        }
    }
    return box;
}

/* The children of a block whose bounds overlap the box during the interval. In bounds without a value nothing is sure. */
static uint32_t children_near(const bvh *hierarchy, int level, uint32_t block, const framed_box *box) {
    const float *bounds =
        hierarchy->levels[level].bounds + (size_t)block * (size_t)hierarchy->axis_count * 2 * LANES;
    uint32_t apart[LANES] = {0}, near = 0;
    for (int k = 0; k < BOX_AXES; k++) {
        float low = fminf(box->low[0][k], box->low[1][k]), high = fmaxf(box->high[0][k], box->high[1][k]);
        const float *lows = bounds + 2 * k * LANES, *highs = lows + LANES;
        for (int lane = 0; lane < LANES; lane++) apart[lane] |= (lows[lane] > high) | (highs[lane] < low);
    }
    for (int lane = 0; lane < LANES; lane++) near |= (uint32_t)(apart[lane] == 0) << lane;
    return near & hierarchy->levels[level].flags[block].used;
}

/* ---- triangles ----------------------------------------------------------------------------------------- */

/* An element on its way through the trees. */
typedef struct tree_walk {
    const swept_interval *interval;
    const loose_element *element;
    const bvh_tree *tree;
    framed_box box; /* in the frame of the tree */
    bool inactive;  /* the element is, and inactive triangles do not count */
    contact_worker *worker;
} tree_walk;

static uint32_t children_that_count(const tree_walk *w, int level, uint32_t block, const framed_box *box) {
    const bvh *hierarchy = w->interval->bvh;
    uint32_t near = children_near(hierarchy, level, block, box);
    return w->inactive ? near & ~(uint32_t)hierarchy->levels[level].inactive_lanes[block] : near;
}

/* The slack of a tree covers the rounding of its records and the triangles' half of the distance. */
static bool triangle_parted(const tree_walk *w, const bvh_leaf *leaf, int lane) {
    const float(*records)[8] = (const float(*)[8])w->interval->bvh->records;
    for (int k = 0; k < 3; k++) {
        int before = 0, behind = 0;
        for (int e = 0; e < 2; e++) {
            float a = records[leaf->corners[0][lane]][4 * e + k],
                  b = records[leaf->corners[1][lane]][4 * e + k];
            float c = records[leaf->corners[2][lane]][4 * e + k];
            before += w->box.high[e][k] < fminf(fminf(a, b), c) - w->tree->slack[0];
            behind += w->box.low[e][k] > fmaxf(fmaxf(a, b), c) + w->tree->slack[0];
        }
        if (before == 2 || behind == 2) return true;
    }
    return false;
}

static void test_leaf(const tree_walk *w, uint32_t index) {
    const bvh *hierarchy = w->interval->bvh;
    const bvh_leaf *leaf = &hierarchy->leaves[index];
    for (uint32_t used = hierarchy->leaf_flags[index].used, lane = 0; (used >> lane & 1) != 0; lane++) {
        uint32_t triangle = leaf->triangles[lane];
        if (w->inactive && (hierarchy->leaf_inactive[index] >> lane & 1) != 0) continue;
        if (triangle_parted(w, leaf, (int)lane)) continue;
        loose_pairs_with_triangle(w->interval, w->element, triangle, w->worker);
    }
}

typedef struct open_block {
    int level;
    uint32_t block;
} open_block;

/* Each block takes one place and leaves eight, and there are no more levels than this. */
enum { STACK_SIZE = BVH_LEVEL_MAX * LANES };

static void walk_tree(tree_walk *w) {
    const bvh *hierarchy = w->interval->bvh;
    open_block stack[STACK_SIZE];
    int count = 0, top = hierarchy->tree_level - 1;
    w->box = box_in_frame(w->interval, w->element, w->tree);
    stack[count++] = (open_block){top, w->tree->first_blocks[top]};
    while (count > 0) {
        open_block at = stack[--count];
        uint32_t first = hierarchy->levels[at.level].first_children[at.block];
        for (uint32_t near = children_that_count(w, at.level, at.block, &w->box); near != 0;
             near &= near - 1) {
            uint32_t child = first + (uint32_t)__builtin_ctz(near);
            if (at.level == 0)
                test_leaf(w, child);
            else
                stack[count++] = (open_block){at.level - 1, child};
        }
    }
}

static void test_tree(tree_walk *w, uint32_t tree) {
    w->tree = &w->interval->bvh->trees[tree];
    if (pair_filter_admits_objects(&w->interval->filter, w->element->object, w->tree->object)) walk_tree(w);
}

/* Above the trees bounds are in the frame of the first one; if it is the only one, there are none. */
static void test_trees(const swept_interval *interval, const loose_element *element, contact_worker *worker) {
    const bvh *hierarchy = interval->bvh;
    tree_walk w = {.interval = interval, .element = element, .worker = worker};
    w.inactive = interval->filter.active != NULL &&
                 !edge_is_active(interval->filter.active, interval->mesh, element->edge);
    if (hierarchy->tree_count <= 1) {
        if (hierarchy->tree_count == 1) test_tree(&w, 0);
        return;
    }
    framed_box box = box_in_frame(interval, element, &hierarchy->trees[0]);
    open_block stack[STACK_SIZE];
    int count = 0;
    stack[count++] = (open_block){hierarchy->level_count - 1, 0};
    while (count > 0) {
        open_block at = stack[--count];
        uint32_t first = hierarchy->levels[at.level].first_children[at.block];
        for (uint32_t near = children_that_count(&w, at.level, at.block, &box); near != 0; near &= near - 1) {
            uint32_t child = first + (uint32_t)__builtin_ctz(near);
            if (at.level == hierarchy->tree_level)
                test_tree(&w, child);
            else
                stack[count++] = (open_block){at.level - 1, child};
        }
    }
}

/* ---- each other ---------------------------------------------------------------------------------------- */

static bool boxes_overlap(const swept_box *a, const swept_box *b) {
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

static const loose_element *element_at(const loose_elements *e, uint32_t place) {
    return &e->items[e->order[place].element];
}

/* Can the node have a pair with the element? */
static bool node_counts(const loose_search *s, uint32_t place, int level, uint32_t node) {
    const loose_level *own = &s->elements->levels[0], *at = &s->elements->levels[level];
    if (!boxes_overlap(&own->boxes[place], &at->boxes[node])) return false;
    if (s->interval->filter.active != NULL && !own->active[place] && !at->active[node]) return false;
    return s->interval->filter.rules == NULL || object_sets_may_meet(&own->sets[place], &at->sets[node]);
}

/* Compares an element with all that come after it in the tree. */
static void test_elements(const loose_search *s, uint32_t place, contact_worker *worker) {
    const loose_elements *e = s->elements;
    open_block stack[LOOSE_LEVEL_MAX * LOOSE_NODE_CHILDREN];
    int count = 0;
    stack[count++] = (open_block){e->level_count - 1, 0};
    while (count > 0) {
        open_block at = stack[--count];
        uint32_t last = (uint32_t)((((uint64_t)at.block + 1) << (3 * at.level)) - 1);
        if (last <= place || !node_counts(s, place, at.level, at.block)) continue;
        if (at.level == 0) {
            loose_pairs_of_elements(s->interval, element_at(e, place), element_at(e, at.block), worker);
            continue;
        }
        uint32_t begin = at.block * LOOSE_NODE_CHILDREN, rest = e->levels[at.level - 1].count - begin;
        for (uint32_t i = 0; i < LOOSE_NODE_CHILDREN && i < rest; i++)
            stack[count++] = (open_block){at.level - 1, begin + i};
    }
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

/* Do points have distances to keep? Wires meet each other without. */
static bool elements_meet(const swept_interval *interval, const loose_element *element) {
    return !edge_is_point(interval->mesh, element->edge) || interval->limit.distance > 0.0 || interval->thick;
}

void loose_search_test(const loose_search *s, uint32_t worker_index, contact_worker *worker) {
    const swept_interval *interval = s->interval;
    uint32_t count = s->elements->count, stride = s->worker_count * ELEMENTS_AT_ONCE;
    for (uint64_t begin = (uint64_t)worker_index * ELEMENTS_AT_ONCE + worker->cursor * stride; begin < count;
         begin += stride) {
        if (worker->out_of_memory ||
            !progress_go_on(&interval->mesh->context->progress, (double)begin / count))
            break;
        for (uint64_t i = begin; i < count && i < begin + ELEMENTS_AT_ONCE; i++) {
            const loose_element *element = element_at(s->elements, (uint32_t)i);
            test_trees(interval, element, worker);
            if (elements_meet(interval, element)) test_elements(s, (uint32_t)i, worker);
        }
        if (contact_worker_suspend(worker, worker->cursor + 1)) return;
    }
}

static void test_edges(const swept_interval *interval, uint32_t a, uint32_t b, contact_worker *worker) {
    if (loose_edges_meet(interval, a, b)) narrow_phase_test_ee(interval, a, b, worker);
}

void loose_search_test_pair(const swept_interval *interval, cscd_contact_kind kind, uint32_t a, uint32_t b,
                            contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    if (kind == CSCD_CONTACT_VF) narrow_phase_test_vf(interval, a, b, worker);
    if (kind == CSCD_CONTACT_EE) narrow_phase_test_ee(interval, a, b, worker);
    if (kind == CSCD_CONTACT_EV) test_edges(interval, a, mesh_edge_of_point(mesh, b), worker);
    if (kind == CSCD_CONTACT_VV)
        test_edges(interval, mesh_edge_of_point(mesh, a), mesh_edge_of_point(mesh, b), worker);
    if (kind == CSCD_CONTACT_VH) half_spaces_test_vertex(interval, a, b, worker);
}

/* ---- every pair, without boxes ------------------------------------------------------------------------- */

static void test_vf(const swept_interval *interval, uint32_t vertex, uint32_t triangle,
                    contact_worker *worker) {
    if (!pair_filter_admits_features(&interval->filter, CSCD_CONTACT_VF, vertex, triangle)) return;
    swept_box a = swept_box_of(interval, &vertex, 1),
              b = swept_box_of(interval, interval->mesh->triangles[triangle], 3);
    worker->feature_pairs++;
    if (swept_boxes_within(&a, &b, pair_reach(interval, CSCD_CONTACT_VF, vertex, triangle)))
        narrow_phase_test_vf(interval, vertex, triangle, worker);
}

static void test_ee(const swept_interval *interval, uint32_t a, uint32_t b, contact_worker *worker) {
    if (!loose_edges_meet(interval, a, b) ||
        !pair_filter_admits_features(&interval->filter, CSCD_CONTACT_EE, a, b))
        return;
    swept_box box_a = swept_box_of(interval, interval->mesh->edges[a], 2),
              box_b = swept_box_of(interval, interval->mesh->edges[b], 2);
    worker->feature_pairs++;
    if (swept_boxes_within(&box_a, &box_b, pair_reach(interval, CSCD_CONTACT_EE, a, b)))
        narrow_phase_test_ee(interval, a, b, worker);
}

static uint32_t object_of_triangle(const cscd_mesh *mesh, uint32_t triangle) {
    return cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
}

static void test_triangles(const swept_interval *interval, const loose_element *element,
                           contact_worker *worker) {
    const cscd_mesh *mesh = interval->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!pair_filter_admits_objects(&interval->filter, element->object, object_of_triangle(mesh, t)))
            continue;
        for (int i = 0; i < 2; i++) {
            if ((element->ends >> i & 1) != 0) test_vf(interval, mesh->edges[element->edge][i], t, worker);
        }
    }
}

/* Edges of triangles, and then the elements that come later. */
static void test_all_edges(const loose_search *s, uint32_t index, contact_worker *worker) {
    const cscd_mesh *mesh = s->interval->mesh;
    const loose_element *element = &s->elements->items[index];
    for (uint32_t e = 0; !edge_is_point(mesh, element->edge) && e < mesh->edge_count; e++) {
        uint32_t object = cscd_mesh_vertex_object(mesh, mesh->edges[e][0]);
        if (!edge_is_loose(mesh, e) &&
            pair_filter_admits_objects(&s->interval->filter, element->object, object))
            test_ee(s->interval, element->edge, e, worker);
    }
    for (uint32_t i = index + 1; i < s->elements->count; i++) {
        const loose_element *other = &s->elements->items[i];
        if (pair_filter_admits_objects(&s->interval->filter, element->object, other->object) &&
            !edges_share_vertex(mesh->edges[element->edge], mesh->edges[other->edge]))
            test_ee(s->interval, element->edge, other->edge, worker);
    }
}

void loose_search_test_all(const loose_search *s, uint32_t worker_index, contact_worker *worker) {
    cscd_context *context = s->interval->mesh->context;
    for (uint32_t i = worker_index + (uint32_t)worker->cursor * s->worker_count;
         i < s->elements->count && !worker->out_of_memory; i += s->worker_count) {
        if (!progress_go_on(&context->progress, (double)i / s->elements->count)) break;
        test_triangles(s->interval, &s->elements->items[i], worker);
        test_all_edges(s, i, worker);
        if (contact_worker_suspend(worker, worker->cursor + 1)) return;
    }
}
