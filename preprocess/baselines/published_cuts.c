/* Cuts and regions as published (Yeh 2012, section 3.3): clusters of low charge grow, shrink, and cut along a contour. */
#include "preprocess/baselines/published_cuts.h"

#include "preprocess/baselines/clusters.h"
#include "preprocess/baselines/contour_smoothing.h"
#include "preprocess/baselines/cutting_list.h"

#include <string.h>

typedef struct cut_search {
    const cscd_mesh *mesh;
    const double *positions;
    published_thresholds thresholds;
    published_trace trace;
    clusters clusters;
    cutting_list list;
    contour contour;
    bool *cut;       /* per edge: regions end here */
    uint32_t *stack; /* triangles */
} cut_search;

static array_list list_arrays(cut_search *s) {
    return (array_list){{ARRAY(s->cut, s->mesh->edge_count), ARRAY(s->stack, s->mesh->triangle_count)}};
}

static cscd_status prepare_search(cut_search *s, const double *equalized) {
    if (!context_allocate_all(s->mesh->context, list_arrays(s)))
        return context_out_of_memory(s->mesh->context);
    cscd_status status = clusters_find(s->mesh, equalized, s->thresholds.cluster, &s->clusters);
    if (status == CSCD_OK) status = cutting_list_create(s->mesh, &s->list);
    return status == CSCD_OK ? contour_create(s->mesh, &s->contour) : status;
}

static void clean_up(cut_search *s) {
    context_free_all(s->mesh->context, list_arrays(s));
    clusters_free(s->mesh, &s->clusters);
    cutting_list_destroy(&s->list);
    contour_destroy(&s->contour);
}

/* ---- the cut of one cluster ------------------------------------------------------------------------------ */

/* Does the cluster part its component, by itself or grown? Then the cutting list has the contours between which it does. */
static bool find_contours(cut_search *s, const uint32_t *cluster, uint32_t size) {
    const uint32_t component = s->mesh->triangle_components[cluster[0]];
    const double few = s->thresholds.growing * s->mesh->components[component].triangle_count;
    cutting_list_begin(&s->list, cluster, size);
    cutting_list_fill(&s->list, (uint32_t)few);
    cutting_list_trace(&s->list);
    if (s->list.contour_count >= 2) return true;
    if (!(size > few) || !cutting_list_grow(&s->list)) return false;
    cutting_list_fill(&s->list, (uint32_t)few);
    cutting_list_trace(&s->list);
    return s->list.contour_count >= 2;
}

/* Takes the sides of the cutting triangles that are on this contour, and smooths it. Returns its length. */
static double smooth_contour(cut_search *s, uint32_t number) {
    const cutting_list *list = &s->list;
    contour_clear(&s->contour);
    for (uint32_t i = 0; i < list->count; i++) {
        const uint32_t t = list->triangles[i];
        for (int k = 0; k < 3; k++) {
            if (list->side_contours[t][k] == number) contour_add(&s->contour, s->mesh->triangle_edges[t][k]);
        }
    }
    contour_smooth(&s->contour);
    for (uint32_t i = 0; s->trace.contours != NULL && i < s->contour.count; i++)
        s->trace.contours[s->contour.edges[i]] = true;
    return contour_length(&s->contour, s->positions);
}

/* Cuts along every contour but the longest: of two, along the shorter one. */
static void cut_along_contours(cut_search *s) {
    const uint32_t count = s->list.contour_count;
    uint32_t longest = 0;
    double most = -1.0;
    for (uint32_t i = 0; i < count; i++) {
        const double length = smooth_contour(s, i);
        if (length > most) {
            most = length;
            longest = i;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (i == longest) continue;
        smooth_contour(s, i);
        for (uint32_t j = 0; j < s->contour.count; j++) s->cut[s->contour.edges[j]] = true;
    }
}

static void cut_at_cluster(cut_search *s, const uint32_t *cluster, uint32_t size) {
    if (!find_contours(s, cluster, size)) return;
    cutting_list_shrink(&s->list);
    for (uint32_t i = 0; s->trace.cutting != NULL && i < s->list.count; i++)
        s->trace.cutting[s->list.triangles[i]] = true;
    cut_along_contours(s);
}

static cscd_status cut_at_clusters(cut_search *s) {
    cscd_context *context = s->mesh->context;
    for (uint32_t i = 0; i < s->clusters.count; i++) {
        const uint32_t first = s->clusters.offsets[i], size = s->clusters.offsets[i + 1] - first;
        if (!progress_go_on(&context->progress, (double)i / s->clusters.count))
            return context_progress_status(context);
        for (uint32_t j = first; s->trace.clusters != NULL && j < first + size; j++)
            s->trace.clusters[s->clusters.triangles[j]] = i;
        cut_at_cluster(s, s->clusters.triangles + first, size);
    }
    return CSCD_OK;
}

/* ---- regions --------------------------------------------------------------------------------------------- */

/* Gives a region to all triangles that are connected with the first one, across edges that are not cut. */
static void fill_region(cut_search *s, uint32_t first, uint32_t region, uint32_t *regions) {
    const cscd_mesh *mesh = s->mesh;
    uint32_t depth = 0;
    regions[first] = region;
    s->stack[depth++] = first;
    while (depth > 0) {
        const uint32_t t = s->stack[--depth];
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t next = triangle_beyond(mesh, t, k);
            if (s->cut[mesh->triangle_edges[t][k]] || regions[next] != UINT32_MAX) continue;
            regions[next] = region;
            s->stack[depth++] = next;
        }
    }
}

/* A component that is not closed is one region, that of its first triangle. */
static cscd_status number_regions(cut_search *s, uint32_t *regions, uint32_t *region_count) {
    const cscd_mesh *mesh = s->mesh;
    uint32_t count = 0, *whole = context_allocate(mesh->context, mesh->component_count, sizeof *whole);
    if (whole == NULL) return context_out_of_memory(mesh->context);
    memset(whole, 0xff, mesh->component_count * sizeof *whole);
    memset(regions, 0xff, mesh->triangle_count * sizeof *regions);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t component = mesh->triangle_components[t];
        if (regions[t] != UINT32_MAX) continue;
        if (mesh->components[component].closed_manifold) {
            fill_region(s, t, count++, regions);
            continue;
        }
        if (whole[component] == UINT32_MAX) whole[component] = count++;
        regions[t] = whole[component];
    }
    context_free(mesh->context, whole);
    *region_count = count;
    return CSCD_OK;
}

cscd_status published_cuts(const cscd_mesh *mesh, const double *positions, const double *equalized,
                           published_thresholds thresholds, const published_trace *trace,
                           uint32_t *region_of_triangle, uint32_t *region_count) {
    cut_search s = {.mesh = mesh, .positions = positions, .thresholds = thresholds};
    if (trace != NULL) s.trace = *trace;
    for (uint32_t t = 0; s.trace.clusters != NULL && t < mesh->triangle_count; t++)
        s.trace.clusters[t] = UINT32_MAX;
    progress_stage(&mesh->context->progress, "cuts", 0.0, 1.0);
    cscd_status status = prepare_search(&s, equalized);
    if (status == CSCD_OK) status = cut_at_clusters(&s);
    if (status == CSCD_OK) status = number_regions(&s, region_of_triangle, region_count);
    clean_up(&s);
    return status;
}
