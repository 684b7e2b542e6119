/* The parts that curves cut out of each triangle: from the pieces of all curves to the lines in one
 * triangle's plane, and from these to the parts of the triangle, with how often bodies wind around them. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- the parts of a triangle --------------------------------------------------------------------------- */

/* Slabs from left to right: between two neighbouring ends or crossings of lines the order of the lines is that in the
 * middle. In a cross-section the numbers are known at the lower end, by the corner before it and what the border passes
 * through since, and change from line to line. */

static array_list list_of_lines(cut_memory *m, size_t lines) {
    return (array_list){{ARRAY(m->spare_lines, lines), ARRAY(m->active, lines),
                         ARRAY(m->breaks, 2 * lines + 3), ARRAY(m->spare_breaks, 2 * lines + 3)}};
}

static array_list list_of_slots(cut_memory *m, size_t slots) {
    return (array_list){{ARRAY(m->below.numbers, slots), ARRAY(m->below.listed, slots),
                         ARRAY(m->below.places, slots), ARRAY(m->here.numbers, slots),
                         ARRAY(m->here.listed, slots), ARRAY(m->here.places, slots)}};
}

bool cut_memory_begin(cut_memory *m, memory_budget *budget, size_t lines, size_t slots) {
    m->budget = budget;
    m->crossings_taken = 0;
    return memory_budget_take_all(budget, list_of_lines(m, room_with_spare(lines))) &&
           memory_budget_take_all(budget, list_of_slots(m, room_with_spare(slots)));
}

bool cut_memory_reserve(cscd_context *context, cut_memory *m, size_t lines, size_t slots) {
    if (lines <= m->line_capacity && slots <= m->slot_capacity)
        return true; /* lists cost more than most triangles */
    return context_renew_all(context, list_of_lines(m, room_with_spare(lines)), &m->line_capacity, lines) &&
           context_renew_all(context, list_of_slots(m, room_with_spare(slots)), &m->slot_capacity, slots);
}

void cut_memory_free(cscd_context *context, cut_memory *m) {
    context_free_all(context, list_of_lines(m, 0));
    context_free_all(context, list_of_slots(m, 0));
    context_free(context, m->crossings);
    *m = (cut_memory){.line_capacity = 0};
}

static double height_at(const cut_line *line, double x) {
    double width = line->to[0] - line->from[0];
    double share = width != 0.0 ? (x - line->from[0]) / width : 0.5;
    return line->from[1] + share * (line->to[1] - line->from[1]);
}

