/* Curves along which surfaces touch, and no more: none of their pairs crosses, and what they bound has depth 0. */
#include "runtime/intersections/touching_curves.h"

typedef struct touching_work {
    const cscd_mesh *mesh;
    const surface_bodies *bodies;
    const cscd_patches *patches;
    const cscd_depths *depths;
} touching_work;

/* Has the patch a depth above 0 in the body? */
static bool patch_is_deep(const touching_work *w, uint32_t patch, uint32_t body) {
    size_t low = 0, high = w->depths->patch_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const cscd_patch_depth *at = &w->depths->patches[middle];
        if (at->patch < patch || (at->patch == patch && at->body < body))
            low = middle + 1;
        else
            high = middle;
    }
    if (low == w->depths->patch_count) return false;
    const cscd_patch_depth *found = &w->depths->patches[low];
    return found->patch == patch && found->body == body && w->depths->items[found->deepest].depth > 0.0;
}

/* The first item of a range whose vertex, or edge, is not below a number. */
static size_t find_item(const touching_work *w, size_t low, size_t high, bool of_edges, uint32_t number) {
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const cscd_depth *at = &w->depths->items[middle];
        if ((of_edges ? at->edge : at->vertex) < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool vertex_is_deep(const touching_work *w, uint32_t vertex, uint32_t body) {
    uint32_t patch = w->patches->vertex_patches[vertex];
    if (patch != UINT32_MAX) return patch_is_deep(w, patch, body);
    const cscd_depth *items = w->depths->items;
    size_t end = w->depths->vertex_count;
    for (size_t i = find_item(w, 0, end, false, vertex); i < end && items[i].vertex == vertex; i++) {
        if (items[i].body == body && items[i].depth > 0.0) return true;
    }
    return false;
}

static bool edge_is_deep(const touching_work *w, uint32_t edge, uint32_t body) {
    const cscd_depth *items = w->depths->items;
    size_t end = w->depths->count;
    for (size_t i = find_item(w, w->depths->vertex_count, end, true, edge); i < end && items[i].edge == edge;
         i++) {
        if (items[i].body == body && items[i].depth > 0.0) return true;
    }
    return false;
}

static bool point_is_deep(const touching_work *w, const cscd_curve_point *point) {
    if (point->edge == UINT32_MAX) return false;
    uint32_t body = body_of_triangle(w->bodies, w->mesh, point->triangle);
    const uint32_t *ends = w->mesh->edges[point->edge];
    return vertex_is_deep(w, ends[0], body) || vertex_is_deep(w, ends[1], body) ||
           edge_is_deep(w, point->edge, body);
}

void touching_curves_mark(curve_joiner *j, const named_surface *s, const cscd_intersection_pair *pairs,
                          const cscd_patches *patches, const cscd_depths *depths) {
    const touching_work work = {s->mesh, s->bodies, patches, depths};
    for (size_t i = 0; i < j->curve_count; i++) j->curves[i].touching = true;
    for (size_t i = 0; i < j->pair_count; i++) {
        if (pairs[i].kind == CSCD_INTERSECTION_CROSSING && j->pair_curves[i] != UINT32_MAX)
            j->curves[j->pair_curves[i]].touching = false;
    }
    for (size_t i = 0; i < j->curve_count; i++) {
        cscd_curve *curve = &j->curves[i];
        for (size_t k = 0; k < curve->point_count && curve->touching; k++)
            curve->touching = !point_is_deep(&work, &j->points[curve->first_point + k]);
    }
}
