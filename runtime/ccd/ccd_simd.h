/* Shared by the kernels: their names on the level that is compiled, products of vectors, and as many pairs
 * as the processor takes at once, as vectors of their points. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "src/core/simd_wide.h"

/* ---- kernels that other files have --------------------------------------------------------------------- */

describe_kernel SIMD_NAME(describe_vf), SIMD_NAME(describe_ee);
proximity_kernel SIMD_NAME(proximity_vf), SIMD_NAME(proximity_ee);
nearest_kernel SIMD_NAME(nearest_vf), SIMD_NAME(nearest_ee);

/* ---- products of many vectors of three doubles, summed up from left to right as in vec3.h -------------- */

static inline void cross_x8(const f64w a[3], const f64w b[3], f64w out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline f64w dot_x8(const f64w a[3], const f64w b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

typedef struct points_x8 {
    f64w x0[4][3], x1[4][3]; /* points as in elementary_query, then coordinates */
} points_x8;

static inline void name_points(const feature_source *source, cscd_contact_kind kind, const uint32_t *a,
                               const uint32_t *b, uint32_t vertices[4][WIDTH]) {
    for (int lane = 0; lane < WIDTH; lane++) {
        if (kind == CSCD_CONTACT_VF) {
            const uint32_t *corners = source->triangles[b[lane]];
            vertices[0][lane] = a[lane];
            for (int i = 0; i < 3; i++) vertices[1 + i][lane] = corners[i];
        } else {
            const uint32_t *ends_a = source->edges[a[lane]], *ends_b = source->edges[b[lane]];
            for (int i = 0; i < 2; i++) {
                vertices[i][lane] = ends_a[i];
                vertices[2 + i][lane] = ends_b[i];
            }
        }
    }
}

static inline void load_features(const feature_source *source, cscd_contact_kind kind, const uint32_t *a,
                                 const uint32_t *b, points_x8 *out) {
    uint32_t vertices[4][WIDTH];
    name_points(source, kind, a, b, vertices);
    for (int i = 0; i < 4; i++) {
        f64w_load_points(source->x0, vertices[i], out->x0[i]);
        f64w_load_points(source->x1, vertices[i], out->x1[i]);
    }
}

/* Loads x0 alone. */
static inline void load_features_at_start(const feature_source *source, cscd_contact_kind kind,
                                          const uint32_t *a, const uint32_t *b, points_x8 *out) {
    uint32_t vertices[4][WIDTH];
    name_points(source, kind, a, b, vertices);
    for (int i = 0; i < 4; i++) f64w_load_points(source->x0, vertices[i], out->x0[i]);
}

/* Decides the pairs i to i + WIDTH - 1 of the eight. */
typedef void decide_some(const points_x8 *points, cscd_contact_kind kind, int i, root_outcomes *out);

static inline void decide_eight(const feature_source *source, const uint32_t *a, const uint32_t *b,
                                cscd_contact_kind kind, decide_some *decide, root_outcomes *out) {
    out->apart = out->contacts = 0;
    for (int i = 0; i < LANES; i += WIDTH) {
        points_x8 points;
        load_features(source, kind, a + i, b + i, &points);
        decide(&points, kind, i, out);
    }
}
