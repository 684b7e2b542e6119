/* Compares the stiffness of triangles with that of their component. */
#include "preprocess/regions/stiffness.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>

static const double least_share = 1e-6;

typedef struct stiff_triangle {
    uint32_t component, triangle;
    double stiffness, area;
} stiff_triangle;

static int by_stiffness(const void *left, const void *right) {
    const stiff_triangle *x = left, *y = right;
    if (x->component != y->component) return x->component < y->component ? -1 : 1;
    if (x->stiffness != y->stiffness) return x->stiffness < y->stiffness ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* The median, by area, of the triangles of a component, which are in order. */
static double find_median(const stiff_triangle *items, uint32_t count) {
    double area = 0.0, below = 0.0;
    for (uint32_t i = 0; i < count; i++) area += items[i].area;
    uint32_t i = 0;
    while (i + 1 < count && (below += items[i].area) < 0.5 * area) i++;
    return items[i].stiffness;
}

/* Finds the shares of the triangles that are in order. */
static void find_shares(const stiff_triangle *items, uint32_t count, double *shares) {
    for (uint32_t first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && items[end].component == items[first].component) end++;
        const double median = find_median(items + first, end - first);
        for (uint32_t i = first; i < end; i++) {
            const float share = (float)fmin(1.0, items[i].stiffness / median);
            shares[items[i].triangle] = fmax((double)share, least_share);
        }
    }
}

cscd_status stiffness_shares(const cscd_mesh *mesh, const double *positions, const double *given,
                             double *shares) {
    const uint32_t count = mesh->triangle_count;
    stiff_triangle *items = context_reserve(mesh->context, 2 * (size_t)count, sizeof *items);
    if (items == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < count; t++)
        items[t] =
            (stiff_triangle){mesh->triangle_components[t], t, given[t], surface_area(mesh, positions, t)};
    sort_items(items, items + count, count, sizeof *items, by_stiffness);
    find_shares(items, count, shares);
    context_free(mesh->context, items);
    return CSCD_OK;
}

double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge) {
    double sum = 0.0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        sum += shares[mesh->edge_stars[i]];
    return sum / edge_star_size(mesh, edge);
}
