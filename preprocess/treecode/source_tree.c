/* Builds the tree of the charged triangles: halves by number, along the longest side of the box of their centroids. */
#include "preprocess/treecode/source_tree.h"

#include <math.h>

/* A centroid, while the order is found. */
typedef struct placed_source {
    double centroid[3];
    uint32_t unknown;
} placed_source;

typedef struct tree_build {
    source_tree *tree;
    const charge_system *system;
    placed_source *placed;
} tree_build;

static array_list list_arrays(source_tree *tree) {
    return (array_list){{ARRAY(tree->nodes, 2 * tree->leaf_count), ARRAY(tree->sources, tree->count),
                         ARRAY(tree->leaves, tree->leaf_count)}};
}

/* ---- its shape, which follows from the number of sources alone ----------------------------------------- */

static uint32_t first_half(uint32_t count) {
    return count - count / 2;
}

static uint32_t leaves_of(uint32_t count) {
    return count <= SOURCES_PER_LEAF ? 1 : leaves_of(first_half(count)) + leaves_of(count / 2);
}

enum { TASK_LEVEL = 7 }; /* 2^7 = TREE_TASKS_MOST */

/* Returns the number of the node that is made, with all below. */
static uint32_t shape_subtree(source_tree *tree, uint32_t begin, uint32_t end, int level) {
    const uint32_t number = tree->node_count++, middle = begin + first_half(end - begin);
    source_node *node = &tree->nodes[number];
    const bool is_leaf = end - begin <= SOURCES_PER_LEAF;
    *node = (source_node){.begin = begin, .end = end, .leaf = tree->leaf_count};
    if (level == TASK_LEVEL || (level < TASK_LEVEL && is_leaf))
        tree->task_nodes[tree->task_count++] = number;
    else if (level < TASK_LEVEL)
        tree->above_nodes[tree->above_count++] = number;
    if (is_leaf) {
        tree->leaves[tree->leaf_count++] = number;
    } else {
        node->children[0] = shape_subtree(tree, begin, middle, level + 1);
        node->children[1] = shape_subtree(tree, middle, end, level + 1);
    }
    return number;
}

/* ---- the order of the sources -------------------------------------------------------------------------- */

static bool comes_before(const placed_source *a, const placed_source *b, int axis) {
    return a->centroid[axis] < b->centroid[axis] ||
           (a->centroid[axis] == b->centroid[axis] && a->unknown < b->unknown);
}

static void swap_placed(placed_source *a, placed_source *b) {
    const placed_source held = *a;
    *a = *b;
    *b = held;
}

/* Moves what comes first into the first `wanted` places, which are not all (Hoare 1961). */
static void select_first(placed_source *items, uint32_t count, uint32_t wanted, int axis) {
    uint32_t first = 0, last = count - 1;
    while (first < last) {
        const placed_source pivot = items[first + (last - first) / 2];
        uint32_t i = first, j = last;
        while (i <= j) {
            while (comes_before(&items[i], &pivot, axis)) i++;
            while (comes_before(&pivot, &items[j], axis)) j--;
            if (i <= j) swap_placed(&items[i++], &items[j--]);
        }
        if (wanted <= j)
            last = j;
        else if (wanted >= i)
            first = i;
        else
            return;
    }
}

static int longest_axis(const placed_source *items, uint32_t count, double center[3]) {
    int longest = 0;
    double sides[3];
    for (int k = 0; k < 3; k++) {
        double low = items[0].centroid[k], high = low;
        for (uint32_t i = 1; i < count; i++) {
            low = fmin(low, items[i].centroid[k]);
            high = fmax(high, items[i].centroid[k]);
        }
        sides[k] = high - low;
        center[k] = low + 0.5 * sides[k];
        longest = sides[k] > sides[longest] ? k : longest;
    }
    return longest;
}

/* Splits a node; its center is that of the box. */
static void split_node(const tree_build *build, source_node *node) {
    placed_source *items = build->placed + node->begin;
    const uint32_t count = node->end - node->begin;
    const int axis = longest_axis(items, count, node->center);
    if (!node_is_leaf(node)) select_first(items, count, first_half(count), axis);
}

