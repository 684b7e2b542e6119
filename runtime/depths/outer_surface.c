/* The outer surfaces of bodies: what they do not bury in themselves; and the nearest point of one. */
#include "runtime/depths/outer_surface.h"

#include "runtime/ccd/closest.h"
#include "src/core/vec3.h"
#include "src/mesh/surface.h"

#include <float.h>
#include <string.h>

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_of_cuts(outer_surface *o, size_t count) {
    return (array_list){
        {ARRAY(o->cut_triangles, count), ARRAY(o->part_begins, count + 1), ARRAY(o->boxes, count)}};
}

static array_list list_of_places(outer_surface *o, size_t count) {
    return (array_list){{ARRAY(o->places, count)}};
}

void outer_surface_free(outer_surface *o) {
    if (o->context == NULL) return;
    triangle_cuts_free(&o->cuts);
    context_free_all(o->context, list_of_cuts(o, 0));
    context_free_all(o->context, list_of_places(o, 0));
    context_free(o->context, o->parts);
    *o = (outer_surface){.context = o->context, .cuts = {.context = o->context}};
}

/* ---- parts --------------------------------------------------------------------------------------------- */

/* A triangle whose parts are taken. */
typedef struct part_taker {
    outer_surface *outer;
    const loaded_cut *cut;
    cut_lift lift;
    cut_part waiting; /* a part that may go on upwards */
    bool waits, out_of_memory;
} part_taker;

static outer_box box_of_part(const outer_part *part) {
    const double(*p)[3] = part->corners;
    outer_box box;
    for (int k = 0; k < 3; k++) {
        double low = p[0][k] < p[1][k] ? p[0][k] : p[1][k], high = p[0][k] < p[1][k] ? p[1][k] : p[0][k];
        box.low[k] = p[2][k] < low ? p[2][k] : low;
        box.high[k] = p[2][k] > high ? p[2][k] : high;
    }
    return box;
}

static outer_box empty_box(void) {
    const double most = (double)INFINITY;
    return (outer_box){{most, most, most}, {-most, -most, -most}};
}

static void box_parts(outer_box *box, const outer_part *parts, size_t count) {
    *box = empty_box();
    for (size_t i = 0; i < count; i++) {
        outer_box part = box_of_part(&parts[i]);
        for (int k = 0; k < 3; k++) {
            box->low[k] = part.low[k] < box->low[k] ? part.low[k] : box->low[k];
            box->high[k] = part.high[k] > box->high[k] ? part.high[k] : box->high[k];
        }
    }
}

static bool add_part(outer_surface *o, const outer_part *part) {
    if (!memory_budget_take(o->budget, 1, MEMORY_WHILE_DOUBLING * sizeof *part)) return false;
    if (o->part_count == o->part_capacity) {
        size_t larger = o->part_capacity == 0 ? 64 : 2 * o->part_capacity;
        outer_part *grown = context_grow(o->context, o->parts, o->part_count, larger, sizeof *grown);
        if (grown == NULL) return false;
        o->parts = grown;
        o->part_capacity = larger;
    }
    o->parts[o->part_count++] = *part;
    return true;
}

static void scale_point(const outer_surface *o, const double x[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = x[k] * o->scale;
}

/* Adds the two triangles of the trapezoid that waits. */
static void add_waiting(part_taker *taker) {
    outer_part halves[2];
    if (!taker->waits) return;
    taker->waits = false;
    cut_lift_part(&taker->lift, &taker->waiting, halves[0].corners, halves[1].corners);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) scale_point(taker->outer, halves[i].corners[k], halves[i].corners[k]);
        taker->out_of_memory |= !add_part(taker->outer, &halves[i]);
    }
}

static bool goes_on(const cut_part *below, const cut_part *part) {
    return below->x[0] == part->x[0] && below->x[1] == part->x[1] && below->high[0] == part->low[0] &&
           below->high[1] == part->low[1];
}

/* Parts of one slab come from below; those that are outer are put together. */
static void take_part(void *data, const cut_part *part) {
    part_taker *taker = data;
    if (part->numbers[0] >= 1 || taker->out_of_memory) return;
    if (taker->waits && goes_on(&taker->waiting, part)) {
        memcpy(taker->waiting.high, part->high, sizeof part->high);
        return;
    }
    add_waiting(taker);
    taker->waiting = *part;
    taker->waits = true;
}

/* Keeps what changes the own number. Says whether a line is left. */
static bool keep_own_cuts(cut_triangle *cut) {
    size_t lines = 0, borders = 0;
    for (size_t i = 0; i < cut->line_count; i++) {
        if (cut->lines[i].slot == 0) cut->lines[lines++] = cut->lines[i];
    }
    for (size_t i = 0; i < cut->border_count; i++) {
        if (cut->borders[i].slot == 0) cut->borders[borders++] = cut->borders[i];
    }
    cut->line_count = lines;
    cut->border_count = borders;
    return lines > 0;
}

