/* What is told of a touch: a time that is safe to step to, the points, the normal. */
#include "runtime/contact_frame.h"

#include "runtime/closest.h"
#include "runtime/cubic.h"
#include "runtime/vector.h"

/* Positions at a time, computed and rounded to doubles by whoever steps there, are off by at most 2 units in
 * the last place of the largest coordinate C, 2^-52 C each: with four points in the gap, two on either side
 * of it, and the diagonal of the cube, by less than 2 * 2 * sqrt(3) * 2^-52 C < 2^-49 C along the normal.
 * Twice that is left open. */
static const double gap_left = 0x1p-48;
static const double earlier_at_most = 0x1p-32;

static double largest_coordinate(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++)
        largest = larger(largest, larger(vector_largest(query->x0[i]), vector_largest(query->x1[i])));
    return largest;
}

static double largest_offset(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = larger(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = larger(largest, fabs(query->x1[i][k] - query->x0[0][k]));
        }
    }
    return largest;
}

/* The same query relative to its first point and scaled by a power of two to an extent in [1/2, 1), so that
 * no later product over- or underflows. Returns the scale. */
static double normalise(const elementary_query *query, elementary_query *out) {
    int exponent = 0;
    frexp(largest_offset(query), &exponent);
    double scale = ldexp(1.0, -exponent);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            out->x0[i][k] = (query->x0[i][k] - query->x0[0][k]) * scale;
            out->x1[i][k] = (query->x1[i][k] - query->x0[0][k]) * scale;
        }
    }
    return scale;
}

static void positions_at(const elementary_query *query, double t, double x[4][3]) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) x[i][k] = (1.0 - t) * query->x0[i][k] + t * query->x1[i][k];
    }
}

static void cross_of_features(const double x[4][3], int first_count, double out[3]) {
    double a[3], b[3];
    vector_subtract(x[first_count], x[first_count - 1], a);
    vector_subtract(x[3], x[first_count == 1 ? 1 : 2], b);
    if (first_count == 1) vector_subtract(x[2], x[1], a);
    if (first_count == 2) vector_subtract(x[1], x[0], a);
    vector_cross(a, b, out);
}

/* The gap is the volume over the area of the features' parallelogram, and closes at the rate of its slope;
 * where the slope is lost in rounding the root is not simple, and nothing is gained by being early. */
static double leave_gap(const elementary_query *local, double scale, double coordinate, int first_count,
                        const coplanarity *f, double toi) {
    double x[4][3], normal[3], slope = fabs(cubic_slope(f, toi));
    if (!(slope > 8.0 * f->error)) return toi;
    positions_at(local, toi, x);
    cross_of_features((const double(*)[3])x, first_count, normal);
    double area = sqrt(vector_dot(normal, normal)), speed = ((slope * scale) * scale) * scale / area;
    return larger(toi - smaller(gap_left * (coordinate * scale) / speed, earlier_at_most), 0.0);
}

static void points_at(const double x[4][3], int first_count, double u, double v, double on_a[3],
                      double on_b[3]) {
    for (int k = 0; k < 3; k++) {
        if (first_count == 1) {
            on_a[k] = x[0][k];
            on_b[k] = x[1][k] + u * (x[2][k] - x[1][k]) + v * (x[3][k] - x[1][k]);
        } else {
            on_a[k] = x[0][k] + u * (x[1][k] - x[0][k]);
            on_b[k] = x[2][k] + v * (x[3][k] - x[2][k]);
        }
    }
}

/* Unit normal of the touching features, turned against the motion of a relative to b. */
static void contact_normal(const elementary_query *query, int first_count, const double x[4][3],
                           const elementary_hit *hit, double normal[3]) {
    double start[2][3], end[2][3], motion[3];
    cross_of_features(x, first_count, normal);
    double length = sqrt(vector_dot(normal, normal));
    points_at(query->x0, first_count, hit->u, hit->v, start[0], start[1]);
    points_at(query->x1, first_count, hit->u, hit->v, end[0], end[1]);
    for (int k = 0; k < 3; k++) motion[k] = (end[0][k] - start[0][k]) - (end[1][k] - start[1][k]);
    double sign = vector_dot(normal, motion) > 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; k++) normal[k] = length > 0.0 ? sign * normal[k] / length : 0.0;
}

void contact_frame_describe(const elementary_query *query, int first_count, const coplanarity *f, double toi,
                            elementary_hit *hit) {
    elementary_query local;
    double x[4][3], on_a[3], on_b[3], scale = normalise(query, &local);
    hit->toi = leave_gap(&local, scale, largest_coordinate(query), first_count, f, toi);
    positions_at(&local, hit->toi, x);
    const double(*at)[3] = (const double(*)[3])x;
    if (first_count == 1)
        closest_point_triangle(at[0], at[1], at[2], at[3], &hit->u, &hit->v);
    else
        closest_segments(at[0], at[1], at[2], at[3], &hit->u, &hit->v);
    points_at(at, first_count, hit->u, hit->v, on_a, on_b);
    for (int k = 0; k < 3; k++) hit->point[k] = query->x0[0][k] + 0.5 * (on_a[k] + on_b[k]) / scale;
    contact_normal(&local, first_count, at, hit, hit->normal);
}
