/* Selects the cuts that pay: those after which detector points see more. */
#include "preprocess/regions/cut_selection.h"
#include "preprocess/regions/visibility.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* Sums over one piece. */
typedef struct piece_sums {
    double moments[3], area, visible;
} piece_sums;

/* Areas: of all visible triangles, and of those that do not graze the line of sight. */
typedef struct sight {
    double visible, firm;
} sight;

/* Below this sine of the angle between triangle and line of sight (6 degrees) a slight deformation turns the
 * triangle away. */
#define FIRM_SINE 0.1

/* The present component, and arrays over the mesh's triangles. */
typedef struct selection {
    const cscd_mesh *mesh;
    const dual_graph *graph;
    const double *positions, *areas;
    const uint32_t *list;
    uint32_t size; /* list: the component's triangles, ascending */
    uint32_t *regions, *pieces, *scratch;
    piece_sums *sums;
    const uint32_t *own; /* the component's cuts; `found` has what is seen after each */
    uint32_t own_count;
    sight *found;
    double area;
    bool inside_out;
} selection;

/* Adds a triangle's area and moment about the origin. */
static void add_triangle(const selection *s, uint32_t t, piece_sums *sums) {
    double area = s->areas[t];
    sums->area += area;
    for (int k = 0; k < 3; k++) {
        double centre = 0.0;
        for (uint32_t corner = 0; corner < 3; corner++)
            centre += surface_corner(s->mesh, s->positions, t, corner)[k] / 3.0;
        sums->moments[k] += area * centre;
    }
}

/* Finds what the centroids of the pieces see. Returns false when a piece is smaller than least_area. */
static bool find_sight(const selection *s, uint32_t piece_count, double least_area, sight *out) {
    *out = (sight){0.0, 0.0};
    memset(s->sums, 0, piece_count * sizeof *s->sums);
    for (uint32_t i = 0; i < s->size; i++) add_triangle(s, s->list[i], &s->sums[s->pieces[s->list[i]]]);
    for (uint32_t p = 0; p < piece_count; p++) {
        if (s->sums[p].area < least_area) return false;
        for (int k = 0; k < 3; k++) s->sums[p].moments[k] /= s->sums[p].area > 0.0 ? s->sums[p].area : 1.0;
    }
    for (uint32_t i = 0; i < s->size; i++) {
        uint32_t t = s->list[i];
        const double *point = s->sums[s->pieces[t]].moments;
        double value = orientation_value(s->mesh, s->positions, t, point);
        if (s->inside_out ? value >= 0.0 : value <= 0.0) continue;
        out->visible += s->areas[t];
        const double *p0 = surface_corner(s->mesh, s->positions, t, 0);
        double away[3] = {p0[0] - point[0], p0[1] - point[1], p0[2] - point[2]};
        if (fabs(value) >= FIRM_SINE * 2.0 * s->areas[t] * surface_norm(away)) out->firm += s->areas[t];
    }
    return true;
}

/* Numbers the pieces that the regions and one more cut make; returns how many there are. */
static uint32_t cut_pieces(const selection *s, const cut_list *cuts, uint32_t cut) {
    for (uint32_t i = 0; i < s->size; i++) s->pieces[s->list[i]] = s->regions[s->list[i]] * 2;
    for (size_t i = cuts->offsets[cut]; i < cuts->offsets[cut + 1]; i++) s->pieces[cuts->triangles[i]]++;
    return dual_graph_pieces(s->graph, s->list, s->size, s->pieces, s->pieces, s->scratch);
}

static void begin_component(selection *s) {
    double volume = 0.0;
    const double *origin = surface_corner(s->mesh, s->positions, s->list[0], 0);
    s->area = 0.0;
    for (uint32_t i = 0; i < s->size; i++) {
        s->area += s->areas[s->list[i]];
        volume += orientation_value(s->mesh, s->positions, s->list[i], origin);
        s->regions[s->list[i]] = s->pieces[s->list[i]] = 0;
    }
    s->inside_out = volume < 0.0;
}

/* Finds what would be seen after each of the component's cuts, and returns the largest firm area. It is -1
 * for a cut that does not cut, cuts off too little, or makes less visible, and when the call is cancelled. */
static double try_cuts(const selection *s, const cut_list *cuts, uint32_t region_count, double least_area,
                       double least_visible) {
    double most = -1.0;
    for (uint32_t i = 0; i < s->own_count; i++) {
        if (!progress_go_on(&s->mesh->context->progress, (double)i / s->own_count)) return -1.0;
        sight *found = &s->found[i];
        uint32_t piece_count = cut_pieces(s, cuts, s->own[i]);
        if (piece_count == region_count || !find_sight(s, piece_count, least_area, found) ||
            found->visible < least_visible)
            found->firm = -1.0;
        most = fmax(most, found->firm);
    }
    return most;
}