static bool divide_triangle(outer_surface *o, const surface_cuts *found, loaded_cut *cut) {
    part_taker taker = {.outer = o, .cut = cut, .lift = cut_lift_of(found->surface, cut)};
    if (!keep_own_cuts(&cut->cut)) return true;
    o->cut_triangles[o->cut_count] = cut->triangle;
    o->part_begins[o->cut_count++] = o->part_count;
    if (!cut_triangle_divide(o->context, &cut->cut, &o->cuts.memory, take_part, &taker)) return false;
    add_waiting(&taker);
    size_t first = o->part_begins[o->cut_count - 1];
    box_parts(&o->boxes[o->cut_count - 1], o->parts + first, o->part_count - first);
    return !taker.out_of_memory;
}

/* Triangles of open components are outer nowhere. */
static uint32_t place_uncut(const surface_cuts *found, uint32_t triangle) {
    const cscd_mesh *mesh = found->surface->mesh;
    const patch_finder *p = found->patches;
    uint32_t patch = p->triangle_patches[triangle];
    if (patch == UINT32_MAX) patch = p->corner_patches[(size_t)triangle * 3];
    bool outer =
        mesh->components[mesh->triangle_components[triangle]].closed_manifold && p->patches[patch].own < 1;
    return outer ? OUTER_AS_A_WHOLE : OUTER_NOWHERE;
}

static bool find_places(outer_surface *o, const surface_cuts *found) {
    const cscd_mesh *mesh = found->surface->mesh;
    size_t count = mesh->triangle_count;
    if (!context_renew_all(o->context, list_of_places(o, count), &o->place_capacity, count)) return false;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) o->places[i] = place_uncut(found, i);
    for (size_t i = 0; i < o->cut_count; i++) {
        if (mesh->components[mesh->triangle_components[o->cut_triangles[i]]].closed_manifold)
            o->places[o->cut_triangles[i]] = (uint32_t)i;
    }
    return true;
}

bool outer_surface_find(outer_surface *o, const surface_cuts *found, const bvh *f) {
    triangle_cuts *c = &o->cuts;
    o->scale = f->scale;
    o->budget = found->budget;
    if (!triangle_cuts_sort(c, found)) return false;
    size_t triangles = found->surface->mesh->triangle_count;
    size_t most = c->key_count < triangles ? c->key_count : triangles, room = room_with_spare(most);
    if (!memory_budget_take_all(found->budget, list_of_cuts(o, room))) return false;
    if (!context_renew_all(o->context, list_of_cuts(o, room), &o->cut_capacity, most)) return false;
    o->part_count = o->cut_count = 0;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!triangle_cuts_load(c, found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !divide_triangle(o, found, &cut)) return false;
    }
    o->part_begins[o->cut_count] = o->part_count;
    return find_places(o, found);
}

/* ---- the nearest point --------------------------------------------------------------------------------- */

typedef struct nearest_search {
    const outer_surface *outer;
    const surface_cuts *found;
    uint32_t body;
    double x[3]; /* scaled, as all that is found */
    outer_point best;
} nearest_search;

/* Is the box further away than what was found? Computed distances from points of a triangle are off by less than 2^-47 of
 * the sum of the distance and the triangle's size, which the margins cover, so that nothing is left out that would be
 * nearer as computed. If a box is far, so is each that lies in it. */
static bool box_is_far(const nearest_search *s, const outer_box *box) {
    double squared = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = box->low[k], high = box->high[k];
        double gap = low > s->x[k] ? low - s->x[k] : s->x[k] > high ? s->x[k] - high : 0.0;
        squared += gap * gap;
        size += (high - low) * (high - low);
    }
    return squared * (1.0 - 0x1p-20) > s->best.squared + 0x1p-70 * size;
}

/* Is the plane of a triangle further away than what was found? The least distance of the point w from the plane, seen from a
 * corner, is |h| / |n|, with n the product of two sides of squared lengths a and b, and h = n w. Computed, n is off by less
 * than 8 * 2^-53 * sqrt(ab), since each of its coordinates is by 5 * 2^-53 of the sum of its two products, and h by less than
 * 13 * 2^-53 * sqrt(ab) |w|. As (x - e)^2 > x^2 (1 - t) - e^2 / t, and the same with +, for t = 2^-22, what remains of these is
 * 2^-76 ab in n n, and 2^-75 ab w w in h h; the rest of 2^-18 is for what box_is_far says of computed distances, with
 * 2 (a + b) as the square of the size. What underflow loses is below 2^-900. */
