/* Culling by orientation: regions, their detector points, the triangles' flags of an interval. */
#include "runtime/culling.h"

#include <string.h>

static bool allocate(culling *c) {
    cscd_context *context = c->context;
    size_t triangles = c->mesh->triangle_count, regions = c->region_count;
    c->triangle_regions = context_allocate(context, triangles, sizeof *c->triangle_regions);
    c->triangle_weights = context_allocate(context, triangles, sizeof *c->triangle_weights);
    c->detector_offsets = context_allocate(context, regions, sizeof *c->detector_offsets);
    c->detector_points = context_allocate(context, regions, sizeof *c->detector_points);
    c->facing = context_allocate(context, triangles, sizeof *c->facing);
    c->orientations = context_allocate(context, triangles, sizeof *c->orientations);
    c->earlier = context_allocate(context, triangles, sizeof *c->earlier);
    c->region_triangles = context_allocate(context, triangles, sizeof *c->region_triangles);
    c->region_offsets = context_allocate(context, regions + 1, sizeof *c->region_offsets);
    return c->triangle_regions != NULL && c->triangle_weights != NULL && c->detector_offsets != NULL &&
           c->detector_points != NULL && c->facing != NULL && c->orientations != NULL && c->earlier != NULL &&
           c->region_triangles != NULL && c->region_offsets != NULL;
}

/* Triangles sorted by region. */
static void list_triangles(culling *c) {
    uint32_t *next = c->region_offsets + 1, sum = 0; /* counts, then the next free places, at last the ends */
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) next[c->triangle_regions[t]]++;
    for (uint32_t r = 0; r < c->region_count; r++) {
        uint32_t size = next[r];
        next[r] = sum;
        sum += size;
    }
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++)
        c->region_triangles[next[c->triangle_regions[t]]++] = t;
}

cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out) {
    culling c = {.context = mesh->context, .mesh = mesh};
    c.region_count = plan != NULL ? plan->region_count : mesh->component_count;
    if (!allocate(&c)) {
        culling_destroy(&c);
        return CSCD_OUT_OF_MEMORY;
    }
    const uint32_t *regions = plan != NULL ? plan->triangle_regions : mesh->triangle_components;
    memcpy(c.triangle_regions, regions, mesh->triangle_count * sizeof *regions);
    for (uint32_t t = 0; plan == NULL && t < mesh->triangle_count; t++)
        c.triangle_weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    if (plan != NULL) {
        memcpy(c.triangle_weights, plan->triangle_weights, mesh->triangle_count * sizeof(double));
        memcpy(c.detector_offsets, plan->detector_offsets, c.region_count * sizeof *c.detector_offsets);
    }
    list_triangles(&c);
    culling_clear(&c);
    *out = c;
    return CSCD_OK;
}

void culling_destroy(culling *c) {
    void *blocks[] = {c->triangle_regions, c->triangle_weights, c->detector_offsets,
                      c->detector_points,  c->facing,           c->orientations,
                      c->earlier,          c->region_triangles, c->region_offsets};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(c->context, blocks[i]);
    *c = (culling){0};
}

void culling_clear(culling *c) {
    memset(c->facing, ORIENTATION_ZERO, c->mesh->triangle_count);
    memset(c->orientations, ORIENTATION_ZERO, c->mesh->triangle_count);
    c->plus = c->minus = 0;
}

/* ---- one interval ---------------------------------------------------------------------------------- */

typedef struct orienting {
    culling *culling;
    const double *x0, *x1;
    culled_set culled;
} orienting;

/* The mean of the region's triangles, by their weights at rest, and the offset: any point is sound, so
 * rounding does not matter, but both ends are those of one linear motion by definition. */
static void place_detector_point(const culling *c, uint32_t region, const double *x, double out[3]) {
    memcpy(out, c->detector_offsets[region], sizeof(double[3]));
    for (uint32_t i = c->region_offsets[region]; i < c->region_offsets[region + 1]; i++) {
        uint32_t t = c->region_triangles[i];
        const uint32_t *corners = c->mesh->triangles[t];
        double weight = c->triangle_weights[t] / 3.0;
        for (int k = 0; k < 3; k++)
            out[k] +=
                weight * (x[(size_t)corners[0] * 3 + (size_t)k] + x[(size_t)corners[1] * 3 + (size_t)k] +
                          x[(size_t)corners[2] * 3 + (size_t)k]);
    }
}

static void orient_share(void *data, uint32_t index) {
    const orienting *o = data;
    culling *c = o->culling;
    size_t count = c->mesh->triangle_count, lanes = parallel_thread_count(c->context->threads);
    for (size_t t = count * index / lanes; t < count * (index + 1) / lanes; t++) {
        bool clean = o->culled.states == NULL || o->culled.states[t] == TRIANGLE_CLEAN;
        if (clean && o->culled.components[c->mesh->triangle_components[t]])
            c->facing[t] = orientation_of(c->mesh->triangles[t], o->x0, o->x1,
                                          &c->detector_points[c->triangle_regions[t]]);
        else
            c->facing[t] = ORIENTATION_ZERO;
        c->orientations[t] = c->facing[t];
    }
}

void culling_orient(culling *c, const double *x0, const double *x1, culled_set culled, bool still) {
    orienting o = {c, x0, x1, culled};
    for (uint32_t r = 0; r < c->region_count; r++) {
        place_detector_point(c, r, x0, c->detector_points[r].start);
        place_detector_point(c, r, still ? x0 : x1, c->detector_points[r].end);
    }
    parallel_run(c->context->threads, parallel_thread_count(c->context->threads), orient_share, &o);
    c->plus = c->minus = 0;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        c->plus += c->facing[t] == ORIENTATION_PLUS;
        c->minus += c->facing[t] == ORIENTATION_MINUS;
    }
}

void culling_pass_done(culling *c) {
    memcpy(c->earlier, c->orientations, c->mesh->triangle_count);
}
