/* Copy-in: turns the caller's positions at both ends into records of floats in the order of the leaves. */
#include "runtime/bvh/bvh_kernels_simd.h"
#include "src/core/simd_lanes.h"

static void load_scaled(const double *x, const uint32_t *vertices, const double origin[3], double scale,
                        f64x8 out[3]) {
    f64x8_load_points(x, vertices, out);
    for (int k = 0; k < 3; k++) out[k] = (out[k] - f64x8_all(origin[k])) * f64x8_all(scale);
}

static void store_records(f64x8 start[3], f64x8 end[3], float (*records)[8]) {
    f32x8 rows[8];
    for (int k = 0; k < 3; k++) {
        rows[k] = f32x8_from(start[k]);
        rows[4 + k] = f32x8_from(end[k]);
    }
    rows[3] = rows[7] = f32x8_all(0.0f);
    f32x8_transpose(rows);
    for (int i = 0; i < LANES; i++) f32x8_store(records[i], rows[i]);
}

static double sum_of(f64x8 v) {
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

void SIMD_NAME(copy_in)(const bvh *hierarchy, const bvh_tree *tree, uint32_t begin, uint32_t end,
                        const double *x0, const double *x1, copied *out) {
    f64x8 reach = f64x8_all(0.0), start_sum[3], end_sum[3];
    for (int k = 0; k < 3; k++) start_sum[k] = end_sum[k] = f64x8_all(0.0);
    for (uint32_t i = begin; i < end; i += LANES) {
        f64x8 start[3], stop[3], weight = f64x8_from(f32x8_load(hierarchy->record_weights + i));
        load_scaled(x0, hierarchy->record_vertices + i, tree->origin[0], hierarchy->scale, start);
        load_scaled(x1, hierarchy->record_vertices + i, tree->origin[1], hierarchy->scale, stop);
        for (int k = 0; k < 3; k++) {
            reach = f64x8_max(reach, f64x8_max(f64x8_abs(start[k]), f64x8_abs(stop[k])));
            start_sum[k] += weight * start[k];
            end_sum[k] += weight * stop[k];
        }
        store_records(start, stop, hierarchy->records + i);
    }
    out->reach = 0.0;
    for (int i = 0; i < LANES; i++) out->reach = reach[i] > out->reach ? reach[i] : out->reach;
    for (int k = 0; k < 3; k++) {
        out->weighted[0][k] = sum_of(start_sum[k]);
        out->weighted[1][k] = sum_of(end_sum[k]);
    }
}