static bool plane_is_far(const nearest_search *s, const double corners[3][3]) {
    double ab[3], ac[3], w[3], n[3];
    vec3_subtract(corners[1], corners[0], ab);
    vec3_subtract(corners[2], corners[0], ac);
    vec3_subtract(s->x, corners[0], w);
    vec3_cross(ab, ac, n);
    double a = vec3_dot(ab, ab), b = vec3_dot(ac, ac), h = vec3_dot(n, w),
           most = s->best.squared + 0x1p-69 * (a + b);
    double rounding = 0x1p-75 * a * b;
    return h * h * (1.0 - 0x1p-18) >
           most * (vec3_dot(n, n) + rounding) + rounding * vec3_dot(w, w) + 0x1p-900;
}

/* Of several parts at the same distance, that of the first triangle is the answer, whatever the trees' order is. */
static void try_part(nearest_search *s, uint32_t triangle, const outer_part *part) {
    double u, v;
    const double(*p)[3] = part->corners;
    const outer_box box = box_of_part(part);
    if (box_is_far(s, &box) || plane_is_far(s, p)) return;
    double squared = closest_point_triangle(s->x, p[0], p[1], p[2], &u, &v);
    if (!(squared < s->best.squared || (squared == s->best.squared && triangle < s->best.triangle))) return;
    s->best.squared = squared;
    s->best.triangle = triangle;
    s->best.part = *part;
    for (int k = 0; k < 3; k++) s->best.x[k] = p[0][k] + u * (p[1][k] - p[0][k]) + v * (p[2][k] - p[0][k]);
}

static void try_parts(nearest_search *s, uint32_t triangle, size_t cut) {
    const outer_surface *o = s->outer;
    if (o->part_begins[cut] == o->part_begins[cut + 1] || box_is_far(s, &o->boxes[cut])) return;
    for (size_t i = o->part_begins[cut]; i < o->part_begins[cut + 1]; i++)
        try_part(s, triangle, &o->parts[i]);
}

void outer_surface_whole(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                         outer_part *out) {
    const named_surface *s = found->surface;
    for (uint32_t i = 0; i < 3; i++)
        scale_point(o, surface_corner(s->mesh, s->positions, triangle, i), out->corners[i]);
}

static void try_triangle(void *data, uint32_t triangle) {
    nearest_search *s = data;
    const named_surface *surface = s->found->surface;
    uint32_t place = s->outer->places[triangle];
    if (place == OUTER_NOWHERE) return;
    if (surface_body(surface, triangle) != s->body) return;
    if (place != OUTER_AS_A_WHOLE) {
        try_parts(s, triangle, place);
        return;
    }
    outer_part whole;
    outer_surface_whole(s->outer, s->found, triangle, &whole);
    try_part(s, triangle, &whole);
}

/* A squared distance that is a little more than that of a part, so that the part itself is found, and all others at the same
 * distance. */
static double squared_beyond(const double x[3], const outer_part *part) {
    const double(*p)[3] = part->corners;
    double u, v, size = vec3_squared_distance(p[0], p[1]) + vec3_squared_distance(p[0], p[2]);
    double squared = closest_point_triangle(x, p[0], p[1], p[2], &u, &v);
    return squared * (1.0 + 0x1p-20) + 0x1p-70 * size + DBL_MIN;
}

outer_point outer_surface_nearest_on(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                                     const double x[3]) {
    nearest_search s = {.outer = o,
                        .found = found,
                        .body = surface_body(found->surface, triangle),
                        .best = {.squared = (double)INFINITY, UINT32_MAX}};
    scale_point(o, x, s.x);
    try_triangle(&s, triangle);
    for (int k = 0; k < 3; k++) s.best.x[k] /= o->scale;
    return s.best;
}

outer_point outer_surface_nearest(const outer_surface *o, const surface_cuts *found, const bvh *f,
                                  uint32_t body, const double x[3], const outer_point *near) {
    nearest_search s = {
        .outer = o, .found = found, .body = body, .best = {.squared = (double)INFINITY, UINT32_MAX}};
    const surface_bodies *bodies = found->surface->bodies;
    const near_quest quest = {object_of_body(bodies, body), body, bodies != NULL ? bodies->components : NULL};
    scale_point(o, x, s.x);
    if (near != NULL && near->triangle != UINT32_MAX) s.best.squared = squared_beyond(s.x, &near->part);
    bvh_visit_near(f, &quest, x, &s.best.squared, try_triangle, &s);
    for (int k = 0; k < 3; k++) s.best.x[k] /= o->scale;
    return s.best;
}

double outer_part_distance(const outer_surface *o, const double x[3], const outer_part *part) {
    double scaled[3], u, v;
    scale_point(o, x, scaled);
    return sqrt(closest_point_triangle(scaled, part->corners[0], part->corners[1], part->corners[2], &u, &v));
}
