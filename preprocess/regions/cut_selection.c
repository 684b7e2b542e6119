/* Which cuts pay: those after which detector points see more. */
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

/* The component at work, and arrays over the mesh's triangles. */
typedef struct selection {
    const cscd_mesh *mesh;
    const dual_graph *graph;
    const double *positions, *areas;
    const uint32_t *list;
    uint32_t size; /* list: the component's triangles, ascending */
    uint32_t *regions, *pieces, *scratch;
    piece_sums *sums;
    const uint32_t *own; /* cuts of the component, and the what is seen after each */
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

/* What the centroids of the pieces see; false when one piece is smaller than least_area. */
static bool look(const selection *s, uint32_t piece_count, double least_area, sight *out) {
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

/* What each of the component's cuts would let see, and the most of it that is firm; -1: it does not cut, or
 * too little off, or less would be visible. -1, too, when the call is cancelled. */
static double try_cuts(const selection *s, const cut_list *cuts, uint32_t region_count, double least_area,
                       double least_visible) {
    double most = -1.0;
    for (uint32_t i = 0; i < s->own_count; i++) {
        if (!progress_go_on(&s->mesh->context->progress, (double)i / s->own_count)) return -1.0;
        sight *found = &s->found[i];
        uint32_t piece_count = cut_pieces(s, cuts, s->own[i]);
        if (piece_count == region_count || !look(s, piece_count, least_area, found) ||
            found->visible < least_visible)
            found->firm = -1.0;
        most = fmax(most, found->firm);
    }
    return most;
}

/* The cheapest of the cuts that reach least; there is one. */
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
    look(s, 1, 0.0, &seen);
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
static cscd_status group(const cscd_mesh *mesh, const uint32_t *keys, uint32_t count, grouping *out) {
    out->offsets = context_allocate(mesh->context, (size_t)mesh->component_count + 2, sizeof(uint32_t));
    out->items = context_allocate(mesh->context, count, sizeof(uint32_t));
    if (out->offsets == NULL || out->items == NULL) return context_out_of_memory(mesh->context);
    uint32_t *ends = out->offsets + 1; /* of the groups, once all items are in */
    for (uint32_t i = 0; i < count; i++) ends[keys[i] + 1]++;
    for (uint32_t c = 0; c < mesh->component_count; c++) ends[c + 1] += ends[c];
    for (uint32_t i = 0; i < count; i++) out->items[ends[keys[i]]++] = i;
    return CSCD_OK;
}

static void ungroup(const cscd_mesh *mesh, grouping *g) {
    context_free(mesh->context, g->offsets);
    context_free(mesh->context, g->items);
}

static cscd_status group_cuts(const cscd_mesh *mesh, const cut_list *cuts, grouping *out) {
    uint32_t *keys = context_allocate(mesh->context, cuts->count, sizeof *keys);
    if (keys == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t i = 0; i < cuts->count; i++)
        keys[i] = mesh->triangle_components[cuts->triangles[cuts->offsets[i]]];
    cscd_status status = group(mesh, keys, cuts->count, out);
    context_free(mesh->context, keys);
    return status;
}

static cscd_status allocate_selection(selection *s, uint32_t cut_count) {
    cscd_context *context = s->mesh->context;
    uint32_t n = s->mesh->triangle_count;
    s->pieces = context_allocate(context, n, sizeof *s->pieces);
    s->scratch = context_allocate(context, n, sizeof *s->scratch);
    s->sums = context_allocate(context, n, sizeof *s->sums);
    s->found = context_allocate(context, cut_count, sizeof *s->found);
    bool complete = s->pieces && s->scratch && s->sums && s->found;
    return complete ? CSCD_OK : context_out_of_memory(context);
}

cscd_status select_cuts(const cscd_mesh *mesh, const dual_graph *graph, const double *positions,
                        const double *areas, const cut_list *cuts, double gain, double part_share,
                        uint32_t *regions) {
    selection s = {.mesh = mesh, .graph = graph, .positions = positions, .areas = areas, .regions = regions};
    grouping triangles = {NULL, NULL}, own = {NULL, NULL};
    cscd_status status = allocate_selection(&s, cuts->count);
    if (status == CSCD_OK) status = group(mesh, mesh->triangle_components, mesh->triangle_count, &triangles);
    if (status == CSCD_OK) status = group_cuts(mesh, cuts, &own);
    for (uint32_t c = 0; status == CSCD_OK && c < mesh->component_count; c++) {
        s.list = triangles.items + triangles.offsets[c];
        s.size = triangles.offsets[c + 1] - triangles.offsets[c];
        s.own = own.items + own.offsets[c];
        s.own_count = own.offsets[c + 1] - own.offsets[c];
        select_in_component(&s, cuts, gain, part_share);
        status = context_progress_status(mesh->context);
    }
    ungroup(mesh, &triangles);
    ungroup(mesh, &own);
    context_free(mesh->context, s.pieces);
    context_free(mesh->context, s.scratch);
    context_free(mesh->context, s.sums);
    context_free(mesh->context, s.found);
    return status;
}
