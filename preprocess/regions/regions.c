/* Finds the regions of a mesh from its charge, or takes its components. */
#include "preprocess/regions/regions.h"
#include "preprocess/regions/body_regions.h"
#include "preprocess/regions/cut_selection.h"
#include "preprocess/regions/edge_weights.h"
#include "preprocess/regions/equalize.h"
#include "preprocess/regions/stiffness.h"
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

/* Workspace: arrays over triangles, and the weights of edges. */
typedef struct region_work {
    const cscd_mesh *mesh;
    const double *positions;
    double *areas, *equalized, *weights, *stiffness; /* stiffness: shares; NULL: as stiff everywhere */
    uint32_t *regions, *list, *scratch, *tile_of;
    bool *marked;
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
                         ARRAY(w->regions, n), ARRAY(w->list, n), ARRAY(w->scratch, n), ARRAY(w->tile_of, n),
                         ARRAY(w->marked, n)}};
}

static void free_work(region_work *w) {
    context_free_all(w->mesh->context, list_arrays(w));
    dual_graph_free(w->mesh, &w->graph);
    clusters_free(w->mesh, &w->clusters);
    cut_list_free(w->mesh, &w->cuts);
    context_free(w->mesh->context, w->stiffness);
}

static cscd_status read_stiffness(region_work *w, const region_options *o) {
    if (o->published || o->stiffness == NULL) return CSCD_OK;
    w->stiffness = context_reserve(w->mesh->context, w->mesh->triangle_count, sizeof *w->stiffness);
    return w->stiffness != NULL ? stiffness_shares(w->mesh, w->positions, o->stiffness, w->stiffness)
                                : context_out_of_memory(w->mesh->context);
}

/* As published: clusters of low charge grow until they part the component. */
static cscd_status find_published(region_work *w, const region_options *o) {
    const cscd_mesh *mesh = w->mesh;
    cut_limits limits = {o->growing_share, o->part_share};
    cscd_status status = clusters_find(mesh, &w->graph, w->equalized, o->threshold, &w->clusters);
    if (status != CSCD_OK) return status;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) w->areas[t] = surface_area(mesh, w->positions, t);
    progress_stage(&mesh->context->progress, "cuts", 0.0, 0.5);
    status = cut_list_find(mesh, &w->graph, &w->clusters, w->areas, w->weights, limits, &w->cuts);
    if (status != CSCD_OK) return status;
    progress_stage(&mesh->context->progress, "choice of cuts", 0.5, 1.0);
    return select_cuts(mesh, &w->graph, w->positions, w->areas, &w->cuts, o->gain, o->part_share, w->regions);
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
    if (found->points != NULL) {
        double *points = context_reserve(mesh->context, count, sizeof(double[3]));
        if (points == NULL) return context_out_of_memory(mesh->context);
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            memcpy(points + (size_t)w->tile_of[t] * 3, found->points[w->regions[t]], sizeof(double[3]));
        *detector_points = points;
    }
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
    status = equalize(mesh, density, chosen.published, w.equalized);
    if (status == CSCD_OK) status = dual_graph_build(mesh, &w.graph);
    if (status == CSCD_OK) status = read_stiffness(&w, &chosen);
    if (status == CSCD_OK) {
        weigh_edges(mesh, positions, w.equalized, w.stiffness, &chosen, w.weights);
        status = chosen.published ? find_published(&w, &chosen) : find_regions(&w, &chosen, &found);
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
