/* The events of a recording by comparing everything with everything: the truth of the tests. */
#include "tests/support/events/recorded_frames.h"

#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { THINGS_MAX = 8192, FAR = 1 << 20 };

typedef enum thing_type { PAIR, PIECE, DEPTH, CONTACT } thing_type;

/* A pair, piece, depth or contact, with the triangles and loose vertices that it has. */
typedef struct thing {
    thing_type type;
    uint32_t frame, a, b; /* parts */
    uint32_t first_element, element_count;
    uint64_t least; /* triangle, or 2^32 + the loose vertex */
    double amount;  /* depth, length or time */
    double x[3];
    uint32_t triangle; /* of a pair or a piece, the first one */
    cscd_intersection_kind kind;
    size_t event, group; /* labels */
} thing;

typedef struct oracle {
    const recorded_frames *r;
    uint32_t vertex_count;
    int *distances; /* in edges, between vertices */
    thing *things;
    size_t thing_count;
    uint64_t *elements; /* of all things: as `least` */
    size_t element_count, element_capacity;
} oracle;

/* ---- distances ------------------------------------------------------------------------------------------ */

static void bring_near(oracle *o, uint32_t v, uint32_t w, int distance) {
    o->distances[v * o->vertex_count + w] = o->distances[w * o->vertex_count + v] = distance;
}

/* Floyd and Warshall: seams are edges of length 0. */
static void measure_distances(oracle *o) {
    uint32_t n = o->vertex_count;
    int *d = o->distances = malloc((size_t)n * n * sizeof *d);
    assert_non_null(d);
    for (uint32_t i = 0; i < n * n; i++) d[i] = i / n == i % n ? 0 : FAR;
    for (uint32_t e = 0; e < cscd_mesh_edge_count(o->r->mesh); e++) {
        uint32_t ends[2];
        cscd_mesh_edge(o->r->mesh, e, ends);
        bring_near(o, ends[0], ends[1], 1);
    }
    for (size_t i = 0; i < o->r->options.seam_count; i++)
        bring_near(o, o->r->seams[2 * i], o->r->seams[2 * i + 1], 0);
    for (uint32_t k = 0; k < n; k++) {
        for (uint32_t i = 0; i < n * n; i++) {
            int way = d[i / n * n + k] + d[k * n + i % n];
            if (way < d[i]) d[i] = way;
        }
    }
}

static uint32_t corners_of(const oracle *o, uint64_t element, uint32_t corners[3]) {
    if (element > UINT32_MAX) {
        corners[0] = (uint32_t)element;
        return 1;
    }
    cscd_mesh_triangle(o->r->mesh, (uint32_t)element, corners);
    return 3;
}

static bool elements_near(const oracle *o, uint64_t s, uint64_t t) {
    uint32_t rings = o->r->options.rings, a[3], b[3];
    if (s == t) return true;
    if (rings == 0) return false;
    uint32_t in_a = corners_of(o, s, a), in_b = corners_of(o, t, b);
    for (uint32_t i = 0; i < in_a * in_b; i++) {
        if (o->distances[a[i / in_b] * o->vertex_count + b[i % in_b]] <= (int)rings - 1) return true;
    }
    return false;
}

static bool things_near(const oracle *o, const thing *s, const thing *t) {
    if (s->a != t->a || s->b != t->b) return false;
    for (uint32_t i = 0; i < s->element_count; i++) {
        for (uint32_t k = 0; k < t->element_count; k++) {
            if (elements_near(o, o->elements[s->first_element + i], o->elements[t->first_element + k]))
                return true;
        }
    }
    return false;
}

/* ---- things --------------------------------------------------------------------------------------------- */

static void add_element(oracle *o, thing *t, uint64_t element) {
    if (o->element_count == o->element_capacity) {
        o->element_capacity = 2 * o->element_capacity + 1024;
        o->elements = realloc(o->elements, o->element_capacity * sizeof *o->elements);
        assert_non_null(o->elements);
    }
    o->elements[o->element_count++] = element;
    t->element_count++;
    if (element < t->least) t->least = element;
}

