/* Equalizes charge densities: a value becomes the share of triangles that have no higher one. */
#include "preprocess/regions/equalize.h"
#include "src/core/sort.h"

#include <math.h>

typedef struct ranked {
    uint32_t component, triangle;
    double density;
} ranked;

/* Independent of the range, unlike a conversion to float. */
static double round_to_24_bits(double value) {
    int exponent;
    double mantissa = frexp(value, &exponent);
    return ldexp(nearbyint(ldexp(mantissa, 24)), exponent - 24);
}

/* The sort is stable and the items come by triangle, so ties stay in that order. */
static int compare_ranked(const void *a, const void *b) {
    const ranked *x = a, *y = b;
    if (x->component != y->component) return x->component < y->component ? -1 : 1;
    return (x->density > y->density) - (x->density < y->density);
}

static void rank_exactly(const ranked *items, uint32_t count, double *equalized) {
    for (uint32_t i = 0; i < count; i++) equalized[items[i].triangle] = (i + 1.0) / count;
}

cscd_status equalize(const cscd_mesh *mesh, const double *density, double *equalized) {
    cscd_context *context = mesh->context;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!isfinite(density[t]))
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "the charge density of triangle %u is %g; densities must be finite", t,
                                density[t]);
    }
    ranked *items, *scratch;
    array_list lists = {{ARRAY(items, mesh->triangle_count), ARRAY(scratch, mesh->triangle_count)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        items[t] = (ranked){mesh->triangle_components[t], t, round_to_24_bits(density[t])};
    sort_items(items, scratch, mesh->triangle_count, sizeof *items, compare_ranked);
    const ranked *first = items;
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        uint32_t count = mesh->components[c].triangle_count;
        rank_exactly(first, count, equalized);
        first += count;
    }
    context_free_all(context, lists);
    return CSCD_OK;
}
