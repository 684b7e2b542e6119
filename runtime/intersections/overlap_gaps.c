/* The overlaps that have no volume, since a piece of a curve that bounds them was found and then left out. */
#include "runtime/intersections/named_surface.h"

#include "src/core/sort.h"

/* ---- gaps ---------------------------------------------------------------------------------------------- */

void left_out_pairs_free(left_out_pairs *p) {
    if (p->context == NULL) return;
    context_free(p->context, p->pairs);
    *p = (left_out_pairs){.context = p->context};
}

void left_out_pairs_add(left_out_pairs *p, uint32_t a, uint32_t b) {
    if (p->count == p->capacity) {
        size_t larger = p->capacity == 0 ? 64 : 2 * p->capacity;
        uint64_t *grown = context_grow(p->context, p->pairs, p->count, larger, sizeof *grown);
        if (grown == NULL) {
            p->out_of_memory = true;
            return;
        }
        p->pairs = grown;
        p->capacity = larger;
    }
    p->pairs[p->count++] = (uint64_t)a << 32 | b;
}

static array_list list_of_gaps(overlap_gaps *g, size_t count) {
    return (array_list){{ARRAY(g->bodies, count), ARRAY(g->spare, count)}};
}

void overlap_gaps_free(overlap_gaps *g) {
    if (g->context == NULL) return;
    context_free_all(g->context, list_of_gaps(g, 0));
    *g = (overlap_gaps){.context = g->context};
}

static bool is_closed(const cscd_mesh *mesh, uint32_t triangle) {
    return mesh->components[mesh->triangle_components[triangle]].closed_manifold;
}

static void add_left_out(overlap_gaps *g, const named_surface *s, const left_out_pairs *left_out) {
    const cscd_mesh *mesh = s->mesh;
    for (size_t i = 0; i < left_out->count; i++) {
        uint32_t a = (uint32_t)(left_out->pairs[i] >> 32), b = (uint32_t)left_out->pairs[i];
        curve_piece piece;
        if (!is_closed(mesh, a) || !is_closed(mesh, b) || !curve_piece_of_pair(s, a, b, &piece)) continue;
        g->bodies[g->count++] = key_of_bodies(surface_body(s, a), surface_body(s, b));
    }
}

static void add_open_curves(overlap_gaps *g, const named_surface *s, const curve_joiner *j) {
    const cscd_mesh *mesh = s->mesh;
    for (size_t i = 0; i < j->curve_count; i++) {
        const cscd_curve *c = &j->curves[i];
        if (c->start != CSCD_CURVE_END_LEFT_OUT && c->end != CSCD_CURVE_END_LEFT_OUT) continue;
        if (mesh->components[c->components[0]].closed_manifold &&
            mesh->components[c->components[1]].closed_manifold)
            g->bodies[g->count++] = key_of_bodies(curve_body(s, c, 0), curve_body(s, c, 1));
    }
}

bool overlap_gaps_find(overlap_gaps *g, const surface_cuts *found, const left_out_pairs *left_out) {
    size_t most = left_out->count + found->curves->curve_count;
    if (!memory_budget_take(found->budget, left_out->count,
                            MEMORY_WHILE_DOUBLING * sizeof *left_out->pairs) ||
        !memory_budget_take_all(found->budget, list_of_gaps(g, room_with_spare(most))))
        return false;
    if (!context_renew_all(g->context, list_of_gaps(g, room_with_spare(most)), &g->capacity, most))
        return false;
    g->count = 0;
    add_left_out(g, found->surface, left_out);
    add_open_curves(g, found->surface, found->curves);
    sort_by_number(g->bodies, g->spare, g->count, sizeof *g->bodies);
    return true;
}

static bool have_key(const overlap_gaps *g, uint64_t key) {
    size_t low = 0, high = g->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (g->bodies[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < g->count && g->bodies[low] == key;
}

bool overlap_gaps_have(const overlap_gaps *g, uint32_t a, uint32_t b) {
    return have_key(g, key_of_bodies(a, b)) || have_key(g, key_of_bodies(a, a)) ||
           have_key(g, key_of_bodies(b, b));
}
