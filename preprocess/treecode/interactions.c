/* Finds the interactions by going down the tree with itself, twice: to count, and to list. */
#include "preprocess/treecode/source_tree.h"

#include "preprocess/treecode/expansion.h"

#include <math.h>

/* The greatest error of an expansion, as a share of the potential. */
static const double FAR_ERROR = 0.01;

/* Points stand for a triangle from this number of its radii on, measured from the target leaf's ball. Their
 * error there is below 1e-3 of its potential, and a hundredth of that over all. */
static const double EXACT_RADII = 3.0;

typedef struct interaction_search {
    const source_tree *tree;
    interactions *lists;
    bool listing; /* or only counting */
} interaction_search;

static array_list list_begins(interactions *lists) {
    return (array_list){{ARRAY(lists->far_begins, lists->node_count + 1),
                         ARRAY(lists->near_begins, 2 * lists->leaf_count + 1),
                         ARRAY(lists->long_begins, lists->node_count + 1)}};
}

static array_list list_items(interactions *lists) {
    return (array_list){{ARRAY(lists->far_items, lists->far_count),
                         ARRAY(lists->near_sources, lists->near_count),
                         ARRAY(lists->long_sources, lists->long_count)}};
}

/* ---- pairs of nodes ------------------------------------------------------------------------------------ */

static double distance_of(const double a[3], const double b[3]) {
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* The least order for balls with this ratio of radii to distance; above EXPANSION_ORDER: none will do. */
static uint32_t order_for(double ratio) {
    if (!(ratio < 1.0)) return EXPANSION_ORDER + 1;
    double error = ratio * (1.0 + ratio) / (1.0 - ratio);
    uint32_t order = 0;
    for (; order <= EXPANSION_ORDER && error > FAR_ERROR; order++) error *= ratio;
    return order;
}

static bool is_exact(const source_node *target, const tree_source *source) {
    return distance_of(target->center, source->centroid) <
           target->target_radius + EXACT_RADII * source->radius;
}

/* Begins of lists are counts first, and then move on to their ends. */
static void add_far(const interaction_search *s, uint32_t target, uint32_t source, uint32_t order) {
    size_t *place = &s->lists->far_begins[target];
    if (s->listing) s->lists->far_items[*place] = order << FAR_NODE_BITS | source;
    ++*place;
}

static void add_near(const interaction_search *s, const source_node *target, const source_node *source) {
    for (uint32_t i = source->begin; i < source->end; i++) {
        const bool exact = is_exact(target, &s->tree->sources[i]);
        size_t *place = &s->lists->near_begins[2 * (size_t)target->leaf + !exact];
        if (s->listing) s->lists->near_sources[*place] = i;
        ++*place;
    }
}

static void add_long(const interaction_search *s, uint32_t target, uint32_t source) {
    size_t *place = &s->lists->long_begins[target];
    if (s->listing) s->lists->long_sources[*place] = source;
    ++*place;
}

/* For long triangles only the centroids have to be apart. Closer ones would have no low rank, and farther
 * ones hardly a lower one. */
static bool centroids_apart(const source_node *a, const source_node *b, double distance) {
    return distance > 1.5 * (a->target_radius + b->target_radius);
}

static bool opens_target(const source_node *a, const source_node *b) {
    const double of_sources = node_is_long(b) ? b->target_radius : b->source_radius;
    return node_is_leaf(b) || (!node_is_leaf(a) && a->target_radius > of_sources);
}

static void search_pair(const interaction_search *s, uint32_t target, uint32_t source) {
    const source_node *a = &s->tree->nodes[target], *b = &s->tree->nodes[source];
    const double distance = distance_of(a->center, b->center), radii = a->target_radius + b->source_radius;
    const uint32_t order = radii < distance ? order_for(radii / distance) : EXPANSION_ORDER + 1;
    if (order <= EXPANSION_ORDER) {
        add_far(s, target, source, order);
    } else if (node_is_long(b) && centroids_apart(a, b, distance)) {
        add_long(s, target, source);
    } else if (node_is_leaf(a) && node_is_leaf(b)) {
        add_near(s, a, b);
    } else if (opens_target(a, b)) {
        for (int i = 0; i < 2; i++) search_pair(s, a->children[i], source);
    } else {
        for (int i = 0; i < 2; i++) search_pair(s, target, b->children[i]);
    }
}

static void search_subtree(void *data, uint32_t task) {
    const interaction_search *s = data;
    if (progress_go_on(&s->tree->context->progress, 0.0)) search_pair(s, s->tree->task_nodes[task], 0);
}

/* ---- lists --------------------------------------------------------------------------------------------- */

/* Turns counts into begins; returns their sum. */
static size_t begin_lists(size_t *counts, size_t list_count) {
    size_t sum = 0;
    for (size_t i = 0; i <= list_count; i++) {
        const size_t count = i < list_count ? counts[i] : 0;
        counts[i] = sum;
        sum += count;
    }
    return sum;
}

/* Turns ends into begins. */
static void end_lists(size_t *ends, size_t list_count) {
    for (size_t i = list_count; i > 0; i--) ends[i] = ends[i - 1];
    ends[0] = 0;
}

/* Sorts the far items of the nodes that a worker gets by order: there are few of each, and mostly in order. */
static void sort_far_items(void *data, uint32_t task) {
    const interactions *lists = data;
    const size_t end = parallel_share(lists->node_count, task + 1, TREE_TASKS_MOST);
    for (size_t n = parallel_share(lists->node_count, task, TREE_TASKS_MOST); n < end; n++) {
        far_item *items = lists->far_items + lists->far_begins[n];
        const size_t count = lists->far_begins[n + 1] - lists->far_begins[n];
        for (size_t i = 1; i < count; i++) {
            const far_item item = items[i];
            size_t place = i;
            for (; place > 0 && items[place - 1] > item; place--) items[place] = items[place - 1];
            items[place] = item;
        }
    }
}

static cscd_status list_interactions(const source_tree *tree, interactions *lists) {
    cscd_context *context = tree->context;
    interaction_search search = {tree, lists, false};
    parallel_run(context->threads, tree->task_count, search_subtree, &search);
    cscd_status status = context_progress_status(context);
    if (status != CSCD_OK) return status;
    lists->far_count = begin_lists(lists->far_begins, lists->node_count);
    lists->near_count = begin_lists(lists->near_begins, 2 * lists->leaf_count);
    lists->long_count = begin_lists(lists->long_begins, lists->node_count);
    if (!context_reserve_all(context, list_items(lists))) return context_out_of_memory(context);
    search.listing = true;
    parallel_run(context->threads, tree->task_count, search_subtree, &search);
    status = context_progress_status(context);
    if (status != CSCD_OK) return status;
    end_lists(lists->far_begins, lists->node_count);
    end_lists(lists->near_begins, 2 * lists->leaf_count);
    end_lists(lists->long_begins, lists->node_count);
    parallel_run(context->threads, TREE_TASKS_MOST, sort_far_items, lists);
    return context_progress_status(context);
}

cscd_status interactions_create(const source_tree *tree, interactions *out) {
    *out = (interactions){
        .context = tree->context, .node_count = tree->node_count, .leaf_count = tree->leaf_count};
    if (!context_allocate_all(tree->context, list_begins(out))) return context_out_of_memory(tree->context);
    const cscd_status status = list_interactions(tree, out);
    if (status != CSCD_OK) interactions_destroy(out);
    return status;
}

void interactions_destroy(interactions *lists) {
    context_free_all(lists->context, list_begins(lists));
    context_free_all(lists->context, list_items(lists));
}
