/* Finds the regions of a mesh from its charge, or takes its components. */
#include "preprocess/regions/labelling.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- ranks of charge ----------------------------------------------------------------------------------- */

typedef struct ranked {
    uint32_t component, triangle;
    double density;
} ranked;

/* Independent of the range, unlike a conversion to float. */
static double round_to_24_bits(double value) {
    int exponent;
    double mantissa = frexp(value, &exponent);
    return ldexp(nearbyint(ldexp(mantissa, 24)), exponent - 24);
}

/* The sort is stable and the items come by triangle, so ties stay in that order. */
static int compare_ranked(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->component != y->component) return x->component < y->component ? -1 : 1;
    return (x->density > y->density) - (x->density < y->density);
}

static void rank_exactly(const ranked *items, uint32_t count, double *equalized) {
    for (uint32_t i = 0; i < count; i++) equalized[items[i].triangle] = (i + 1.0) / count;
}

cscd_status equalize(const cscd_mesh *mesh, const double *density, double *equalized) {
    cscd_context *context = mesh->context;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!isfinite(density[t]))
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "the charge density of triangle %u is %g; densities must be finite", t,
                                density[t]);
    }
    ranked *items, *scratch;
    array_list lists = {{ARRAY(items, mesh->triangle_count), ARRAY(scratch, mesh->triangle_count)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        items[t] = (ranked){mesh->triangle_components[t], t, round_to_24_bits(density[t])};
    sort_items(items, scratch, mesh->triangle_count, sizeof *items, compare_ranked);
    const ranked *first = items;
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        uint32_t count = mesh->components[c].triangle_count;
        rank_exactly(first, count, equalized);
        first += count;
    }
    context_free_all(context, lists);
    return CSCD_OK;
}

/* ---- weights of edges ---------------------------------------------------------------------------------- */

/* An edge costs its length where the charge is high, and this share of it where the charge is lowest. The cost falls from three times
 * the threshold on: cuts run along creases, and elsewhere they are short. */
static const double crease = 0.1, crease_ranks = 3.0;

/* Returns the mean of the ranks of the triangles at an edge. */
static double rank_beside(const cscd_mesh *mesh, const double *ranks, uint32_t edge) {
    double sum = 0.0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        sum += ranks[mesh->edge_stars[i]] / edge_star_size(mesh, edge);
    return sum;
}

void weigh_edges(const cscd_mesh *mesh, const double *positions, const double *equalized,
                 const double *stiffness_shares, const region_options *options, double *weights) {
    const double high = fmin(1.0, crease_ranks * options->threshold);
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const double rank = fmin(1.0, rank_beside(mesh, equalized, e) / high);
        double share = 1.0 - (1.0 - crease) * (1.0 - rank);
        if (stiffness_shares != NULL)
            share = fmin(share, fmax(crease, stiffness_beside(mesh, stiffness_shares, e)));
        weights[e] = surface_edge_length(mesh, positions, e) * share;
    }
}

/* ---- regions ------------------------------------------------------------------------------------------- */

region_options region_options_defaults(void) {
    return (region_options){.threshold = 0.1};
}

/* Workspace: arrays over triangles, and the weights of edges. */
typedef struct region_work {
    const cscd_mesh *mesh;
    const double *positions;
    double *equalized, *weights, *stiffness; /* stiffness: shares; NULL: as stiff everywhere */
    uint32_t *regions, *list, *scratch, *tile_of;
    bool *marked;
    dual_graph graph;
} region_work;

static cscd_status check_options(cscd_context *context, const region_options *o) {
    if (o->threshold >= 0.0 && o->threshold <= 1.0) return CSCD_OK;
    return context_fail(context, CSCD_INVALID_ARGUMENT, "threshold %g must lie in [0, 1]", o->threshold);
}

static array_list list_arrays(region_work *w) {
    size_t n = w->mesh->triangle_count;
    return (array_list){{ARRAY(w->equalized, n), ARRAY(w->weights, w->mesh->edge_count), ARRAY(w->regions, n),
                         ARRAY(w->list, n), ARRAY(w->scratch, n), ARRAY(w->tile_of, n), ARRAY(w->marked, n)}};
}

static void free_work(region_work *w) {
    context_free_all(w->mesh->context, list_arrays(w));
    dual_graph_free(w->mesh, &w->graph);
    context_free(w->mesh->context, w->stiffness);
}

