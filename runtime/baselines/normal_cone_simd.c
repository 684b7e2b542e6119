/* Continuous normal cones of triangles and of their unions, eight at a time. */
#include "runtime/baselines/patches.h"

#include "src/core/simd.h"

/* Rounding adds less to an angle per operation on cones: directions 8, lengths of axes 11, and the rest 15 times 2^-24. */
static const float slack = 4e-6f;

/* ---- angles ------------------------------------------------------------------------------------------------ */

/* Returns upper bounds of the angles between unit vectors up to a right angle, and the lanes where it is more. With the
 * chord c it is 2 asin(c / 2) = c + c^3 / 24 + ...; the quotient of the rest by c^3 grows to 0.055361 at c = sqrt 2. */
static f32x8 angles_between(const f32x8 a[3], const f32x8 b[3], uint32_t *wide) {
    f32x8 squared = f32x8_all(0.0f);
    for (int k = 0; k < 3; k++) squared += (a[k] - b[k]) * (a[k] - b[k]);
    *wide = f32x8_below(f32x8_all(2.0f), squared);
    return f32x8_sqrt(squared) * (f32x8_all(1.0f) + f32x8_all(0.05537f) * squared);
}

/* Makes the sums unit vectors; returns the lanes in which they are long enough. */
static uint32_t normalize_sums(f32x8 sum[3]) {
    f32x8 squared = sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2];
    f32x8 inverse = f32x8_all(1.0f) / f32x8_sqrt(squared);
    for (int k = 0; k < 3; k++) sum[k] *= inverse;
    return f32x8_below(f32x8_all(1e-6f), squared);
}

/* There is no cone in lanes that are not in `exist`. */
static void store_cones(f32x8 axis[3], f32x8 angle, uint32_t exist, normal_cone out[LANES]) {
    for (int lane = 0; lane < LANES; lane++) {
        normal_cone *cone = &out[lane];
        bool exists = (exist >> lane & 1) != 0;
        for (int k = 0; k < 3; k++) cone->axis[k] = exists ? axis[k][lane] : 0.0f;
        cone->angle = exists ? angle[lane] : INFINITY;
    }
}

/* ---- triangles --------------------------------------------------------------------------------------------- */

/* The two edges of each triangle from its first corner. */
typedef struct edges_x8 {
    f64x8 first[3], second[3];
} edges_x8;

static edges_x8 load_edges(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x) {
    f64x8 corners[3][3];
    edges_x8 e;
    for (int i = 0; i < 3; i++) {
        uint32_t vertices[LANES];
        for (int lane = 0; lane < LANES; lane++) vertices[lane] = triangles[which[lane]][i];
        f64x8_load_points(x, vertices, corners[i]);
    }
    for (int k = 0; k < 3; k++) {
        e.first[k] = corners[1][k] - corners[0][k];
        e.second[k] = corners[2][k] - corners[0][k];
    }
    return e;
}

