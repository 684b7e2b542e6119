/* The outer surfaces of bodies: what they do not bury in themselves. */
#include "runtime/depths/outer_surface.h"

#include "src/core/vec3.h"
#include "src/mesh/surface.h"

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
    context_free(o->context, o->part_boxes);
    context_free(o->context, o->run_boxes);
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

static void box_parts(outer_box *box, const outer_box *parts, size_t count) {
    *box = empty_box();
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            box->low[k] = min_of(box->low[k], parts[i].low[k]);
            box->high[k] = max_of(box->high[k], parts[i].high[k]);
        }
    }
}

static bool add_part(outer_surface *o, const outer_part *part) {
    if (!memory_budget_take(o->budget, 1, MEMORY_WHILE_DOUBLING * (sizeof *part + sizeof *o->part_boxes)))
        return false;
    if (o->part_count == o->part_capacity) {
        size_t larger = o->part_capacity == 0 ? 64 : 2 * o->part_capacity;
        outer_part *parts = context_grow(o->context, o->parts, o->part_count, larger, sizeof *parts);
        if (parts != NULL) o->parts = parts;
        outer_box *boxes = context_grow(o->context, o->part_boxes, o->part_count, larger, sizeof *boxes);
        if (boxes != NULL) o->part_boxes = boxes;
        if (parts == NULL || boxes == NULL) return false;
        o->part_capacity = larger;
    }
    o->part_boxes[o->part_count] = box_of_part(part);
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
    box_parts(&o->boxes[o->cut_count - 1], o->part_boxes + first, o->part_count - first);
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

/* Does the triangle's own body cut it? */
static bool cuts_itself(const triangle_cuts *c, const surface_cuts *found, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
        const curve_piece *piece = &found->curves->found[c->keys[i].end / 2];
        if (surface_body(found->surface, piece->a) == surface_body(found->surface, piece->b)) return true;
    }
    return false;
}

static bool box_runs(outer_surface *o) {
    const size_t count = (o->part_count + OUTER_RUN - 1) / OUTER_RUN;
    const array_list list = {{ARRAY(o->run_boxes, room_with_spare(count))}};
    if (!memory_budget_take_all(o->budget, list)) return false;
    if (!context_renew_all(o->context, list, &o->run_capacity, count)) return false;
    for (size_t i = 0; i < count; i++) {
        const size_t first = i * OUTER_RUN, left = o->part_count - first;
        box_parts(&o->run_boxes[i], o->part_boxes + first, left < OUTER_RUN ? left : OUTER_RUN);
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
        if (!cuts_itself(c, found, begin, end)) continue;
        if (!triangle_cuts_load(c, found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !divide_triangle(o, found, &cut)) return false;
    }
    o->part_begins[o->cut_count] = o->part_count;
    return box_runs(o) && find_places(o, found);
}

bool outer_surface_take_work(const outer_surface *o, size_t points) {
    const size_t parts = o->cut_count > 0 ? o->part_count / o->cut_count : 0;
    return memory_budget_work(o->budget, points, 1 + (uint64_t)parts);
}

void outer_surface_whole(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                         outer_part *out) {
    const named_surface *s = found->surface;
    for (uint32_t i = 0; i < 3; i++)
        scale_point(o, surface_corner(s->mesh, s->positions, triangle, i), out->corners[i]);
}
