/* What curves cut out of each triangle: from the pieces of all curves to the lines in one triangle's plane. */
#include "runtime/intersections/triangle_cuts.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_keys(triangle_cuts *c, size_t count) {
    return (array_list){{ARRAY(c->keys, count), ARRAY(c->spare_keys, count)}};
}

static array_list list_of_cuts(triangle_cuts *c, size_t count) {
    return (array_list){{ARRAY(c->lines, count), ARRAY(c->borders, count), ARRAY(c->spare_borders, count),
                         ARRAY(c->corner_numbers, 3 * count), ARRAY(c->slot_bodies, count),
                         ARRAY(c->line_pieces, count)}};
}

void triangle_cuts_free(triangle_cuts *c) {
    if (c->context == NULL) return;
    context_free_all(c->context, list_of_keys(c, 0));
    context_free_all(c->context, list_of_cuts(c, 0));
    cut_memory_free(c->context, &c->memory);
    *c = (triangle_cuts){.context = c->context};
}

/* ---- triangles ----------------------------------------------------------------------------------------- */

static size_t most_pieces(const triangle_cuts *c) {
    size_t most = 0;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (end - begin > most) most = end - begin;
    }
    return most;
}

/* As reserve_cut, for any triangle. */
static bool take_budget(triangle_cuts *c, const surface_cuts *found, size_t pieces) {
    size_t slots = 1 + pieces + 3 * (size_t)found->surface->mesh->object_count;
    size_t most = 2 * pieces > slots ? 2 * pieces : slots;
    return memory_budget_take_all(found->budget, list_of_cuts(c, room_with_spare(most))) &&
           cut_memory_begin(&c->memory, found->budget, pieces, slots);
}

bool triangle_cuts_sort(triangle_cuts *c, const surface_cuts *found) {
    const curve_joiner *curves = found->curves;
    size_t count = 2 * curves->piece_count;
    if (!memory_budget_take_all(found->budget, list_of_keys(c, room_with_spare(count)))) return false;
    if (!context_renew_all(c->context, list_of_keys(c, room_with_spare(count)), &c->key_capacity, count))
        return false;
    for (size_t i = 0; i < count; i++)
        c->keys[i] = (curve_key){i % 2 == 0 ? curves->found[i / 2].a : curves->found[i / 2].b, i};
    sort_by_number(c->keys, c->spare_keys, count, sizeof *c->keys);
    c->key_count = count;
    return take_budget(c, found, most_pieces(c));
}