static cscd_status read_stiffness(region_work *w, const region_options *o) {
    if (o->stiffness == NULL) return CSCD_OK;
    w->stiffness = context_reserve(w->mesh->context, w->mesh->triangle_count, sizeof *w->stiffness);
    return w->stiffness != NULL ? stiffness_shares(w->mesh, w->positions, o->stiffness, w->stiffness)
                                : context_out_of_memory(w->mesh->context);
}

static cscd_status add_components(region_work *w, const region_options *o, const uint32_t *offsets,
                                  body_regions *found) {
    const cscd_mesh *mesh = w->mesh;
    const tile_surface surface = {mesh,      w->positions,   w->weights,  &w->graph,
                                  o->frames, o->frame_count, w->stiffness};
    const body_room room = {w->tile_of, w->scratch, w->marked};
    cscd_status status = CSCD_OK;
    for (uint32_t c = 0; c < mesh->component_count && status == CSCD_OK; c++) {
        const uint32_t *list = w->list + offsets[c], count = offsets[c + 1] - offsets[c];
        if (count == 0) continue;
        progress_stage(&mesh->context->progress, "cuts", (double)offsets[c] / mesh->triangle_count,
                       (double)offsets[c + 1] / mesh->triangle_count);
        status = component_is_obstacle(mesh, c) ? body_regions_add_whole(found, &surface, list, count)
                                                : body_regions_add(found, &surface, list, count, &room);
    }
    return status;
}

static cscd_status find_regions(region_work *w, const region_options *o, body_regions *found) {
    cscd_context *context = w->mesh->context;
    uint32_t *offsets = context_allocate(context, (size_t)w->mesh->component_count + 1, sizeof *offsets);
    if (offsets == NULL) return context_out_of_memory(context);
    mesh_list_by_component(w->mesh, w->list, offsets);
    const cscd_status status = add_components(w, o, offsets, found);
    context_free(context, offsets);
    return status;
}

/* Numbers the regions by their first triangles. */
static cscd_status number_regions(region_work *w, const body_regions *found, uint32_t *region_of_triangle,
                                  uint32_t *region_count, double **detector_points) {
    const cscd_mesh *mesh = w->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) w->list[t] = t;
    const uint32_t count =
        dual_graph_pieces(&w->graph, w->list, mesh->triangle_count, w->regions, w->tile_of, w->scratch);
    double *points = context_reserve(mesh->context, count, sizeof(double[3]));
    if (points == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        memcpy(points + (size_t)w->tile_of[t] * 3, found->points[w->regions[t]], sizeof(double[3]));
    *detector_points = points;
    memcpy(region_of_triangle, w->tile_of, mesh->triangle_count * sizeof *region_of_triangle);
    *region_count = count;
    return CSCD_OK;
}

cscd_status regions_from_charge(const cscd_mesh *mesh, const double *positions, const double *density,
                                const region_options *options, uint32_t *region_of_triangle,
                                uint32_t *region_count, double **detector_points) {
    region_options chosen = options != NULL ? *options : region_options_defaults();
    region_work w = {.mesh = mesh, .positions = positions};
    cscd_status status = check_options(mesh->context, &chosen);
    if (status != CSCD_OK) return status;
    if (!context_allocate_all(mesh->context, list_arrays(&w))) return context_out_of_memory(mesh->context);
    body_regions found = {.of_triangle = w.regions};
    status = equalize(mesh, density, w.equalized);
    if (status == CSCD_OK) status = dual_graph_build(mesh, &w.graph);
    if (status == CSCD_OK) status = read_stiffness(&w, &chosen);
    if (status == CSCD_OK) {
        weigh_edges(mesh, positions, w.equalized, w.stiffness, &chosen, w.weights);
        status = find_regions(&w, &chosen, &found);
    }
    if (status == CSCD_OK)
        status = number_regions(&w, &found, region_of_triangle, region_count, detector_points);
    context_free(mesh->context, found.points);
    free_work(&w);
    return status;
}

cscd_status regions_single(const cscd_mesh *mesh, uint32_t *region_of_triangle, uint32_t *region_count) {
    memcpy(region_of_triangle, mesh->triangle_components, mesh->triangle_count * sizeof *region_of_triangle);
    *region_count = mesh->component_count;
    return CSCD_OK;
}
