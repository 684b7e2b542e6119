/* The parts of a triangle that curves cut, with how often objects wind around them.
 *
 * Slabs from left to right: between two neighbouring ends or crossings of lines the order of the lines is that in the
 * middle. In a cross-section the numbers are known at the lower end, by the corner before it and what the border passes
 * through since, and change from line to line. */
#include "runtime/intersections/cut_triangle.h"

#include "src/core/sort.h"

#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

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

/* ---- lines --------------------------------------------------------------------------------------------- */

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

/* Where the lines a and b, a below b at begin and above it at end, have one height. */
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

/* ---- a cross-section ----------------------------------------------------------------------------------- */

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

/* ---- all of it ----------------------------------------------------------------------------------------- */

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