static int compare_lines(const void *a, const void *b) {
    double x = ((const cut_line *)a)->low, y = ((const cut_line *)b)->low;
    return (x > y) - (x < y);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* One triangle on its way from left to right. */
typedef struct slab_sweep {
    cscd_context *context;
    const cut_triangle *triangle;
    cut_memory *memory;
    void (*take)(void *data, const cut_part *part);
    void *data;
    size_t next_line, active_count, crossing_count;
    uint32_t border_edge; /* the edge along which the numbers below are kept; 3: none yet */
    size_t next_border;   /* the first border that is not in them */
} slab_sweep;

static const cut_line *active_line(const slab_sweep *s, size_t i) {
    return &s->triangle->lines[s->memory->active[i]];
}

/* Is line a below line b at x or, if they are at one height there, at then? */
static bool is_below(const cut_line *a, const cut_line *b, double x, double then) {
    double of_a = height_at(a, x), of_b = height_at(b, x);
    return of_a != of_b ? of_a < of_b : height_at(a, then) < height_at(b, then);
}

/* Puts the active lines in order from below, which they nearly are. */
static void order_active(slab_sweep *s, double x, double then) {
    for (size_t i = 1; i < s->active_count; i++) {
        uint32_t line = s->memory->active[i];
        size_t j = i;
        for (; j > 0 && is_below(&s->triangle->lines[line], active_line(s, j - 1), x, then); j--)
            s->memory->active[j] = s->memory->active[j - 1];
        s->memory->active[j] = line;
    }
}

/* Drops the lines that end at or before begin, and takes those that begin there. */
static void update_active(slab_sweep *s, double begin) {
    size_t kept = 0;
    for (size_t i = 0; i < s->active_count; i++) {
        if (active_line(s, i)->high > begin) s->memory->active[kept++] = s->memory->active[i];
    }
    for (; s->next_line < s->triangle->line_count && s->triangle->lines[s->next_line].low <= begin;
         s->next_line++) {
        if (s->triangle->lines[s->next_line].high > begin) s->memory->active[kept++] = (uint32_t)s->next_line;
    }
    s->active_count = kept;
}

static bool add_crossing(slab_sweep *s, double x) {
    cut_memory *m = s->memory;
    if (s->crossing_count >= m->crossings_taken) {
        if (!memory_budget_take(m->budget, 1, MEMORY_WHILE_DOUBLING * sizeof *m->crossings)) return false;
        m->crossings_taken++;
    }
    if (s->crossing_count == m->crossing_capacity) {
        size_t capacity = m->crossing_capacity == 0 ? 16 : 2 * m->crossing_capacity;
        double *grown = context_grow(s->context, m->crossings, s->crossing_count, capacity, sizeof *grown);
        if (grown == NULL) return false;
        m->crossings = grown;
        m->crossing_capacity = capacity;
    }
    m->crossings[s->crossing_count++] = x;
    return true;
}

/* Returns the place where the lines a and b, a below b at begin and above it at end, have one height. */
static double crossing_of(const cut_line *a, const cut_line *b, double begin, double end) {
    double before = height_at(b, begin) - height_at(a, begin), behind = height_at(a, end) - height_at(b, end);
    return before + behind > 0.0 ? begin + (end - begin) * (before / (before + behind)) : begin;
}

/* Lists the crossings of a slab: each is a change of the order from its begin to its end. */
static bool find_crossings(slab_sweep *s, double begin, double end) {
    s->crossing_count = 0;
    order_active(s, begin, end);
    for (size_t i = 1; i < s->active_count; i++) {
        uint32_t line = s->memory->active[i];
        size_t j = i;
        for (; j > 0 && height_at(&s->triangle->lines[line], end) < height_at(active_line(s, j - 1), end);
             j--) {
            if (!add_crossing(s, crossing_of(active_line(s, j - 1), &s->triangle->lines[line], begin, end)))
                return false;
            s->memory->active[j] = s->memory->active[j - 1];
        }
        s->memory->active[j] = line;
    }
    for (size_t i = 1; i < s->crossing_count; i++) { /* few, mostly none */
        double x = s->memory->crossings[i];
        size_t j = i;
        for (; j > 0 && s->memory->crossings[j - 1] > x; j--)
            s->memory->crossings[j] = s->memory->crossings[j - 1];
        s->memory->crossings[j] = x;
    }
    return true;
}

/* The edge of the border at x: it runs to the right below, since the triangle turns counter-clockwise, and to the left
 * above. */
static uint32_t border_at(const cut_triangle *t, double x, bool below) {
    uint32_t edge = 0;
    for (uint32_t i = 0; i < 3; i++) {
        double from = t->corners[i][0], to = t->corners[(i + 1) % 3][0];
        if ((from < to) == below && from != to && (from <= x) == below && (x <= to) == below) edge = i;
    }
    return edge;
}

static double border_share(const cut_triangle *t, uint32_t edge, double x) {
    double from = t->corners[edge][0], to = t->corners[(edge + 1) % 3][0];
    return from != to ? (x - from) / (to - from) : 0.5;
}

static double border_height(const cut_triangle *t, uint32_t edge, double x) {
    double from = t->corners[edge][1], to = t->corners[(edge + 1) % 3][1];
    return from + border_share(t, edge, x) * (to - from);
}

static void change_number(slot_numbers *n, uint32_t slot, int32_t by) {
    int32_t before = n->numbers[slot];
    n->numbers[slot] += by;
    if (before == 0 && by != 0) {
        n->places[slot] = n->count;
        n->listed[n->count++] = slot;
    } else if (before != 0 && n->numbers[slot] == 0) {
        uint32_t last = n->listed[--n->count];
        n->listed[n->places[slot]] = last;
        n->places[last] = n->places[slot];
    }
}

static void clear_numbers(slot_numbers *n) {
    for (uint32_t i = 0; i < n->count; i++) n->numbers[n->listed[i]] = 0;
    n->count = 0;
}

static void begin_edge(slab_sweep *s, uint32_t edge) {
    const cut_triangle *t = s->triangle;
    const int32_t *numbers = t->corner_numbers + (size_t)edge * t->slot_count;
    clear_numbers(&s->memory->below);
    for (uint32_t slot = 0; slot < t->slot_count; slot++)
        change_number(&s->memory->below, slot, numbers[slot]);
    s->border_edge = edge;
    s->next_border = 0;
    while (s->next_border < t->border_count && t->borders[s->next_border].edge < edge) s->next_border++;
}

/* The numbers at a place on the border, which is farther along than that of the call before or on another edge. */
static void begin_numbers(slab_sweep *s, uint32_t edge, double share) {
    const cut_triangle *t = s->triangle;
    slot_numbers *below = &s->memory->below, *here = &s->memory->here;
    if (edge != s->border_edge) begin_edge(s, edge);
    for (; s->next_border < t->border_count; s->next_border++) {
        const cut_border *b = &t->borders[s->next_border];
        if (b->edge != edge || !(b->s < share)) break;
        change_number(below, b->slot, b->jump);
    }
    clear_numbers(here);
    for (uint32_t i = 0; i < below->count; i++)
        change_number(here, below->listed[i], below->numbers[below->listed[i]]);
}

/* Gives the part between what was below and what is above now; heights are those at the slab's ends. */
static void give_part(const slab_sweep *s, cut_part *part, const double above[2]) {
    double gap = (above[0] - part->low[0]) + (above[1] - part->low[1]);
    if (!(gap > 0.0)) return;
    for (int i = 0; i < 2; i++) part->high[i] = above[i] > part->low[i] ? above[i] : part->low[i];
    part->listed_count = s->memory->here.count;
    s->take(s->data, part);
    for (int i = 0; i < 2; i++) part->low[i] = part->high[i];
}

/* Divides a slab whose lines do not cross. */
static void divide_slab(slab_sweep *s, double begin, double end) {
    const cut_triangle *t = s->triangle;
    double middle = begin + 0.5 * (end - begin);
    uint32_t bottom = border_at(t, middle, true), top = border_at(t, middle, false);
    const double last[2] = {border_height(t, top, begin), border_height(t, top, end)};
    cut_part part = {.x = {begin, end},
                     .low = {border_height(t, bottom, begin), border_height(t, bottom, end)},
                     .numbers = s->memory->here.numbers,
                     .listed = s->memory->here.listed};
    begin_numbers(s, bottom, border_share(t, bottom, middle));
    order_active(s, middle, middle);
    for (size_t i = 0; i < s->active_count; i++) {
        const cut_line *line = active_line(s, i);
        double above[2] = {height_at(line, begin), height_at(line, end)};
        for (int k = 0; k < 2; k++) above[k] = above[k] < last[k] ? above[k] : last[k];
        give_part(s, &part, above);
        change_number(&s->memory->here, line->slot, line->from[0] < line->to[0] ? line->rise : -line->rise);
    }
    give_part(s, &part, last);
}

static size_t list_breaks(const cut_triangle *t, cut_memory *m) {
    size_t count = 0;
    for (int i = 0; i < 3; i++) m->breaks[count++] = t->corners[i][0];
    for (size_t i = 0; i < t->line_count; i++) {
        m->breaks[count++] = t->lines[i].low;
        m->breaks[count++] = t->lines[i].high;
    }
    sort_items(m->breaks, m->spare_breaks, count, sizeof *m->breaks, compare_doubles);
    return count;
}

bool cut_triangle_divide(cscd_context *context, cut_triangle *t, cut_memory *m,
                         void (*take)(void *data, const cut_part *part), void *data) {
    slab_sweep s = {
        .context = context, .triangle = t, .memory = m, .take = take, .data = data, .border_edge = 3};
    m->below.count = m->here.count = 0;
    memset(m->below.numbers, 0, t->slot_count * sizeof *m->below.numbers);
    memset(m->here.numbers, 0, t->slot_count * sizeof *m->here.numbers);
    for (size_t i = 0; i < t->line_count; i++) {
        cut_line *line = &t->lines[i];
        bool forward = line->from[0] < line->to[0];
        line->low = forward ? line->from[0] : line->to[0];
        line->high = forward ? line->to[0] : line->from[0];
    }
    sort_items(t->lines, m->spare_lines, t->line_count, sizeof *t->lines, compare_lines);
    size_t count = list_breaks(t, m);
    for (size_t i = 0; i + 1 < count; i++) {
        double begin = m->breaks[i], end = m->breaks[i + 1];
        if (!(begin < end)) continue;
        update_active(&s, begin);
        if (!find_crossings(&s, begin, end)) return false;
        for (size_t k = 0; k <= s.crossing_count; k++) {
            double from = k == 0 ? begin : m->crossings[k - 1];
            double to = k == s.crossing_count ? end : m->crossings[k];
            if (from < to) divide_slab(&s, from, to);
        }
    }
    return true;
}

/* ---- the pieces of each triangle ----------------------------------------------------------------------- */

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

/* Returns the lengths of the pieces of some keys along a coordinate, summed up, in units of the triangle. */
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
