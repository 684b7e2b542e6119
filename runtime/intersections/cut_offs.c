/* What traces of curves cut off of open surfaces: docs/theory/curves.md, Lemma 11. */
#include "runtime/intersections/cut_offs.h"

#include "runtime/intersections/trace_sides.h"
#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* A piece of a trace, by its triangle. */
typedef struct trace_piece {
    uint64_t triangle;
    uint64_t piece; /* in the list of all pieces of curves */
} trace_piece;

struct cut_off_finder {
    cscd_context *context;
    trace_links links;
    trace_sides sides;
    /* Per patch the area of its triangles. Of a triangle that curves cut, the patch of the first corner has all. */
    double *patch_areas;
    size_t patch_capacity;
    double *component_areas;
    size_t component_capacity;
    cscd_cut_off *items;
    size_t curve_capacity;
    trace_piece *pieces, *spare_pieces; /* of one trace */
    cut_line *lines;
    cut_border *borders, *spare_borders;
    size_t piece_capacity;
    cut_memory memory;
    uint64_t *sorted, *spare_sorted; /* patches of one side */
    uint32_t *listed;
    size_t listed_count, listed_capacity, item_count;
};

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_patches(cut_off_finder *f, size_t count) {
    return (array_list){
        {ARRAY(f->patch_areas, count), ARRAY(f->sorted, count), ARRAY(f->spare_sorted, count)}};
}

static array_list list_of_components(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->component_areas, count)}};
}

static array_list list_of_curves(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->items, 2 * count)}};
}

static array_list list_of_pieces(cut_off_finder *f, size_t count) {
    return (array_list){{ARRAY(f->pieces, count), ARRAY(f->spare_pieces, count), ARRAY(f->lines, count),
                         ARRAY(f->borders, 2 * count), ARRAY(f->spare_borders, 2 * count)}};
}

static cut_off_finder empty_finder(cscd_context *context) {
    return (cut_off_finder){.context = context, .links = {.context = context}, .sides = {.context = context}};
}

cut_off_finder *cut_off_finder_create(cscd_context *context) {
    cut_off_finder *f = context_allocate(context, 1, sizeof *f);
    if (f != NULL) *f = empty_finder(context);
    return f;
}

void cut_off_finder_clear(cut_off_finder *f) {
    context_free_all(f->context, list_of_patches(f, 0));
    context_free_all(f->context, list_of_components(f, 0));
    context_free_all(f->context, list_of_curves(f, 0));
    context_free_all(f->context, list_of_pieces(f, 0));
    context_free(f->context, f->listed);
    cut_memory_free(f->context, &f->memory);
    trace_links_free(&f->links);
    trace_sides_free(&f->sides);
    *f = empty_finder(f->context);
}

void cut_off_finder_destroy(cut_off_finder *f) {
    if (f == NULL) return;
    cut_off_finder_clear(f);
    context_free(f->context, f);
}

static bool reserve_list(cut_off_finder *f, memory_budget *budget,
                         array_list (*list)(cut_off_finder *, size_t), size_t *capacity, size_t count) {
    return memory_budget_take_all(budget, list(f, room_with_spare(count))) &&
           context_renew_all(f->context, list(f, room_with_spare(count)), capacity, count);
}

/* A trace may have both sides of a curve in one triangle. */
static size_t most_lines(const curve_joiner *j) {
    size_t most = 0;
    for (size_t i = 0; i < j->curve_count; i++) {
        if (2 * j->curves[i].piece_count > most) most = 2 * j->curves[i].piece_count;
    }
    return most;
}

static bool reserve_all(cut_off_finder *f, const surface_cuts *found) {
    const curve_joiner *j = found->curves;
    return cut_memory_begin(&f->memory, found->budget, most_lines(j), 1) &&
           reserve_list(f, found->budget, list_of_patches, &f->patch_capacity, found->patches->patch_count) &&
           reserve_list(f, found->budget, list_of_components, &f->component_capacity,
                        found->surface->mesh->component_count) &&
           reserve_list(f, found->budget, list_of_curves, &f->curve_capacity, j->curve_count) &&
           reserve_list(f, found->budget, list_of_pieces, &f->piece_capacity, 2 * j->piece_count);
}

/* ---- areas --------------------------------------------------------------------------------------------- */

typedef struct cut_off_work {
    cut_off_finder *finder;
    const surface_cuts *found;
    const cscd_mesh *mesh;
    trace_number trace;
    uint32_t component;
} cut_off_work;

static int32_t side_of_corner(const cut_off_work *work, uint32_t triangle, uint32_t corner) {
    const patch_finder *p = work->found->patches;
    return (int32_t)trace_side_of_patch(&work->finder->sides,
                                        p->corner_patches[(size_t)triangle * 3 + corner]);
}

