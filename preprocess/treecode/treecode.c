/* Evaluates the potential: moments up the tree, coefficients down, and what is near. */
#include "preprocess/treecode/source_tree.h"

#include <string.h>

static array_list list_expansions(treecode *t) {
    const size_t count = (size_t)t->tree.node_count * HARMONIC_COUNT;
    return (array_list){{ARRAY(t->moments, count), ARRAY(t->coefficients, count),
                         ARRAY(t->exact_begins, (size_t)t->tree.leaf_count + 1)}};
}

/* ---- potentials of sources that are near --------------------------------------------------------------- */

static uint32_t vectors_of(const source_node *leaf) {
    return (leaf->end - leaf->begin + LANES - 1) / LANES;
}

static size_t exact_sources_of(const treecode *t, uint32_t leaf) {
    return t->lists.near_begins[2 * (size_t)leaf + 1] - t->lists.near_begins[2 * (size_t)leaf];
}

static void begin_exact(treecode *t) {
    size_t count = 0;
    for (uint32_t l = 0; l < t->tree.leaf_count; l++) {
        t->exact_begins[l] = count;
        count += exact_sources_of(t, l) * vectors_of(&t->tree.nodes[t->tree.leaves[l]]) * LANES;
    }
    t->exact_begins[t->tree.leaf_count] = t->exact_count = count;
}

/* The place of target i in a leaf's vectors; those that fill up the last repeat the last target. */
static const double *target_of(const source_tree *tree, const source_node *leaf, uint32_t i) {
    const uint32_t last = leaf->end - leaf->begin - 1;
    return tree->sources[leaf->begin + (i < last ? i : last)].centroid;
}

static void find_exact(void *data, uint32_t l) {
    const treecode *t = data;
    const source_node *leaf = &t->tree.nodes[t->tree.leaves[l]];
    const uint32_t target_count = vectors_of(leaf) * LANES;
    const uint32_t *sources = t->lists.near_sources + t->lists.near_begins[2 * (size_t)l];
    float *out = t->exact_potentials + t->exact_begins[l];
    double x[SOURCES_PER_LEAF], y[SOURCES_PER_LEAF], z[SOURCES_PER_LEAF], potentials[SOURCES_PER_LEAF];
    if (!progress_go_on(&t->context->progress, (double)l / t->tree.leaf_count)) return;
    for (uint32_t i = 0; i < target_count; i++) {
        const double *p = target_of(&t->tree, leaf, i);
        x[i] = p[0];
        y[i] = p[1];
        z[i] = p[2];
    }
    for (size_t s = 0; s < exact_sources_of(t, l); s++) {
        const potential_source *triangle = triangle_of(&t->tree, sources[s]);
        potential_at(triangle, x, y, z, target_count, potentials);
        for (uint32_t i = 0; i < target_count; i++) *out++ = (float)(potentials[i] / triangle->area);
    }
}

/* ---- setup --------------------------------------------------------------------------------------------- */

static cscd_status list_sources(treecode *t, const charge_system *system) {
    cscd_status status = source_tree_create(t->context, system, &t->tree);
    if (status == CSCD_OK) status = interactions_create(&t->tree, &t->lists);
    if (status != CSCD_OK) return status;
    if (!context_reserve_all(t->context, list_expansions(t))) return context_out_of_memory(t->context);
    begin_exact(t);
    return CSCD_OK;
}

cscd_status treecode_create(cscd_context *context, const charge_system *system, treecode *out) {
    *out = (treecode){.context = context, .kernels = KERNELS_OF(context, treecode_kernels)};
    out->tree.context = out->lists.context = context;
    expansion_tables_set(&out->tables);
    const cscd_status status = list_sources(out, system);
    if (status != CSCD_OK) treecode_destroy(out);
    return status;
}

double treecode_bytes(const treecode *t) {
    const double of_leaf = sizeof *t->tree.leaves + sizeof *t->exact_begins + 2 * sizeof(size_t),
                 of_node = sizeof *t->tree.nodes + 2 * sizeof(size_t) + 2 * HARMONIC_COUNT * sizeof(double);
    return (double)t->exact_count * sizeof *t->exact_potentials +
           (double)t->lists.near_count * sizeof *t->lists.near_sources +
           (double)t->lists.far_count * sizeof *t->lists.far_items +
           (double)t->lists.long_count * sizeof *t->lists.long_sources +
           (t->ranks.context != NULL ? rank_blocks_bytes(&t->ranks)
                                     : rank_blocks_expected_bytes(&t->tree, &t->lists)) +
           of_node * t->tree.node_count + of_leaf * t->tree.leaf_count +
           (double)t->tree.count * sizeof *t->tree.sources;
}

cscd_status treecode_fill(treecode *t) {
    t->exact_potentials = context_reserve(t->context, t->exact_count, sizeof *t->exact_potentials);
    if (t->exact_potentials == NULL) return context_out_of_memory(t->context);
    parallel_run(t->context->threads, t->tree.leaf_count, find_exact, t);
    const cscd_status status = context_progress_status(t->context);
    return status == CSCD_OK ? rank_blocks_create(&t->tree, &t->lists, &t->ranks) : status;
}

void treecode_destroy(treecode *t) {
    rank_blocks_destroy(&t->ranks);
    source_tree_destroy(&t->tree);
    interactions_destroy(&t->lists);
    context_free_all(t->context, list_expansions(t));
    context_free(t->context, t->exact_potentials);
    t->exact_potentials = NULL;
}

