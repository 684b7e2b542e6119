/* The cuts that a charge suggests: sets of triangles, each to be cut off from the rest of its component. */
#include "preprocess/regions/cut_list.h"
#include "preprocess/regions/cut.h"
#include "preprocess/regions/grow.h"

#include <math.h>
#include <string.h>

typedef struct cut_search {
    const cscd_mesh *mesh;
    const double *areas;
    cut_limits limits;
    uint32_t link_count; /* of the dual graph */
    double *component_areas;
    int64_t *capacities;
    uint32_t *band, *side; /* triangles */
    growth growth;
    cutter cutter;
} cut_search;

/* Weights become integers of up to 2^24, none of them 0, so that sums of them are exact. Links without an
 * edge cost nothing. */
static void set_capacities(cut_search *s, const dual_graph *graph, const double *weights) {
    double largest = 0.0;
    for (uint32_t e = 0; e < s->mesh->edge_count; e++) largest = fmax(largest, weights[e]);
    for (uint32_t i = 0; i < graph->link_count; i++) {
        if (graph->edges[i] == DUAL_NO_EDGE) continue;
        double part = largest > 0.0 ? weights[graph->edges[i]] / largest : 0.0;
        s->capacities[i] = 1 + (int64_t)(part * 0x1p24);
    }
}

static array_list list_arrays(cut_search *s) {
    return (array_list){{ARRAY(s->component_areas, s->mesh->component_count),
                         ARRAY(s->capacities, s->link_count), ARRAY(s->band, s->mesh->triangle_count),
                         ARRAY(s->side, s->mesh->triangle_count)}};
}

static cscd_status prepare_search(cut_search *s, const dual_graph *graph, const double *weights) {
    const cscd_mesh *mesh = s->mesh;
    s->link_count = graph->link_count;
    if (!context_allocate_all(mesh->context, list_arrays(s))) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        s->component_areas[mesh->triangle_components[t]] += s->areas[t];
    set_capacities(s, graph, weights);
    cscd_status status = growth_create(mesh, graph, s->areas, &s->growth);
    return status == CSCD_OK ? cutter_create(mesh, graph, s->capacities, &s->cutter) : status;
}

static void clean_up(cut_search *s) {
    context_free_all(s->mesh->context, list_arrays(s));
    growth_destroy(&s->growth);
    cutter_destroy(&s->cutter);
}

/* Makes room for one more cut of that many triangles. */
static cscd_status reserve_cut(const cscd_mesh *mesh, cut_list *cuts, size_t triangle_count) {
    cscd_context *context = mesh->context;
    if (cuts->offsets == NULL || cuts->count == cuts->capacity) {
        uint32_t capacity = cuts->capacity * 2 + 16;
        size_t used = cuts->offsets != NULL ? (size_t)cuts->count + 1 : 0;
        size_t *offsets = context_grow(context, cuts->offsets, used, (size_t)capacity + 1, sizeof *offsets);
        if (offsets != NULL) cuts->offsets = offsets;
        int64_t *costs = context_grow(context, cuts->costs, cuts->count, capacity, sizeof *costs);
        if (costs != NULL) cuts->costs = costs;
        if (offsets == NULL || costs == NULL) return context_out_of_memory(context);
        cuts->capacity = capacity;
    }
    size_t used = cuts->offsets[cuts->count], needed = used + triangle_count;
    if (needed > cuts->triangle_capacity) {
        size_t capacity = needed + needed / 2;
        uint32_t *triangles = context_grow(context, cuts->triangles, used, capacity, sizeof *triangles);
        if (triangles == NULL) return context_out_of_memory(context);
        cuts->triangles = triangles;
        cuts->triangle_capacity = capacity;
    }
    return CSCD_OK;
}

/* Adds the cut that separates the triangles of a part and those of the band that stay with it. */
static cscd_status add_cut(cut_search *s, uint32_t part, uint32_t side_size, cut_list *cuts) {
    const growth *g = &s->growth;
    cscd_status status = reserve_cut(s->mesh, cuts, (size_t)g->reached_count);
    if (status != CSCD_OK) return status;
    size_t end = cuts->offsets[cuts->count];
    for (uint32_t i = 0; i < g->reached_count; i++) {
        if (g->parts[g->reached[i]] == part) cuts->triangles[end++] = g->reached[i];
    }
    memcpy(cuts->triangles + end, s->side, side_size * sizeof *s->side);
    cuts->costs[cuts->count] = s->cutter.cut.cost;
    cuts->offsets[++cuts->count] = end + side_size;
    return CSCD_OK;
}

static cscd_status add_cuts_of_band(cut_search *s, cut_list *cuts) {
    const growth *g = &s->growth;
    uint32_t band_size = 0;
    for (uint32_t i = 0; i < g->reached_count; i++) {
        if (g->parts[g->reached[i]] == 0) s->band[band_size++] = g->reached[i];
    }
    for (uint32_t part = 1; part <= g->part_count; part++) {
        if (part == g->largest_part) continue;
        uint32_t side_size = cutter_separate(&s->cutter, g->parts, s->band, band_size, part, s->side);
        cscd_status status = add_cut(s, part, side_size, cuts);
        if (status != CSCD_OK) return status;
    }
    return CSCD_OK;
}

static cscd_status find_all(cut_search *s, const clusters *found, cut_list *cuts) {
    cscd_context *context = s->mesh->context;
    for (uint32_t i = 0; i < found->count; i++) {
        if (!progress_go_on(&context->progress, (double)i / found->count))
            return context_progress_status(context);
        const uint32_t *cluster = found->triangles + found->offsets[i];
        uint32_t size = found->offsets[i + 1] - found->offsets[i];
        uint32_t component = s->mesh->triangle_components[cluster[0]];
        bool may_grow = size > s->limits.growing_share * s->mesh->components[component].triangle_count;
        double relevant_area = s->limits.part_share * s->component_areas[component];
        if (!growth_separates(&s->growth, cluster, size, may_grow, relevant_area)) continue;
        cscd_status status = add_cuts_of_band(s, cuts);
        if (status != CSCD_OK) return status;
    }
    return CSCD_OK;
}

cscd_status cut_list_find(const cscd_mesh *mesh, const dual_graph *graph, const clusters *found,
                          const double *areas, const double *weights, cut_limits limits, cut_list *out) {
    cut_search s = {.mesh = mesh, .areas = areas, .limits = limits};
    cut_list cuts = {0};
    cscd_status status = prepare_search(&s, graph, weights);
    if (status == CSCD_OK) status = reserve_cut(mesh, &cuts, 0);
    if (status == CSCD_OK) status = find_all(&s, found, &cuts);
    clean_up(&s);
    if (status == CSCD_OK)
        *out = cuts;
    else
        cut_list_free(mesh, &cuts);
    return status;
}

void cut_list_free(const cscd_mesh *mesh, cut_list *cuts) {
    context_free(mesh->context, cuts->offsets);
    context_free(mesh->context, cuts->costs);
    context_free(mesh->context, cuts->triangles);
    *cuts = (cut_list){0};
}
