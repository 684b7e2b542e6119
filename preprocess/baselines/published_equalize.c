/* Histogram equalization as published (Yeh 2012, equation 3.18): 256 bins, and the share of triangles up to each. */
#include "preprocess/baselines/published_cuts.h"

#include <math.h>

enum { BIN_COUNT = 256 };

/* Of one component. */
typedef struct histogram {
    double low, high;
    uint32_t cumulative[BIN_COUNT]; /* triangles in each bin and those below */
} histogram;

/* Halves avoid an overflow of the range; equal densities all go to the first bin. */
static uint32_t bin_of(const histogram *h, double density) {
    const double range = 0.5 * h->high - 0.5 * h->low;
    if (!(range > 0.0)) return 0;
    const uint32_t bin = (uint32_t)((0.5 * density - 0.5 * h->low) / range * BIN_COUNT);
    return bin < BIN_COUNT ? bin : BIN_COUNT - 1;
}

static histogram count_densities(const double *density, const uint32_t *triangles, uint32_t count) {
    histogram h = {.low = INFINITY, .high = -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        h.low = fmin(h.low, density[triangles[i]]);
        h.high = fmax(h.high, density[triangles[i]]);
    }
    for (uint32_t i = 0; i < count; i++) h.cumulative[bin_of(&h, density[triangles[i]])]++;
    for (uint32_t bin = 1; bin < BIN_COUNT; bin++) h.cumulative[bin] += h.cumulative[bin - 1];
    return h;
}

cscd_status published_equalize(const cscd_mesh *mesh, const double *density, double *equalized) {
    cscd_context *context = mesh->context;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (!isfinite(density[t]))
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "the charge density of triangle %u is %g; densities must be finite", t,
                                density[t]);
    }
    uint32_t *list, *offsets;
    array_list lists = {
        {ARRAY(list, mesh->triangle_count), ARRAY(offsets, (size_t)mesh->component_count + 1)}};
    if (!context_allocate_all(context, lists)) return context_out_of_memory(context);
    mesh_list_by_component(mesh, list, offsets);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        const uint32_t *triangles = list + offsets[c], count = offsets[c + 1] - offsets[c];
        const histogram h = count_densities(density, triangles, count);
        for (uint32_t i = 0; i < count; i++)
            equalized[triangles[i]] = (double)h.cumulative[bin_of(&h, density[triangles[i]])] / count;
    }
    context_free_all(context, lists);
    return CSCD_OK;
}
