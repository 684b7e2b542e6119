/* Whether the scalars of views lie on each other: such positions cannot be written, and are read wrongly. */
#include "src/mesh/view_overlap.h"

static ptrdiff_t place_of(const view_grid *g, uint32_t vertex, uint32_t coordinate) {
    return (ptrdiff_t)(vertex * g->stride + coordinate * g->coordinate_stride);
}

/* The bytes from b's data to a's, which may be parts of different arrays. */
static ptrdiff_t distance_of(const view_grid *a, const view_grid *b) {
    return (ptrdiff_t)((uintptr_t)a->data - (uintptr_t)b->data);
}

static bool set_clash(view_clash *out, uint32_t i, uint32_t k, uint32_t j, uint32_t l) {
    *out = (view_clash){.vertices = {i, j}, .coordinates = {k, l}};
    return true;
}

/* ---- equal strides ------------------------------------------------------------------------------------- */

/* Do a scalar of the coordinate k of a and one of the coordinate l of b overlap? Scalar i of a begins
 * apart = distance + (i - j) stride bytes behind scalar j of b; they overlap when that is below the size of b's and
 * above minus the size of a's. The steps i - j next to apart = 0 decide. */
static bool steps_clash(const view_grid *a, uint32_t k, const view_grid *b, uint32_t l, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b) + place_of(a, 0, k) - place_of(b, 0, l);
    ptrdiff_t stride = (ptrdiff_t)a->stride, nearest = -distance / stride;
    ptrdiff_t least = 1 - (ptrdiff_t)b->vertex_count, most = (ptrdiff_t)a->vertex_count - 1;
    nearest = nearest < least ? least : nearest > most ? most : nearest;
    for (ptrdiff_t steps = nearest - 1; steps <= nearest + 1; steps++) {
        ptrdiff_t apart = distance + steps * stride;
        if (steps < least || steps > most || apart >= (ptrdiff_t)b->scalar_size ||
            -apart >= (ptrdiff_t)a->scalar_size)
            continue;
        return set_clash(out, steps > 0 ? (uint32_t)steps : 0, k, steps < 0 ? (uint32_t)-steps : 0, l);
    }
    return false;
}

bool view_overlaps_itself(const view_grid *g, view_clash *out) {
    if (g->vertex_count > 1 && g->stride < g->scalar_size) return set_clash(out, 0, 0, 1, 0);
    for (uint32_t k = 0; k < 2; k++) {
        for (uint32_t l = k + 1; l < 3; l++) {
            if (steps_clash(g, k, g, l, out)) return true;
        }
    }
    return false;
}

/* ---- any strides --------------------------------------------------------------------------------------- */

/* The same for different strides: both rows of scalars are walked along from their beginnings. */
static bool rows_clash(const view_grid *a, uint32_t k, const view_grid *b, uint32_t l, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b);
    uint32_t i = 0, j = 0;
    while (i < a->vertex_count && j < b->vertex_count) {
        ptrdiff_t apart = distance + place_of(a, i, k) - place_of(b, j, l);
        if (apart >= (ptrdiff_t)b->scalar_size)
            j++;
        else if (-apart >= (ptrdiff_t)a->scalar_size)
            i++;
        else
            return set_clash(out, i, k, j, l);
    }
    return false;
}

static ptrdiff_t extent_of(const view_grid *g) {
    return place_of(g, g->vertex_count - 1, 2) + (ptrdiff_t)g->scalar_size;
}

bool views_overlap(const view_grid *a, const view_grid *b, view_clash *out) {
    ptrdiff_t distance = distance_of(a, b);
    if (distance >= extent_of(b) || -distance >= extent_of(a)) return false;
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t l = 0; l < 3; l++) {
            if (a->stride == b->stride ? steps_clash(a, k, b, l, out) : rows_clash(a, k, b, l, out))
                return true;
        }
    }
    return false;
}
