/* Finds the vertices that are one at one moment: those that seams unite, and that are at one place. Most are
 * where the vertex of their name is; the others are sorted by their places. */
#include "runtime/intersections/intersections.h"

#include "src/core/context.h"
#include "src/core/sort.h"

#include <string.h>

static array_list list_of_parted(placed_names *p, size_t count) {
    return (array_list){{ARRAY(p->parted, count), ARRAY(p->spare, count)}};
}

void placed_names_free(placed_names *p) {
    if (p->context == NULL) return;
    context_free_all(p->context, list_of_parted(p, 0));
    context_free(p->context, p->names);
    *p = (placed_names){.context = p->context};
}

static bool are_at_one_place(const double *x, const double *y) {
    return x[0] == y[0] && x[1] == y[1] && x[2] == y[2];
}

static bool is_parted(const double *positions, const uint32_t *names, uint32_t vertex) {
    return names[vertex] != vertex &&
           !are_at_one_place(positions + (size_t)vertex * 3, positions + (size_t)names[vertex] * 3);
}

/* By names, then by places, then by numbers. */
static int compare_parted(const void *a, const void *b) {
    const parted_vertex *p = a, *q = b;
    if (p->name != q->name) return p->name < q->name ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (p->x[k] != q->x[k]) return p->x[k] < q->x[k] ? -1 : 1;
    return (p->vertex > q->vertex) - (p->vertex < q->vertex);
}

static size_t list_parted(placed_names *p, const double *positions, const uint32_t *names, uint32_t count) {
    size_t found = 0;
    for (uint32_t v = 0; v < count; v++) {
        if (!is_parted(positions, names, v)) continue;
        parted_vertex *parted = &p->parted[found++];
        *parted = (parted_vertex){.name = names[v], .vertex = v};
        memcpy(parted->x, positions + (size_t)v * 3, sizeof parted->x);
    }
    return found;
}

static void name_parted(placed_names *p, size_t count) {
    sort_items(p->parted, p->spare, count, sizeof *p->parted, compare_parted);
    for (size_t i = 0; i < count; i++) {
        const parted_vertex *last = i > 0 ? &p->parted[i - 1] : NULL, *here = &p->parted[i];
        bool joins = last != NULL && last->name == here->name && are_at_one_place(last->x, here->x);
        p->names[here->vertex] = joins ? p->names[last->vertex] : here->vertex;
    }
}

bool placed_names_find(placed_names *p, const cscd_mesh *mesh, const double *positions, const uint32_t *names,
                       const uint32_t **out) {
    size_t parted = 0;
    *out = NULL;
    if (names == NULL) return true;
    if (p->names == NULL) p->names = context_reserve(p->context, mesh->vertex_count, sizeof *p->names);
    if (p->names == NULL) return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) parted += is_parted(positions, names, v);
    if (!context_renew_all(p->context, list_of_parted(p, room_with_spare(parted)), &p->parted_capacity,
                           parted))
        return false;
    memcpy(p->names, names, mesh->vertex_count * sizeof *p->names);
    name_parted(p, list_parted(p, positions, names, mesh->vertex_count));
    *out = p->names;
    return true;
}
