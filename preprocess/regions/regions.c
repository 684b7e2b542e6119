/* Finds the regions of a mesh from its charge, or takes its components. */
#include "preprocess/regions/regions.h"
#include "preprocess/regions/cut_selection.h"
#include "preprocess/regions/equalize.h"
#include "src/mesh/surface.h"

#include <string.h>

region_options region_options_defaults(void) {
    region_options options = {.published = false,
                              .threshold = 0.1,
                              .growing_share = 1.0 / 400.0,
                              .part_share = 0.02,
                              .gain = 0.015};
    return options;
}

/* A weight of 1 for the highest charge, and this much less for the lowest. */
#define CHARGE_FAVOUR 0.85

/* Workspace: arrays over triangles, and the weights of edges. */
typedef struct region_work {
    const cscd_mesh *mesh;
    const double *positions;
    double *areas, *equalized, *weights;
    uint32_t *regions, *list, *scratch;
    dual_graph graph;
    clusters clusters;
    cut_list cuts;
} region_work;

static bool is_share(double value) {
    return value >= 0.0 && value <= 1.0;
}

static cscd_status check_options(cscd_context *context, const region_options *o) {
    if (is_share(o->threshold) && is_share(o->growing_share) && is_share(o->part_share) && o->gain >= -1.0 &&
        o->gain <= 1.0)
        return CSCD_OK;
    return context_fail(
        context, CSCD_INVALID_ARGUMENT,
        "threshold %g, growing_share %g and part_share %g must lie in [0, 1], gain %g in [-1, 1]",
        o->threshold, o->growing_share, o->part_share, o->gain);
}

static array_list list_arrays(region_work *w) {
    size_t n = w->mesh->triangle_count;
    return (array_list){{ARRAY(w->areas, n), ARRAY(w->equalized, n), ARRAY(w->weights, w->mesh->edge_count),
                         ARRAY(w->regions, n), ARRAY(w->list, n), ARRAY(w->scratch, n)}};
}

static void free_work(region_work *w) {
    context_free_all(w->mesh->context, list_arrays(w));
    dual_graph_free(w->mesh, &w->graph);
    clusters_free(w->mesh, &w->clusters);
    cut_list_free(w->mesh, &w->cuts);
}

/* An edge costs its length, and less where the charge is low: cuts run along creases. */
static void weigh_edges(region_work *w) {
    const cscd_mesh *mesh = w->mesh;
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        double charge = 0.0;
        for (uint32_t i = mesh->edge_star_offsets[e]; i < mesh->edge_star_offsets[e + 1]; i++)
            charge += w->equalized[mesh->edge_stars[i]] / edge_star_size(mesh, e);
        w->weights[e] = surface_edge_length(mesh, w->positions, e) * (1.0 - CHARGE_FAVOUR * (1.0 - charge));
    }
}

static cscd_status find_regions(region_work *w, const double *density, const region_options *o) {
    const cscd_mesh *mesh = w->mesh;
    cut_limits limits = {o->growing_share, o->part_share};
    cscd_status status = equalize(mesh, density, o->published, w->equalized);
    if (status == CSCD_OK) status = dual_graph_build(mesh, &w->graph);
    if (status == CSCD_OK) status = clusters_find(mesh, &w->graph, w->equalized, o->threshold, &w->clusters);
    if (status != CSCD_OK) return status;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) w->areas[t] = surface_area(mesh, w->positions, t);
    weigh_edges(w);
    progress_stage(&mesh->context->progress, "cuts", 0.0, 0.5);
    status = cut_list_find(mesh, &w->graph, &w->clusters, w->areas, w->weights, limits, &w->cuts);
    if (status != CSCD_OK) return status;
    progress_stage(&mesh->context->progress, "choice of cuts", 0.5, 1.0);
    return select_cuts(mesh, &w->graph, w->positions, w->areas, &w->cuts, o->gain, o->part_share, w->regions);
}

cscd_status regions_from_charge(const cscd_mesh *mesh, const double *positions, const double *density,
                                const region_options *options, uint32_t *region_of_triangle,
                                uint32_t *region_count) {
    region_options chosen = options != NULL ? *options : region_options_defaults();
    region_work w = {.mesh = mesh, .positions = positions};
    cscd_status status = check_options(mesh->context, &chosen);
    if (status != CSCD_OK) return status;
    if (!context_allocate_all(mesh->context, list_arrays(&w))) return context_out_of_memory(mesh->context);
    status = find_regions(&w, density, &chosen);
    if (status == CSCD_OK) {
        for (uint32_t t = 0; t < mesh->triangle_count; t++) w.list[t] = t;
        *region_count = dual_graph_pieces(&w.graph, w.list, mesh->triangle_count, w.regions,
                                          region_of_triangle, w.scratch);
    }
    free_work(&w);
    return status;
}

cscd_status regions_single(const cscd_mesh *mesh, uint32_t *region_of_triangle, uint32_t *region_count) {
    memcpy(region_of_triangle, mesh->triangle_components, mesh->triangle_count * sizeof *region_of_triangle);
    *region_count = mesh->component_count;
    return CSCD_OK;
}