/* ---- evaluation ---------------------------------------------------------------------------------------- */

typedef struct evaluation {
    treecode *t;
    const double *charges;
    double *potentials;
} evaluation;

static double *expansion_of(double *expansions, uint32_t node) {
    return expansions + (size_t)node * HARMONIC_COUNT;
}

static void subtract_points(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* From the charges of a leaf, or from the moments of the children. */
static void find_moments(const evaluation *e, uint32_t number) {
    treecode *t = e->t;
    const source_node *node = &t->tree.nodes[number];
    double full[FULL_COUNT] = {0.0}, place[3];
    if (node_is_leaf(node)) {
        for (uint32_t i = node->begin; i < node->end; i++) {
            for (int p = 0; p < SOURCE_POINTS; p++) {
                subtract_points(t->tree.sources[i].points[p], node->center, place);
                expansion_add_charge(&t->tables, place, e->charges[i] / SOURCE_POINTS, full);
            }
        }
    } else {
        for (int c = 0; c < 2; c++) {
            const uint32_t child = node->children[c];
            subtract_points(t->tree.nodes[child].center, node->center, place);
            expansion_add_moments(&t->tables, place, expansion_of(t->moments, child), full);
        }
    }
    expansion_fold(&t->tables, full, expansion_of(t->moments, number));
}

static void find_moments_below(void *data, uint32_t task) {
    const evaluation *e = data;
    const uint32_t root = e->t->tree.task_nodes[task];
    for (uint32_t n = subtree_end(&e->t->tree, root); n > root; n--) find_moments(e, n - 1);
}

static void evaluate_near(const evaluation *e, const source_node *leaf, double potentials[SOURCES_PER_LEAF]) {
    const treecode *t = e->t;
    const size_t *begins = t->lists.near_begins + 2 * (size_t)leaf->leaf;
    near_field field = {.vector_count = vectors_of(leaf),
                        .center = leaf->center,
                        .sources = t->tree.sources,
                        .charges = e->charges,
                        .exact = t->lists.near_sources + begins[0],
                        .points = t->lists.near_sources + begins[1],
                        .exact_count = begins[1] - begins[0],
                        .point_count = begins[2] - begins[1],
                        .potentials = t->exact_potentials + t->exact_begins[leaf->leaf]};
    for (uint32_t i = 0; i < field.vector_count * LANES; i++) {
        double place[3];
        subtract_points(target_of(&t->tree, leaf, i), leaf->center, place);
        field.x[i] = (float)place[0];
        field.y[i] = (float)place[1];
        field.z[i] = (float)place[2];
    }
    t->kernels->near_potential(&field, potentials);
}

static void evaluate_leaf(const evaluation *e, const source_node *leaf, const double *coefficients) {
    double full[FULL_COUNT], near[SOURCES_PER_LEAF], place[3];
    expansion_unfold(&e->t->tables, coefficients, full);
    evaluate_near(e, leaf, near);
    for (uint32_t i = leaf->begin; i < leaf->end; i++) {
        subtract_points(e->t->tree.sources[i].centroid, leaf->center, place);
        e->potentials[i] = near[i - leaf->begin] + expansion_potential(&e->t->tables, place, full);
    }
}

/* The node's coefficients hold those of the nodes above. */
static void evaluate_node(const evaluation *e, uint32_t number) {
    treecode *t = e->t;
    const source_node *node = &t->tree.nodes[number];
    const size_t begin = t->lists.far_begins[number];
    const far_field field = {&t->tables, t->tree.nodes, t->moments, t->lists.far_items + begin,
                             t->lists.far_begins[number + 1] - begin};
    double *coefficients = expansion_of(t->coefficients, number), place[3];
    t->kernels->add_far_field(&field, node->center, coefficients);
    if (node_is_leaf(node)) {
        evaluate_leaf(e, node, coefficients);
        return;
    }
    for (int c = 0; c < 2; c++) {
        double *shifted = expansion_of(t->coefficients, node->children[c]);
        memset(shifted, 0, HARMONIC_COUNT * sizeof *shifted);
        subtract_points(t->tree.nodes[node->children[c]].center, node->center, place);
        expansion_add_coefficients(&t->tables, place, coefficients, shifted);
    }
}

static void evaluate_below(void *data, uint32_t task) {
    const evaluation *e = data;
    const uint32_t root = e->t->tree.task_nodes[task], end = subtree_end(&e->t->tree, root);
    memset(expansion_of(e->t->coefficients, root), 0, HARMONIC_COUNT * sizeof(double));
    for (uint32_t n = root; n < end && progress_go_on(&e->t->context->progress, 0.0); n++)
        evaluate_node(e, n);
    rank_blocks_add(&e->t->tree, &e->t->ranks, task, e->charges, e->potentials);
}

cscd_status treecode_evaluate(treecode *t, const double *charges, double *potentials) {
    evaluation e = {t, charges, potentials};
    const source_tree *tree = &t->tree;
    parallel_run(t->context->threads, tree->task_count, find_moments_below, &e);
    cscd_status status = context_progress_status(t->context);
    if (status != CSCD_OK) return status;
    for (uint32_t i = tree->above_count; i > 0; i--) find_moments(&e, tree->above_nodes[i - 1]);
    parallel_run(t->context->threads, tree->task_count, evaluate_below, &e);
    return context_progress_status(t->context);
}
