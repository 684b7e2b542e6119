/* The coplanarity cubics of many pairs. The twin of coplanarity.c: the same operations in the same order, so
 * its error bounds hold. */
#pragma once

#include "runtime/ccd/feature_pairs_simd.h"
#include "runtime/ccd/vectors_simd.h"

typedef struct vectors_x8 {
    f64w a[2][3], b[2][3], c[2][3]; /* as in point_vectors */
    f64w size_a[3], size_b[3], size_c[3];
} vectors_x8;

typedef struct cubics_x8 {
    f64w b[4], error;
} cubics_x8;

static inline void subtract_at_ends(const points_x8 *points, int to, int from, f64w out[2][3], f64w size[3]) {
    for (int k = 0; k < 3; k++) {
        out[0][k] = points->x0[to][k] - points->x0[from][k];
        out[1][k] = points->x1[to][k] - points->x1[from][k];
        size[k] = f64w_max(f64w_abs(out[0][k]), f64w_abs(out[1][k]));
    }
}

static inline void vectors_between(const points_x8 *points, cscd_contact_kind kind, vectors_x8 *out) {
    int vf = kind == CSCD_CONTACT_VF;
    subtract_at_ends(points, vf ? 2 : 1, vf ? 1 : 0, out->a, out->size_a);
    subtract_at_ends(points, 3, vf ? 1 : 2, out->b, out->size_b);
    subtract_at_ends(points, vf ? 0 : 2, vf ? 1 : 0, out->c, out->size_c);
}

static inline void cubics_of(const vectors_x8 *v, cubics_x8 *f) {
    f64w start[3], end[3], one[3], other[3], mixed[3], permanent = f64w_all(0.0);
    cross_x8(v->a[0], v->b[0], start);
    cross_x8(v->a[1], v->b[1], end);
    cross_x8(v->a[1], v->b[0], one);
    cross_x8(v->a[0], v->b[1], other);
    for (int k = 0; k < 3; k++) mixed[k] = one[k] + other[k];
    f->b[0] = dot_x8(start, v->c[0]);
    f->b[1] = (dot_x8(mixed, v->c[0]) + dot_x8(start, v->c[1])) / 3.0;
    f->b[2] = (dot_x8(mixed, v->c[1]) + dot_x8(end, v->c[0])) / 3.0;
    f->b[3] = dot_x8(end, v->c[1]);
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        permanent += v->size_c[k] * (v->size_a[y] * v->size_b[z] + v->size_a[z] * v->size_b[y]);
    }
    f->error = 24.0 * 0x1p-53 * permanent + 0x1p-1060;
}
