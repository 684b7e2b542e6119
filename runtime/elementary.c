/* Elementary tests: do a moving vertex and face, or two moving edges, touch, and when? */
#include "runtime/elementary.h"

#include "runtime/approach.h"
#include "runtime/closest.h"
#include "runtime/coplanarity.h"
#include "runtime/kdop.h"
#include "runtime/vector.h"

/* Features count as touching when, at a time at which they may be coplanar, they are no farther apart than
 * this fraction of the extent of the query, motion included. Nearest points are computed to about 2^-50 of
 * it. */
#define TOUCHING 0x1p-40

typedef struct feature_kind {
    approach_features features;
    void (*differences)(const double x[4][3], double a[3], double b[3], double c[3]);
} feature_kind;

static void differences_vf(const double x[4][3], double a[3], double b[3], double c[3]) {
    vector_subtract(x[2], x[1], a);
    vector_subtract(x[3], x[1], b);
    vector_subtract(x[0], x[1], c);
}

static void differences_ee(const double x[4][3], double a[3], double b[3], double c[3]) {
    vector_subtract(x[1], x[0], a);
    vector_subtract(x[3], x[2], b);
    vector_subtract(x[2], x[0], c);
}

static double closest_vf(const double x[4][3], double *u, double *v) {
    return closest_point_triangle(x[0], x[1], x[2], x[3], u, v);
}

static double closest_ee(const double x[4][3], double *u, double *v) {
    return closest_segments(x[0], x[1], x[2], x[3], u, v);
}

static void points_vf(const double x[4][3], double u, double v, double on_a[3], double on_b[3]) {
    for (int k = 0; k < 3; k++) {
        on_a[k] = x[0][k];
        on_b[k] = x[1][k] + u * (x[2][k] - x[1][k]) + v * (x[3][k] - x[1][k]);
    }
}

static void points_ee(const double x[4][3], double u, double v, double on_a[3], double on_b[3]) {
    for (int k = 0; k < 3; k++) {
        on_a[k] = x[0][k] + u * (x[1][k] - x[0][k]);
        on_b[k] = x[2][k] + v * (x[3][k] - x[2][k]);
    }
}

static const feature_kind vf_kind = {{1, closest_vf, points_vf}, differences_vf};
static const feature_kind ee_kind = {{2, closest_ee, points_ee}, differences_ee};

/* The certified rejection that the trees use too, on the features' own points. */
static bool volumes_overlap(const elementary_query *query, int first_count) {
    kdop_exact volumes[2], point;
    for (int i = 0; i < 4; i++) {
        kdop_exact *volume = &volumes[i >= first_count];
        if (i == 0 || i == first_count)
            kdop_point(query->x0[i], volume);
        else {
            kdop_point(query->x0[i], &point);
            kdop_exact_add(volume, &point);
        }
        kdop_point(query->x1[i], &point);
        kdop_exact_add(volume, &point);
    }
    return kdop_exact_overlap(&volumes[0], &volumes[1]);
}

static coplanarity query_cubic(const elementary_query *query, const feature_kind *kind) {
    double a[2][3], b[2][3], c[2][3];
    kind->differences(query->x0, a[0], b[0], c[0]);
    kind->differences(query->x1, a[1], b[1], c[1]);
    return coplanarity_cubic(a, b, c);
}

static double query_extent(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = fmax(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = fmax(largest, fabs(query->x1[i][k] - query->x0[0][k]));
        }
    }
    return largest;
}

/* The same query relative to its first point and scaled by a power of two to an extent in [1/2, 1), so that
 * no later product over- or underflows. Returns the scale. */
static double normalise(const elementary_query *query, elementary_query *out) {
    int exponent = 0;
    frexp(query_extent(query), &exponent);
    double scale = ldexp(1.0, -exponent);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            out->x0[i][k] = (query->x0[i][k] - query->x0[0][k]) * scale;
            out->x1[i][k] = (query->x1[i][k] - query->x0[0][k]) * scale;
        }
    }
    return scale;
}

/* Unit normal of the touching features, turned against the motion of a relative to b. */
static void contact_normal(const elementary_query *query, const feature_kind *kind, const double x[4][3],
                           const elementary_hit *hit, double normal[3]) {
    double a[3], b[3], c[3], start[2][3], end[2][3], motion[3];
    kind->differences(x, a, b, c);
    vector_cross(a, b, normal);
    double length = sqrt(vector_dot(normal, normal));
    kind->features.points(query->x0, hit->u, hit->v, start[0], start[1]);
    kind->features.points(query->x1, hit->u, hit->v, end[0], end[1]);
    for (int k = 0; k < 3; k++) motion[k] = (end[0][k] - start[0][k]) - (end[1][k] - start[1][k]);
    double sign = vector_dot(normal, motion) > 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 3; k++) normal[k] = length > 0.0 ? sign * normal[k] / length : 0.0;
}

static void describe_hit(const elementary_query *query, const elementary_query *local, double scale,
                         const feature_kind *kind, const double x[4][3], elementary_hit *hit) {
    double on_a[3], on_b[3];
    kind->features.points(x, hit->u, hit->v, on_a, on_b);
    for (int k = 0; k < 3; k++) hit->point[k] = query->x0[0][k] + 0.5 * (on_a[k] + on_b[k]) / scale;
    contact_normal(local, kind, x, hit, hit->normal);
}

static elementary_verdict decide(const elementary_query *query, const feature_kind *kind,
                                 elementary_hit *hit) {
    if (!volumes_overlap(query, kind->features.first_count))
        return (elementary_verdict){false, ELEMENTARY_SIGNS};
    coplanarity f = query_cubic(query, kind);
    if (coplanarity_excluded(&f)) return (elementary_verdict){false, ELEMENTARY_SIGNS};

    elementary_query local;
    double scale = normalise(query, &local);
    near_zero stretches[CUBIC_INTERVALS_MAX]; /* outside of which the points are not coplanar */
    int count = cubic_near_zero(f.b, f.error, stretches);
    for (int i = 0; i < count; i++) {
        elementary_hit found;
        if (!approach_find_touch(&local, &kind->features, &stretches[i], TOUCHING, &found.toi, &found.u,
                                 &found.v))
            continue;
        double x[4][3];
        approach_positions(&local, found.toi, x);
        describe_hit(query, &local, scale, kind, (const double(*)[3])x, &found);
        *hit = found;
        return (elementary_verdict){true, ELEMENTARY_ROOTS};
    }
    return (elementary_verdict){false, ELEMENTARY_ROOTS};
}

elementary_verdict elementary_vf(const elementary_query *query, elementary_hit *hit) {
    return decide(query, &vf_kind, hit);
}

elementary_verdict elementary_ee(const elementary_query *query, elementary_hit *hit) {
    return decide(query, &ee_kind, hit);
}