/* Adds the trace's pieces in one side's triangles to the list. */
static size_t list_side(const cut_off_work *work, uint32_t side, size_t count) {
    const curve_joiner *j = work->found->curves;
    const cscd_curve *c = &j->curves[work->trace / 2];
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++)
        work->finder->pieces[count++] = (trace_piece){trace_triangle(&j->pieces[i], side), i};
    return count;
}

static size_t list_pieces(const cut_off_work *work) {
    cut_off_finder *f = work->finder;
    bool both = trace_is_both(&work->found->curves->curves[work->trace / 2]);
    size_t count = list_side(work, work->trace % 2, 0);
    if (both) count = list_side(work, 1, count);
    sort_by_number(f->pieces, f->spare_pieces, count, sizeof *f->pieces);
    return count;
}

static void add_border(const cut_off_work *work, uint32_t triangle, const cscd_curve_point *point,
                       cut_triangle *cut) {
    const cscd_mesh *mesh = work->mesh;
    for (uint32_t i = 0; i < 3; i++) {
        if (mesh->triangle_edges[triangle][i] != point->edge) continue;
        bool along = mesh->edges[point->edge][0] == mesh->triangles[triangle][i];
        cut->borders[cut->border_count++] = (cut_border){i, along ? point->s : 1.0 - point->s, 0, 1};
    }
}

/* The ends of a piece in the triangle; each end on the triangle's border changes the side. */
static void add_line(const cut_off_work *work, loaded_cut *out, size_t piece) {
    const curve_joiner *j = work->found->curves;
    const cscd_curve *c = &j->curves[work->trace / 2];
    size_t at = piece - c->first_piece;
    const cscd_curve_point *points = &j->points[c->first_point];
    const cscd_curve_point *ends[2] = {&points[at], &points[(at + 1) % c->point_count]};
    cut_line line = {.rise = 1};
    loaded_cut_point(out, ends[0]->x, line.from);
    loaded_cut_point(out, ends[1]->x, line.to);
    out->cut.lines[out->cut.line_count++] = line;
    for (int i = 0; i < 2; i++) add_border(work, out->triangle, ends[i], &out->cut);
}

/* The numbers of parts count how often the trace is crossed. */
static void add_odd_part(void *data, const cut_part *part) {
    if (part->numbers[0] % 2 != 0) *(double *)data += cut_part_area(part);
}

/* Divides a triangle that has these pieces of the trace. False: no memory. */
static bool divide_triangle(const cut_off_work *work, const trace_piece *pieces, size_t count,
                            double areas[2]) {
    cut_off_finder *f = work->finder;
    uint32_t triangle = (uint32_t)pieces[0].triangle;
    int32_t numbers[3];
    double normal[3], odd = 0.0;
    surface_normal(work->mesh, work->found->surface->positions, triangle, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return true;
    loaded_cut cut = {.triangle = triangle, .stretch = norm / vec3_largest(normal)};
    for (uint32_t i = 0; i < 3; i++) numbers[i] = side_of_corner(work, triangle, i);
    cut.cut.lines = f->lines;
    cut.cut.borders = f->borders;
    cut.cut.corner_numbers = numbers;
    cut.cut.slot_count = 1;
    loaded_cut_project(work->found->surface, normal, false, &cut);
    for (size_t i = 0; i < count; i++) add_line(work, &cut, (size_t)pieces[i].piece);
    loaded_cut_sort_borders(&cut, f->spare_borders);
    if (!cut_memory_reserve(f->context, &f->memory, count, 1) ||
        !cut_triangle_divide(f->context, &cut.cut, &f->memory, add_odd_part, &odd))
        return false;
    areas[numbers[0]] -= 0.5 * norm;
    areas[1] += cut.stretch * odd;
    areas[0] += 0.5 * norm - cut.stretch * odd;
    return true;
}

/* What the triangles that the trace divides add to both sides, over what load_patches gives. False: no memory. */
static bool divide_triangles(const cut_off_work *work, double areas[2]) {
    cut_off_finder *f = work->finder;
    areas[0] = areas[1] = 0.0;
    size_t count = list_pieces(work);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && f->pieces[end].triangle == f->pieces[begin].triangle) end++;
        if (!divide_triangle(work, f->pieces + begin, end - begin, areas)) return false;
    }
    return true;
}

/* The areas of a side's patches. */
static double sum_side(const cut_off_work *work, uint32_t side) {
    cut_off_finder *f = work->finder;
    double sum = 0.0;
    size_t count = trace_sides_list(&f->sides, side);
    for (size_t i = 0; i < count; i++) {
        uint32_t patch = f->sides.elements[f->sides.list[i]].patch;
        if (patch != UINT32_MAX) sum += f->patch_areas[patch];
    }
    return sum;
}