static thing *add_thing(oracle *o, thing_type type, uint32_t frame) {
    assert_true(o->thing_count < THINGS_MAX);
    thing *t = &o->things[o->thing_count++];
    *t = (thing){
        .type = type, .frame = frame, .least = UINT64_MAX, .first_element = (uint32_t)o->element_count};
    return t;
}

static uint32_t triangle_part(const oracle *o, uint32_t triangle) {
    uint32_t corners[3];
    if (o->r->options.labels != NULL) return o->r->labels[triangle];
    cscd_mesh_triangle(o->r->mesh, triangle, corners);
    return cscd_mesh_vertex_object(o->r->mesh, corners[0]);
}

/* The triangles at a vertex, or the vertex; returns its part. */
static uint32_t add_vertex(oracle *o, thing *t, uint32_t vertex) {
    uint32_t count;
    const uint32_t *star = cscd_mesh_vertex_triangles(o->r->mesh, vertex, &count);
    for (uint32_t i = 0; i < count; i++) add_element(o, t, star[i]);
    if (count == 0) add_element(o, t, (UINT64_C(1) << 32) + vertex);
    if (o->r->options.labels == NULL) return cscd_mesh_vertex_object(o->r->mesh, vertex);
    return count > 0 ? triangle_part(o, star[0]) : UINT32_MAX;
}

static uint32_t add_edge(oracle *o, thing *t, uint32_t edge) {
    uint32_t count, ends[2];
    const uint32_t *star = cscd_mesh_edge_triangles(o->r->mesh, edge, &count);
    for (uint32_t i = 0; i < count; i++) add_element(o, t, star[i]);
    if (count > 0) return triangle_part(o, star[0]);
    cscd_mesh_edge(o->r->mesh, edge, ends);
    add_vertex(o, t, ends[1]);
    return add_vertex(o, t, ends[0]);
}

static void set_parts(thing *t, uint32_t p, uint32_t q) {
    t->a = p < q ? p : q;
    t->b = p < q ? q : p;
}

static thing *add_triangles(oracle *o, thing_type type, uint32_t frame, uint32_t a, uint32_t b) {
    thing *t = add_thing(o, type, frame);
    add_element(o, t, a);
    add_element(o, t, b);
    set_parts(t, triangle_part(o, a), triangle_part(o, b));
    t->triangle = a;
    return t;
}

static void list_curves(oracle *o, uint32_t frame, const cscd_curves *curves) {
    for (size_t c = 0; c < curves->count; c++) {
        const cscd_curve *curve = &curves->items[c];
        for (size_t i = 0; i < curve->piece_count; i++) {
            const cscd_curve_piece *piece = &curves->pieces[curve->first_piece + i];
            thing *t = add_triangles(o, PIECE, frame, piece->a, piece->b);
            size_t end = i + 1 == curve->point_count ? 0 : i + 1;
            const double *x = curves->points[curve->first_point + i].x;
            const double *y = curves->points[curve->first_point + end].x;
            t->amount = sqrt((x[0] - y[0]) * (x[0] - y[0]) + (x[1] - y[1]) * (x[1] - y[1]) +
                             (x[2] - y[2]) * (x[2] - y[2]));
            memcpy(t->x, x, sizeof t->x);
        }
    }
}

static void list_depths(oracle *o, uint32_t frame, const cscd_depths *depths) {
    for (size_t i = 0; i < depths->count; i++) {
        const cscd_depth *depth = &depths->items[i];
        thing *t = add_thing(o, DEPTH, frame);
        if (depth->vertex != UINT32_MAX)
            add_vertex(o, t, depth->vertex);
        else if (depth->edge != UINT32_MAX)
            add_edge(o, t, depth->edge);
        else
            add_element(o, t, depth->face);
        set_parts(t, triangle_part(o, depth->face), triangle_part(o, depth->triangle));
        t->amount = depth->depth;
        memcpy(t->x, depth->x, sizeof t->x);
    }
}