static void set_source(const tree_build *build, uint32_t place) {
    const placed_source *placed = &build->placed[place];
    const potential_source *triangle = &build->system->sources[placed->unknown];
    tree_source *source = &build->tree->sources[place];
    double square = 0.0;
    for (int i = 0; i < 3; i++) {
        double distance = 0.0;
        for (int k = 0; k < 3; k++) {
            const double corner = triangle->corners[i][k], next = triangle->corners[(i + 1) % 3][k];
            source->points[i][k] = 0.5 * (corner + next);
            distance += (corner - placed->centroid[k]) * (corner - placed->centroid[k]);
        }
        square = fmax(square, distance);
    }
    for (int k = 0; k < 3; k++) source->centroid[k] = placed->centroid[k];
    source->radius = sqrt(square);
    source->unknown = placed->unknown;
}

/* The smallest balls about the center that hold all centroids, and all triangles. */
static void set_radii(const source_tree *tree, source_node *node) {
    double targets = 0.0, sources = 0.0, lengths = 0.0;
    for (uint32_t i = node->begin; i < node->end; i++) {
        const tree_source *source = &tree->sources[i];
        double square = 0.0;
        for (int k = 0; k < 3; k++)
            square += (source->centroid[k] - node->center[k]) * (source->centroid[k] - node->center[k]);
        const double distance = sqrt(square);
        targets = fmax(targets, distance);
        sources = fmax(sources, distance + source->radius);
        lengths += source->radius;
    }
    node->target_radius = targets;
    node->source_radius = sources;
    node->mean_radius = lengths / (node->end - node->begin);
}

uint32_t subtree_end(const source_tree *tree, uint32_t node) {
    while (!node_is_leaf(&tree->nodes[node])) node = tree->nodes[node].children[1];
    return node + 1;
}

static void build_subtree(void *data, uint32_t task) {
    const tree_build *build = data;
    source_tree *tree = build->tree;
    const uint32_t root = tree->task_nodes[task], end = subtree_end(tree, root);
    if (!progress_go_on(&tree->context->progress, 0.0)) return;
    for (uint32_t n = root; n < end; n++) split_node(build, &tree->nodes[n]);
    for (uint32_t i = tree->nodes[root].begin; i < tree->nodes[root].end; i++) set_source(build, i);
    for (uint32_t n = root; n < end; n++) set_radii(tree, &tree->nodes[n]);
}

static void build_tree(tree_build *build) {
    const source_tree *tree = build->tree;
    for (uint32_t i = 0; i < tree->count; i++)
        build->placed[i] =
            (placed_source){{build->system->x[i], build->system->y[i], build->system->z[i]}, i};
    for (uint32_t i = 0; i < tree->above_count; i++)
        split_node(build, &build->tree->nodes[tree->above_nodes[i]]);
    parallel_run(tree->context->threads, tree->task_count, build_subtree, build);
    for (uint32_t i = 0; i < tree->above_count; i++)
        set_radii(tree, &build->tree->nodes[tree->above_nodes[i]]);
}

cscd_status source_tree_create(cscd_context *context, const charge_system *system, source_tree *out) {
    source_tree tree = {.context = context, .triangles = system->sources, .count = system->count};
    tree.leaf_count = leaves_of(tree.count);
    placed_source *placed = context_reserve(context, tree.count, sizeof *placed);
    if (placed == NULL) return context_out_of_memory(context);
    if (!context_reserve_all(context, list_arrays(&tree))) {
        context_free(context, placed);
        return context_out_of_memory(context);
    }
    tree.leaf_count = 0;
    shape_subtree(&tree, 0, tree.count, 0);
    build_tree(&(tree_build){&tree, system, placed});
    context_free(context, placed);
    *out = tree;
    const cscd_status status = context_progress_status(context);
    if (status != CSCD_OK) source_tree_destroy(out);
    return status;
}

void source_tree_destroy(source_tree *tree) {
    context_free_all(tree->context, list_arrays(tree));
}