/* The side with fewer elements is summed up, and the other one too, unless that is the larger one. False: no memory. */
static bool measure_sides(const cut_off_work *work, double areas[2]) {
    cut_off_finder *f = work->finder;
    double whole = f->component_areas[work->component], shifts[2];
    uint32_t known = f->sides.known_side;
    if (!divide_triangles(work, shifts)) return false;
    areas[known] = fmax(sum_side(work, known) + shifts[known], 0.0);
    areas[1 - known] = 2.0 * areas[known] <= whole ? whole - areas[known]
                                                   : fmax(sum_side(work, 1 - known) + shifts[1 - known], 0.0);
    return true;
}

/* ---- all traces ---------------------------------------------------------------------------------------- */

static bool reserve_listed(cut_off_finder *f, size_t more) {
    if (!memory_budget_take(f->memory.budget, more, MEMORY_WHILE_DOUBLING * sizeof *f->listed)) return false;
    if (more <= f->listed_capacity - f->listed_count) return true;
    size_t larger = room_with_spare(f->listed_count + more);
    uint32_t *grown = context_grow(f->context, f->listed, f->listed_count, larger, sizeof *grown);
    if (grown == NULL) return false;
    f->listed = grown;
    f->listed_capacity = larger;
    return true;
}

/* Lists the patches of one side. False: no memory. */
static bool list_patches(const cut_off_work *work, uint32_t side, cscd_cut_off *item) {
    cut_off_finder *f = work->finder;
    size_t elements = trace_sides_list(&f->sides, side), count = 0;
    for (size_t i = 0; i < elements; i++) {
        uint32_t patch = f->sides.elements[f->sides.list[i]].patch;
        if (patch != UINT32_MAX) f->sorted[count++] = patch;
    }
    sort_by_number(f->sorted, f->spare_sorted, count, sizeof *f->sorted);
    if (!reserve_listed(f, count)) return false;
    item->first_patch = f->listed_count;
    item->patch_count = count;
    for (size_t i = 0; i < count; i++) f->listed[f->listed_count++] = (uint32_t)f->sorted[i];
    return true;
}

static bool add_cut_off(const cut_off_work *work) {
    double areas[2];
    if (!measure_sides(work, areas)) return false;
    uint32_t smaller = areas[1] <= areas[0] ? 1 : 0;
    bool both = trace_is_both(&work->found->curves->curves[work->trace / 2]);
    cscd_cut_off item = {.curve = work->trace / 2,
                         .trace = both                   ? CSCD_TRACE_BOTH
                                  : work->trace % 2 == 0 ? CSCD_TRACE_FIRST
                                                         : CSCD_TRACE_SECOND,
                         .component = work->component,
                         .object = work->found->curves->curves[work->trace / 2].objects[work->trace % 2],
                         .area = areas[smaller],
                         .rest = areas[1 - smaller]};
    if (!list_patches(work, smaller, &item)) return false;
    work->finder->items[work->finder->item_count++] = item;
    return true;
}

static void load_areas(const cut_off_work *work) {
    cut_off_finder *f = work->finder;
    const cscd_mesh *mesh = work->mesh;
    const patch_finder *p = work->found->patches;
    memset(f->patch_areas, 0, p->patch_count * sizeof *f->patch_areas);
    memset(f->component_areas, 0, mesh->component_count * sizeof *f->component_areas);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->components[mesh->triangle_components[t]].closed_manifold) continue;
        f->patch_areas[p->corner_patches[(size_t)t * 3]] +=
            surface_area(mesh, work->found->surface->positions, t);
    }
    for (uint32_t i = 0; i < p->patch_count; i++)
        f->component_areas[p->patches[i].component] += f->patch_areas[i];
}

static bool try_trace(cut_off_work *work) {
    const curve_joiner *j = work->found->curves;
    if (!trace_may_divide(work->mesh, j, work->trace)) return true;
    const cscd_curve_piece *piece = &j->pieces[j->curves[work->trace / 2].first_piece];
    work->component = work->mesh->triangle_components[trace_triangle(piece, work->trace % 2)];
    return !trace_sides_find(&work->finder->sides, work->trace, work->component) || add_cut_off(work);
}

cscd_status cut_off_finder_run(cut_off_finder *f, const surface_cuts *found, cscd_cut_offs *out) {
    cut_off_work work = {.finder = f, .found = found, .mesh = found->surface->mesh};
    size_t traces = 2 * found->curves->curve_count;
    f->item_count = f->listed_count = 0;
    if (!trace_links_find(&f->links, found) || !trace_sides_load(&f->sides, found, &f->links) ||
        !reserve_all(f, found))
        return CSCD_OUT_OF_MEMORY;
    load_areas(&work);
    for (size_t i = 0; i < traces; i++) {
        if (!progress_go_on(&f->context->progress, (double)i / (double)traces)) break;
        work.trace = (uint32_t)i;
        if (!try_trace(&work)) return CSCD_OUT_OF_MEMORY;
    }
    *out = (cscd_cut_offs){f->items, f->item_count, f->listed, f->listed_count};
    return context_progress_status(f->context);
}