static void list_contacts(oracle *o, uint32_t frame, const recorded_frame *f) {
    for (size_t i = 0; i < f->contact_count; i++) {
        const cscd_contact *c = &f->contacts[i];
        thing *t = add_thing(o, CONTACT, frame);
        bool edge_a = c->kind == CSCD_CONTACT_EE || c->kind == CSCD_CONTACT_EV;
        uint32_t p = edge_a ? add_edge(o, t, c->a) : add_vertex(o, t, c->a), q;
        if (c->kind == CSCD_CONTACT_VF) {
            add_element(o, t, c->b);
            q = triangle_part(o, c->b);
        } else if (c->kind == CSCD_CONTACT_VH)
            q = o->r->options.labels == NULL ? c->b : UINT32_MAX;
        else
            q = c->kind == CSCD_CONTACT_EE ? add_edge(o, t, c->b) : add_vertex(o, t, c->b);
        set_parts(t, p, q);
        t->amount = c->toi;
        memcpy(t->x, c->point, sizeof t->x);
    }
}

static void list_things(oracle *o) {
    for (uint32_t i = 0; i < o->r->frame_count; i++) {
        const recorded_frame *f = &o->r->frames[i];
        for (size_t k = 0; f->looked && k < f->found.count; k++)
            add_triangles(o, PAIR, i, f->found.items[k].a, f->found.items[k].b)->kind =
                f->found.items[k].kind;
        if (f->looked && f->found.curves != NULL) list_curves(o, i, f->found.curves);
        if (f->looked && f->found.depths != NULL) list_depths(o, i, f->found.depths);
        list_contacts(o, i, f);
    }
}

/* ---- what belongs together ------------------------------------------------------------------------------ */

/* Gives everything that is labelled as `from` the label `to`. */
static void relabel_things(oracle *o, bool groups, size_t from, size_t to) {
    for (size_t i = 0; i < o->thing_count && from != to; i++) {
        size_t *label = groups ? &o->things[i].group : &o->things[i].event;
        if (*label == from) *label = to;
    }
}

static void join_things(oracle *o) {
    thing *t = o->things;
    for (size_t i = 0; i < o->thing_count; i++) t[i].event = t[i].group = i;
    for (size_t i = 0; i < o->thing_count; i++) {
        for (size_t k = 0; k < i; k++) {
            if (t[i].frame - t[k].frame > o->r->options.gap + 1 || !things_near(o, &t[i], &t[k])) continue;
            relabel_things(o, false, t[i].event, t[k].event);
            if (t[i].frame == t[k].frame) relabel_things(o, true, t[i].group, t[k].group);
        }
    }
}

/* ---- what an event is ----------------------------------------------------------------------------------- */

typedef struct group_sum {
    double depth, length;
    size_t pairs, contacts;
    uint32_t frame;
    uint64_t least;
    uint32_t triangle;
    double x[3];
} group_sum;

static void take_place(group_sum *g, const thing *t, thing_type type) {
    g->triangle = type == DEPTH || type == CONTACT ? (t->least > UINT32_MAX ? UINT32_MAX : (uint32_t)t->least)
                                                   : t->triangle;
    for (int c = 0; c < 3; c++) g->x[c] = type == PAIR ? (double)NAN : t->x[c];
}

static const thing *best_place(const oracle *o, size_t group, thing_type type) {
    const thing *best = NULL;
    for (size_t i = 0; i < o->thing_count; i++) {
        const thing *t = &o->things[i];
        if (t->group != group || t->type != type) continue;
        bool better = best == NULL || (type == DEPTH && t->amount > best->amount) ||
                      (type == CONTACT && t->amount < best->amount);
        if (better) best = t;
    }
    return best;
}

static group_sum sum_group(const oracle *o, size_t group) {
    static const thing_type order[] = {PAIR, CONTACT, PIECE, DEPTH};
    group_sum g = {.least = UINT64_MAX};
    for (size_t i = 0; i < o->thing_count; i++) {
        const thing *t = &o->things[i];
        if (t->group != group) continue;
        g.frame = t->frame;
        if (t->least < g.least) g.least = t->least;
        g.pairs += t->type == PAIR;
        g.contacts += t->type == CONTACT;
        if (t->type == PIECE) g.length += t->amount;
        if (t->type == DEPTH && t->amount > g.depth) g.depth = t->amount;
    }
    for (int i = 0; i < 4; i++) {
        const thing *best = best_place(o, group, order[i]);
        if (best != NULL) take_place(&g, best, order[i]);
    }
    return g;
}

