/* Cuts and regions as published (Yeh 2012, section 3.3): clusters of low charge grow, shrink, and cut along a contour. */
#include "preprocess/baselines/published_cuts.h"

#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- equalized densities ------------------------------------------------------------------------------- */

enum { BIN_COUNT = 256 };

/* The densities of one component, counted in bins. */
typedef struct histogram {
    double low, high;
    uint32_t cumulative[BIN_COUNT]; /* triangles in each bin and those below */
} histogram;

/* Halves avoid an overflow of the range; equal densities all go to the first bin. */
static uint32_t bin_of(const histogram *h, double density) {
    const double range = 0.5 * h->high - 0.5 * h->low;
    if (!(range > 0.0)) return 0;
    const uint32_t bin = (uint32_t)((0.5 * density - 0.5 * h->low) / range * BIN_COUNT);
    return bin < BIN_COUNT ? bin : BIN_COUNT - 1;
}

static histogram count_densities(const double *density, const uint32_t *triangles, uint32_t count) {
    histogram h = {.low = INFINITY, .high = -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        h.low = fmin(h.low, density[triangles[i]]);
        h.high = fmax(h.high, density[triangles[i]]);
    }
    for (uint32_t i = 0; i < count; i++) h.cumulative[bin_of(&h, density[triangles[i]])]++;
    for (uint32_t bin = 1; bin < BIN_COUNT; bin++) h.cumulative[bin] += h.cumulative[bin - 1];
    return h;
}

cscd_status published_equalize(const cscd_mesh *mesh, const double *density, double *equalized) {
    cscd_context *context = mesh->context;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!isfinite(density[t]))
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "the charge density of triangle %u is %g; densities must be finite", t,
                                density[t]);
    }
    uint32_t *list, *offsets;
    array_list lists = {
        {ARRAY(list, mesh->triangle_count), ARRAY(offsets, (size_t)mesh->component_count + 1)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    mesh_list_by_component(mesh, list, offsets);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        const uint32_t *triangles = list + offsets[c], count = offsets[c + 1] - offsets[c];
        const histogram h = count_densities(density, triangles, count);
        for (uint32_t i = 0; i < count; i++)
            equalized[triangles[i]] = (double)h.cumulative[bin_of(&h, density[triangles[i]])] / count;
    }
    context_free_all(context, lists);
    return CSCD_OK;
}

/* ---- clusters ------------------------------------------------------------------------------------------ */

/* Appends all marked triangles that can be reached from those at `next` and after it, and takes their marks back. */
static uint32_t collect_cluster(const cscd_mesh *mesh, uint32_t *list, uint32_t next, bool *marked) {
    uint32_t end = next + 1;
    for (; next < end; next++) {
        for (uint32_t k = 0; k < 3; k++) {
            const uint32_t neighbour = triangle_beyond(mesh, list[next], k);
            if (!marked[neighbour]) continue;
            marked[neighbour] = false;
            list[end++] = neighbour;
        }
    }
    return end;
}

static bool may_be_cut(const cscd_mesh *mesh, uint32_t triangle) {
    const uint32_t component = mesh->triangle_components[triangle];
    return mesh->components[component].closed_manifold && !component_is_obstacle(mesh, component);
}

cscd_status clusters_find(const cscd_mesh *mesh, const double *equalized, double threshold, clusters *out) {
    cscd_context *context = mesh->context;
    clusters found = {0};
    bool *marked;
    array_list lists = {{ARRAY(found.offsets, (size_t)mesh->triangle_count + 1),
                         ARRAY(found.triangles, mesh->triangle_count), ARRAY(marked, mesh->triangle_count)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        marked[t] = equalized[t] < threshold && may_be_cut(mesh, t);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!marked[t]) continue;
        const uint32_t first = found.offsets[found.count];
        found.triangles[first] = t;
        marked[t] = false;
        found.offsets[++found.count] = collect_cluster(mesh, found.triangles, first, marked);
    }
    context_free(context, marked);
    *out = found;
    return CSCD_OK;
}

void clusters_free(const cscd_mesh *mesh, clusters *found) {
    context_free(mesh->context, found->offsets);
    context_free(mesh->context, found->triangles);
    *found = (clusters){0};
}

/* ---- contours ------------------------------------------------------------------------------------------ */

/* An edge is listed when it comes in with the contour, and when one of its two triangles is passed over: three times at most. */
static array_list list_contour(contour *c) {
    const size_t edges = c->mesh->edge_count, triangles = c->mesh->triangle_count;
    return (array_list){{ARRAY(c->edges, 3 * edges), ARRAY(c->on, edges), ARRAY(c->passed, triangles),
                         ARRAY(c->crossed, triangles)}};
}

cscd_status contour_create(const cscd_mesh *mesh, contour *out) {
    contour c = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, list_contour(&c))) return context_out_of_memory(mesh->context);
    *out = c;
    return CSCD_OK;
}

void contour_destroy(contour *c) {
    if (c->mesh != NULL) context_free_all(c->mesh->context, list_contour(c));
    *c = (contour){.mesh = NULL};
}

void contour_clear(contour *c) {
    for (uint32_t i = 0; i < c->count; i++) c->on[c->edges[i]] = false;
    c->count = 0;
}

void contour_add(contour *c, uint32_t edge) {
    c->on[edge] = true;
    c->edges[c->count++] = edge;
}

/* Takes the contour over a triangle to its other side. */
static void pass_over(contour *c, uint32_t triangle) {
    for (int k = 0; k < 3; k++) {
        const uint32_t edge = c->mesh->triangle_edges[triangle][k];
        if (c->on[edge])
            c->on[edge] = false;
        else
            contour_add(c, edge);
    }
}

static bool has_two_sides(const contour *c, uint32_t triangle) {
    const uint32_t *edges = c->mesh->triangle_edges[triangle];
    return c->on[edges[0]] + c->on[edges[1]] + c->on[edges[2]] == 2;
}

/* Leaves each edge of the contour in the list once, and no other. */
static void list_once(contour *c) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t edge = c->edges[i];
        if (!c->on[edge]) continue;
        c->on[edge] = false;
        c->edges[kept++] = edge;
    }
    for (uint32_t i = 0; i < kept; i++) c->on[c->edges[i]] = true;
    c->count = kept;
}

void contour_smooth(contour *c) {
    const cscd_mesh *mesh = c->mesh;
    uint32_t crossed = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        const uint32_t edge = c->edges[i];
        for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++) {
            const uint32_t t = mesh->edge_stars[j];
            if (!c->on[edge] || c->passed[t] || !has_two_sides(c, t)) continue;
            c->passed[t] = true;
            c->crossed[crossed++] = t;
            pass_over(c, t);
        }
    }
    for (uint32_t i = 0; i < crossed; i++) c->passed[c->crossed[i]] = false;
    list_once(c);
}

double contour_length(const contour *c, const double *positions) {
    double length = 0.0;
    for (uint32_t i = 0; i < c->count; i++) length += surface_edge_length(c->mesh, positions, c->edges[i]);
    return length;
}

/* ---- cuts ---------------------------------------------------------------------------------------------- */

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

/* ---- the cut of one cluster ---------------------------------------------------------------------------- */

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

/* ---- regions ------------------------------------------------------------------------------------------- */

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