static f64x8 dot_f64x8(const f64x8 a[3], const f64x8 b[3]) {
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/* Adds a x b to sum: a component of it is off by less than 2^-50 of |a| |b|. */
static void add_cross(const f64x8 a[3], const f64x8 b[3], f64x8 sum[3]) {
    for (int k = 0; k < 3; k++) sum[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Computes the directions of vectors that are off by 2^-48 size at most. squared_size: of size, or more. Returns the lanes in
 * which that turns them by less than 4e-7, and in which their squares stay in the range of doubles. */
static uint32_t directions_of(const f64x8 normal[3], f64x8 squared_size, f32x8 out[3]) {
    const f64x8 squared = dot_f64x8(normal, normal), inverse = f64x8_all(1.0) / f64x8_sqrt(squared);
    for (int k = 0; k < 3; k++) out[k] = f32x8_from(normal[k] * inverse);
    return f64x8_below(f64x8_all(1e-16) * squared_size, squared) & f64x8_below(f64x8_all(1e-300), squared) &
           f64x8_below(squared, f64x8_all(1e300));
}

/* The normals at the start, at the end, and the Bernstein vector between them. */
static uint32_t load_directions(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                                const double *x1, int count, f32x8 (*out)[3]) {
    edges_x8 start = load_edges(triangles, which, x0), end = load_edges(triangles, which, x1);
    f64x8 normals[3][3], sizes[3];
    for (int i = 0; i < 9; i++) normals[i / 3][i % 3] = f64x8_all(0.0);
    add_cross(start.first, start.second, normals[0]);
    add_cross(end.first, end.second, normals[1]);
    add_cross(start.first, end.second, normals[2]);
    add_cross(end.first, start.second, normals[2]);
    const f64x8 first[2] = {dot_f64x8(start.first, start.first), dot_f64x8(end.first, end.first)};
    const f64x8 second[2] = {dot_f64x8(start.second, start.second), dot_f64x8(end.second, end.second)};
    for (int i = 0; i < 2; i++) sizes[i] = first[i] * second[i];
    sizes[2] = f64x8_all(2.0) * (first[0] * second[1] + first[1] * second[0]); /* at least (a + b)^2 */
    uint32_t good = ALL_LANES;
    for (int i = 0; i < count; i++) good &= directions_of((const f64x8 *)normals[i], sizes[i], out[i]);
    return good;
}

/* The largest of the angles between the axis and directions. Lanes in which one is more than a right angle leave *exist. */
static f32x8 widest_angle(const f32x8 axis[3], f32x8 (*directions)[3], int count, uint32_t *exist) {
    f32x8 angle = f32x8_all(slack);
    for (int i = 0; i < count; i++) {
        uint32_t wide;
        angle =
            f32x8_max(angles_between(axis, (const f32x8 *)directions[i], &wide) + f32x8_all(slack), angle);
        *exist &= ~wide;
    }
    return angle;
}

static void cones_of_triangles(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                               const double *x1, bool published, normal_cone out[LANES]) {
    int count = published ? 2 : 3;
    f32x8 directions[3][3], axis[3];
    uint32_t exist = load_directions(triangles, which, x0, x1, count, directions);
    for (int k = 0; k < 3; k++) {
        axis[k] = directions[0][k];
        for (int i = 1; i < count; i++) axis[k] += directions[i][k];
    }
    exist &= normalize_sums(axis);
    const f32x8 angle = widest_angle(axis, directions, count, &exist);
    if (!published) exist &= f32x8_below(angle, f32x8_all(normal_cone_limit));
    store_cones(axis, angle, exist, out);
}

/* The axis is the mean direction of the vectors of all eight. */
static void cone_of_eight(const uint32_t (*triangles)[3], const uint32_t which[LANES], const double *x0,
                          const double *x1, normal_cone *out) {
    f32x8 directions[3][3], axis[3];
    uint32_t exist = load_directions(triangles, which, x0, x1, 3, directions);
    for (int k = 0; k < 3; k++) {
        const f32x8 lanes = directions[0][k] + directions[1][k] + directions[2][k];
        float sum = 0.0f;
        for (int lane = 0; lane < LANES; lane++) sum += lanes[lane];
        axis[k] = f32x8_all(sum);
    }
    exist &= normalize_sums(axis);
    const f32x8 angle = widest_angle(axis, directions, 3, &exist);
    exist &= f32x8_below(angle, f32x8_all(normal_cone_limit));
    *out = (normal_cone){{0.0f, 0.0f, 0.0f}, INFINITY};
    if (exist != ALL_LANES) return;
    for (int k = 0; k < 3; k++) out->axis[k] = axis[k][0];
    out->angle = angle[0];
    for (int lane = 1; lane < LANES; lane++) out->angle = out->angle < angle[lane] ? angle[lane] : out->angle;
}

/* ---- unions ------------------------------------------------------------------------------------------------ */

static f32x8 load_cones(const normal_cone *cones, const uint32_t which[LANES], f32x8 axis[3]) {
    f32x8 angle;
    for (int lane = 0; lane < LANES; lane++) {
        const normal_cone *cone = &cones[which[lane]];
        for (int k = 0; k < 3; k++) axis[k][lane] = cone->axis[k];
        angle[lane] = cone->angle;
    }
    return angle;
}

static void cones_of_unions(const normal_cone *cones, const uint32_t a[LANES], const uint32_t b[LANES],
                            float limit, normal_cone out[LANES]) {
    f32x8 axis_a[3], axis_b[3], axis[3], most = f32x8_all(limit);
    f32x8 angle_a = load_cones(cones, a, axis_a), angle_b = load_cones(cones, b, axis_b);
    uint32_t wide_a, wide_b, exist = f32x8_below(angle_a, most) & f32x8_below(angle_b, most);
    for (int k = 0; k < 3; k++) axis[k] = axis_a[k] + axis_b[k];
    exist &= normalize_sums(axis);
    f32x8 to_a = angles_between(axis, axis_a, &wide_a) + angle_a;
    f32x8 to_b = angles_between(axis, axis_b, &wide_b) + angle_b;
    f32x8 angle = f32x8_max(to_a, to_b) + f32x8_all(slack);
    exist &= ~(wide_a | wide_b) & f32x8_below(angle, most);
    store_cones(axis, angle, exist, out);
}

const normal_cone_kernels SIMD_NAME(normal_cone_kernels) = {cones_of_triangles, cone_of_eight,
                                                            cones_of_unions};