static bool group_is_worse(const group_sum *g, const group_sum *h) {
    if (g->depth != h->depth) return g->depth > h->depth;
    if (g->length != h->length) return g->length > h->length;
    if (g->pairs != h->pairs) return g->pairs > h->pairs;
    if (g->depth == 0.0 && g->pairs == 0 && g->contacts != h->contacts) return g->contacts > h->contacts;
    return g->frame != h->frame ? g->frame < h->frame : g->least < h->least;
}

static void add_group(const oracle *o, size_t group, group_sum *worst, cscd_event *event) {
    group_sum g = sum_group(o, group);
    if (g.length > event->length) event->length = g.length;
    if (worst->least == UINT64_MAX || group_is_worse(&g, worst)) *worst = g;
}

static cscd_event describe_event(const oracle *o, size_t label, uint64_t *least) {
    group_sum worst = {.least = UINT64_MAX};
    cscd_event event = {.first_frame = UINT64_MAX};
    *least = UINT64_MAX;
    for (size_t i = 0; i < o->thing_count; i++) {
        const thing *t = &o->things[i];
        if (t->event != label) continue;
        uint64_t number = o->r->frames[t->frame].number;
        if (event.first_frame == UINT64_MAX) event.first_frame = number;
        if (event.first_frame == number && t->least < *least) *least = t->least;
        event.last_frame = number;
        event.a = t->a;
        event.b = t->b;
        event.pairs += t->type == PAIR;
        event.depths += t->type == DEPTH;
        event.contacts += t->type == CONTACT;
        if (t->type == PAIR) event.kinds |= cscd_intersection_set(t->kind);
        if (t->group == i) add_group(o, i, &worst, &event);
    }
    event.worst_frame = o->r->frames[worst.frame].number;
    event.depth = worst.depth;
    memcpy(event.x, worst.x, sizeof event.x);
    event.triangle = worst.triangle;
    event.first_triangle = *least > UINT32_MAX ? UINT32_MAX : (uint32_t)*least;
    return event;
}

/* ---- all of it ------------------------------------------------------------------------------------------ */

typedef struct sorted_event {
    cscd_event event;
    uint64_t least;
} sorted_event;

static int compare_numbers(uint64_t a, uint64_t b) {
    return a < b ? -1 : a > b;
}

static int compare_events(const void *left, const void *right) {
    const sorted_event *s = left, *t = right;
    int order = compare_numbers(s->event.first_frame, t->event.first_frame);
    if (order == 0) order = compare_numbers(s->event.a, t->event.a);
    if (order == 0) order = compare_numbers(s->event.b, t->event.b);
    return order != 0 ? order : compare_numbers(s->least, t->least);
}

cscd_event *recording_oracle(const recorded_frames *r, size_t *count) {
    oracle o = {.r = r, .vertex_count = cscd_mesh_vertex_count(r->mesh)};
    o.things = malloc(THINGS_MAX * sizeof *o.things);
    assert_non_null(o.things);
    measure_distances(&o);
    list_things(&o);
    join_things(&o);
    sorted_event *sorted = malloc((o.thing_count + 1) * sizeof *sorted);
    cscd_event *events = malloc((o.thing_count + 1) * sizeof *events);
    assert_true(sorted != NULL && events != NULL);
    *count = 0;
    for (size_t i = 0; i < o.thing_count; i++) {
        if (o.things[i].event != i) continue;
        sorted_event *next = &sorted[(*count)++];
        next->event = describe_event(&o, i, &next->least);
    }
    qsort(sorted, *count, sizeof *sorted, compare_events);
    for (size_t i = 0; i < *count; i++) events[i] = sorted[i].event;
    free(sorted);
    free(o.things);
    free(o.elements);
    free(o.distances);
    return events;
}