/* The first key that is not below a number. */
static size_t find_key(const triangle_cuts *c, uint64_t number) {
    size_t low = 0, high = c->key_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (c->keys[middle].number < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

size_t triangle_cuts_of(const triangle_cuts *c, uint32_t triangle, size_t *first) {
    size_t end = *first = find_key(c, triangle);
    while (end < c->key_count && c->keys[end].number == triangle) end++;
    return end;
}

/* ---- loading ------------------------------------------------------------------------------------------- */

typedef struct cut_load {
    triangle_cuts *cuts;
    const surface_cuts *found;
    loaded_cut *out;
} cut_load;

/* The slot of a body, which gets one if it has none. They are few. */
static uint32_t slot_of(cut_load *load, uint32_t body) {
    cut_triangle *cut = &load->out->cut;
    uint32_t *bodies = load->cuts->slot_bodies, slot = 0;
    while (slot < cut->slot_count && bodies[slot] != body) slot++;
    if (slot == cut->slot_count) bodies[cut->slot_count++] = body;
    return slot;
}

void loaded_cut_point(const loaded_cut *cut, const double x[3], double out[2]) {
    out[0] = x[cut->x];
    out[1] = cut->turn * x[cut->y];
}

cut_lift cut_lift_of(const named_surface *s, const loaded_cut *cut) {
    cut_lift lift = {.cut = cut};
    surface_normal(s->mesh, s->positions, cut->triangle, lift.normal);
    memcpy(lift.corner, surface_corner(s->mesh, s->positions, cut->triangle, 0), sizeof lift.corner);
    return lift;
}

static void lift_point(const cut_lift *lift, double x, double y, double out[3]) {
    int of_x = lift->cut->x, of_y = lift->cut->y, rest = 3 - of_x - of_y;
    const double *n = lift->normal, *p = lift->corner;
    out[of_x] = x;
    out[of_y] = lift->cut->turn * y;
    out[rest] = p[rest] - (n[of_x] * (x - p[of_x]) + n[of_y] * (out[of_y] - p[of_y])) / n[rest];
}

void cut_lift_part(const cut_lift *lift, const cut_part *part, double a[3][3], double b[3][3]) {
    double(*const halves[2])[3] = {a, b};
    for (int i = 0; i < 2; i++) {
        lift_point(lift, part->x[0], part->low[0], halves[i][0]);
        lift_point(lift, part->x[1], part->high[1], halves[i][1]);
    }
    lift_point(lift, part->x[1], part->low[1], a[2]);
    lift_point(lift, part->x[0], part->high[0], b[2]);
}

/* Adds an end of a piece that is on the triangle's own border. An edge of a that passes towards the side of b's normal, and
 * so out of b, begins the piece, one that passes into b ends it; for edges of b, and where the other component is turned
 * around, it is the other way round. So the number changes at the end of a piece as across it. */
static void add_border(cut_load *load, size_t number, int end, const cut_line *line) {
    const cscd_mesh *mesh = load->found->surface->mesh;
    const curve_joiner *j = load->found->curves;
    uint32_t triangle = load->out->triangle;
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t edge = mesh->triangle_edges[triangle][i];
        if (j->found[number].ends[end].edge != edge) continue;
        double s = j->points[j->end_points[2 * number + (size_t)end]].s;
        bool along = mesh->edges[edge][0] == mesh->triangles[triangle][i];
        load->out->cut.borders[load->out->cut.border_count++] =
            (cut_border){i, along ? s : 1.0 - s, line->slot, end == 1 ? line->rise : -line->rise};
    }
}

static int compare_borders(const void *a, const void *b) {
    const cut_border *p = a, *q = b;
    if (p->edge != q->edge) return p->edge < q->edge ? -1 : 1;
    return (p->s > q->s) - (p->s < q->s);
}

void loaded_cut_sort_borders(loaded_cut *cut, cut_border *spare) {
    sort_items(cut->cut.borders, spare, cut->cut.border_count, sizeof *spare, compare_borders);
}

/* Seen from the side of the normal, the inside of b is to the left of a piece on a, and the inside of a to the right of it on
 * b, unless the other component is turned around. Open components have no inside. */
static void add_piece(cut_load *load, const curve_key *key) {
    const cscd_mesh *mesh = load->found->surface->mesh;
    const curve_joiner *j = load->found->curves;
    cut_triangle *cut = &load->out->cut;
    size_t number = (size_t)(key->end / 2);
    bool is_b = key->end % 2 == 1;
    uint32_t other = is_b ? j->found[number].a : j->found[number].b;
    if (!mesh->components[mesh->triangle_components[other]].closed_manifold) return;
    cut_line line = {.slot = slot_of(load, surface_body(load->found->surface, other)),
                     .rise = (is_b ? -1 : 1) * surface_sense(load->found->surface, other),
                     .number = (uint32_t)cut->line_count};
    loaded_cut_point(load->out, j->points[j->end_points[2 * number]].x, line.from);
    loaded_cut_point(load->out, j->points[j->end_points[2 * number + 1]].x, line.to);
    load->cuts->line_pieces[cut->line_count] = (uint32_t)number;
    cut->lines[cut->line_count++] = line;
    for (int end = 0; end < 2; end++) add_border(load, number, end, &line);
}

static const cscd_patch *patch_at(const cut_load *load, uint32_t corner) {
    const patch_finder *p = load->found->patches;
    return &p->patches[p->corner_patches[(size_t)load->out->triangle * 3 + corner]];
}

/* All bodies that wind around a corner get slots first, then each corner its numbers. */
static void number_corners(cut_load *load) {
    const cscd_winding *windings = load->found->patches->windings;
    cut_triangle *cut = &load->out->cut;
    for (uint32_t i = 0; i < 3; i++) {
        const cscd_patch *patch = patch_at(load, i);
        for (uint32_t k = 0; k < patch->winding_count; k++)
            slot_of(load, windings[patch->first_winding + k].body);
    }
    memset(cut->corner_numbers, 0, 3 * (size_t)cut->slot_count * sizeof *cut->corner_numbers);
    for (uint32_t i = 0; i < 3; i++) {
        const cscd_patch *patch = patch_at(load, i);
        for (uint32_t k = 0; k < patch->winding_count; k++) {
            cscd_winding w = windings[patch->first_winding + k];
            cut->corner_numbers[(size_t)i * cut->slot_count + slot_of(load, w.body)] = w.number;
        }
    }
}

/* Makes room for as many lines, borders and slots as there can be. */
static bool reserve_cut(cut_load *load, size_t pieces) {
    triangle_cuts *c = load->cuts;
    size_t slots = 1 + pieces;
    for (uint32_t i = 0; i < 3; i++) slots += patch_at(load, i)->winding_count;
    size_t most = 2 * pieces > slots ? 2 * pieces : slots;
    if (most > c->cut_capacity &&
        !context_renew_all(c->context, list_of_cuts(c, room_with_spare(most)), &c->cut_capacity, most))
        return false;
    return cut_memory_reserve(c->context, &c->memory, pieces, slots);
}

/* How far the pieces of some keys reach along a coordinate, all together, in units of the triangle. */
static double sum_reaches(const cut_load *load, size_t first, size_t end, int k) {
    const named_surface *s = load->found->surface;
    const curve_joiner *j = load->found->curves;
    double low = (double)INFINITY, high = -(double)INFINITY, sum = 0.0;
    for (uint32_t i = 0; i < 3; i++) {
        double x = surface_corner(s->mesh, s->positions, load->out->triangle, i)[k];
        low = fmin(low, x);
        high = fmax(high, x);
    }
    for (size_t i = first; i < end; i++) {
        size_t piece = (size_t)(load->cuts->keys[i].end / 2);
        sum += fabs(j->points[j->end_points[2 * piece]].x[k] - j->points[j->end_points[2 * piece + 1]].x[k]);
    }
    return sum / (high - low);
}

void loaded_cut_project(const named_surface *s, const double normal[3], bool exchanged, loaded_cut *out) {
    int axis = 0;
    for (int k = 1; k < 3; k++) axis = fabs(normal[k]) > fabs(normal[axis]) ? k : axis;
    out->x = (axis + (exchanged ? 2 : 1)) % 3;
    out->y = (axis + (exchanged ? 1 : 2)) % 3;
    out->turn = (normal[axis] > 0.0) != exchanged ? 1.0 : -1.0;
    for (uint32_t i = 0; i < 3; i++)
        loaded_cut_point(out, surface_corner(s->mesh, s->positions, out->triangle, i), out->cut.corners[i]);
}

static void choose_projection(const cut_load *load, const double normal[3], size_t first, size_t end) {
    loaded_cut *out = load->out;
    loaded_cut_project(load->found->surface, normal, false, out);
    if (sum_reaches(load, first, end, out->y) < sum_reaches(load, first, end, out->x))
        loaded_cut_project(load->found->surface, normal, true, out);
}

bool triangle_cuts_load(triangle_cuts *c, const surface_cuts *found, size_t first, size_t end,
                        loaded_cut *out) {
    const cscd_mesh *mesh = found->surface->mesh;
    cut_load load = {c, found, out};
    double normal[3];
    *out = (loaded_cut){.triangle = (uint32_t)c->keys[first].number};
    surface_normal(mesh, found->surface->positions, out->triangle, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return true;
    if (!reserve_cut(&load, end - first)) return false;
    out->stretch = norm / vec3_largest(normal);
    out->cut.lines = c->lines;
    out->cut.borders = c->borders;
    out->cut.corner_numbers = c->corner_numbers;
    out->slot_bodies = c->slot_bodies;
    out->line_pieces = c->line_pieces;
    choose_projection(&load, normal, first, end);
    slot_of(&load, surface_body(found->surface, out->triangle));
    for (size_t i = first; i < end; i++) add_piece(&load, &c->keys[i]);
    loaded_cut_sort_borders(out, c->spare_borders);
    number_corners(&load);
    return true;
}