/* Returns the cheapest of the cuts that reach least; there is at least one. */
static uint32_t cheapest_cut(const selection *s, const cut_list *cuts, double least) {
    uint32_t best = UINT32_MAX;
    for (uint32_t i = 0; i < s->own_count; i++) {
        if (s->found[i].firm < least) continue;
        if (best == UINT32_MAX || cuts->costs[s->own[i]] < cuts->costs[s->own[best]]) best = i;
    }
    return best;
}

static void select_in_component(selection *s, const cut_list *cuts, double gain, double part_share) {
    begin_component(s);
    if (s->own_count == 0) return;
    sight seen;
    find_sight(s, 1, 0.0, &seen);
    double step = gain * s->area;
    for (uint32_t region_count = 1;;) {
        double most = try_cuts(s, cuts, region_count, part_share * s->area, gain >= 0.0 ? seen.visible : 0.0);
        if (most < 0.0 || most < seen.firm + step) return;
        uint32_t best = cheapest_cut(s, cuts, fmax(fmax(seen.firm + step, most - fabs(step)), 0.0));
        seen = s->found[best];
        region_count = cut_pieces(s, cuts, s->own[best]);
        for (uint32_t i = 0; i < s->size; i++) s->regions[s->list[i]] = s->pieces[s->list[i]];
    }
}

/* Numbers 0 .. count - 1 by component, ascending in each. */
typedef struct grouping {
    uint32_t *offsets, *items;
} grouping;

/* keys[i] is the component of i. */
static cscd_status group_items(const cscd_mesh *mesh, const uint32_t *keys, uint32_t count, grouping *out) {
    array_list groups = {{ARRAY(out->offsets, (size_t)mesh->component_count + 2), ARRAY(out->items, count)}};
    if (!context_allocate_all(mesh->context, groups)) return context_out_of_memory(mesh->context);
    uint32_t *ends = out->offsets + 1; /* of the groups, once all items are in */
    for (uint32_t i = 0; i < count; i++) ends[keys[i] + 1]++;
    for (uint32_t c = 0; c < mesh->component_count; c++) ends[c + 1] += ends[c];
    for (uint32_t i = 0; i < count; i++) out->items[ends[keys[i]]++] = i;
    return CSCD_OK;
}

static void free_groups(const cscd_mesh *mesh, grouping *g) {
    context_free(mesh->context, g->offsets);
    context_free(mesh->context, g->items);
}

static cscd_status group_cuts(const cscd_mesh *mesh, const cut_list *cuts, grouping *out) {
    uint32_t *keys = context_allocate(mesh->context, cuts->count, sizeof *keys);
    if (keys == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t i = 0; i < cuts->count; i++)
        keys[i] = mesh->triangle_components[cuts->triangles[cuts->offsets[i]]];
    cscd_status status = group_items(mesh, keys, cuts->count, out);
    context_free(mesh->context, keys);
    return status;
}

static array_list list_arrays(selection *s, uint32_t cut_count) {
    uint32_t n = s->mesh->triangle_count;
    return (array_list){
        {ARRAY(s->pieces, n), ARRAY(s->scratch, n), ARRAY(s->sums, n), ARRAY(s->found, cut_count)}};
}

cscd_status select_cuts(const cscd_mesh *mesh, const dual_graph *graph, const double *positions,
                        const double *areas, const cut_list *cuts, double gain, double part_share,
                        uint32_t *regions) {
    selection s = {.mesh = mesh, .graph = graph, .positions = positions, .areas = areas, .regions = regions};
    grouping triangles = {NULL, NULL}, own = {NULL, NULL};
    if (!context_allocate_all(mesh->context, list_arrays(&s, cuts->count)))
        return context_out_of_memory(mesh->context);
    cscd_status status = CSCD_OK;
    if (status == CSCD_OK)
        status = group_items(mesh, mesh->triangle_components, mesh->triangle_count, &triangles);
    if (status == CSCD_OK) status = group_cuts(mesh, cuts, &own);
    for (uint32_t c = 0; status == CSCD_OK && c < mesh->component_count; c++) {
        s.list = triangles.items + triangles.offsets[c];
        s.size = triangles.offsets[c + 1] - triangles.offsets[c];
        s.own = own.items + own.offsets[c];
        s.own_count = own.offsets[c + 1] - own.offsets[c];
        select_in_component(&s, cuts, gain, part_share);
        status = context_progress_status(mesh->context);
    }
    free_groups(mesh, &triangles);
    free_groups(mesh, &own);
    context_free_all(mesh->context, list_arrays(&s, cuts->count));
    return status;
}
