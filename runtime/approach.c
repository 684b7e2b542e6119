/* The first moment in a stretch of time at which two moving convex features touch. */
#include "runtime/approach.h"

#include "runtime/vector.h"

enum { STEPS_MAX = 1000, SETTLE_STEPS_MAX = 8, SECTION_STEPS = 60 };

/* How far ahead a mark is trusted where the points are coplanar all the time, and what is not worth mending.
 */
static const double flat_window = 1e-9, early_enough = 1e-11;

/* Double roots and extrema are this inexact; a touch must not be reported late. */
static const double mark_error = 0x1p-42;

/* What a distance may be off by, the extent of the query being 1. */
static const double rounding = 0x1p-44;

void approach_positions(const elementary_query *query, double t, double x[4][3]) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) x[i][k] = (1.0 - t) * query->x0[i][k] + t * query->x1[i][k];
    }
}

/* How long after t does the direction n, of unit length, keep every point of a beyond every point of b by
 * more than margin? INFINITY: for ever; 0: it does not at t. Holds for any n; margin covers the rounding. */
static double time_separated(const elementary_query *query, const approach_features *f, const double x[4][3],
                             const double n[3], double margin) {
    double least = INFINITY;
    for (int i = 0; i < f->first_count; i++) {
        for (int j = f->first_count; j < 4; j++) {
            double gap = -margin, rate = 0.0;
            for (int k = 0; k < 3; k++) {
                gap += (x[i][k] - x[j][k]) * n[k];
                rate += ((query->x1[i][k] - query->x0[i][k]) - (query->x1[j][k] - query->x0[j][k])) * n[k];
            }
            if (!(gap > 0.0)) return 0.0;
            if (rate < 0.0) least = fmin(least, gap / -rate);
        }
    }
    return least;
}

/* No two points, one of each feature, approach faster. */
static double largest_speed(const elementary_query *query, const approach_features *f) {
    double largest = 0.0;
    for (int i = 0; i < f->first_count; i++) {
        for (int j = f->first_count; j < 4; j++) {
            double motion[3];
            for (int k = 0; k < 3; k++)
                motion[k] = (query->x1[i][k] - query->x0[i][k]) - (query->x1[j][k] - query->x0[j][k]);
            largest = fmax(largest, vector_dot(motion, motion));
        }
    }
    return sqrt(largest);
}

/* The features at one moment. */
typedef struct moment {
    double t, distance, u, v;
    double x[4][3], direction[3]; /* unit, from b to a; undefined at distance 0 */
} moment;

static moment moment_at(const elementary_query *query, const approach_features *f, double t) {
    moment m = {.t = t};
    double on_a[3], on_b[3];
    approach_positions(query, t, m.x);
    m.distance = sqrt(f->closest((const double(*)[3])m.x, &m.u, &m.v));
    f->points((const double(*)[3])m.x, m.u, m.v, on_a, on_b);
    for (int k = 0; k < 3; k++) m.direction[k] = (on_a[k] - on_b[k]) / m.distance;
    return m;
}

/* The moment of least distance from m to end, by golden section; m itself if there is none better. */
static moment least_distance(const elementary_query *query, const approach_features *f, moment m,
                             double end) {
    const double section = 0.38196601125010515;
    double low = m.t, high = end;
    moment left = moment_at(query, f, low + section * (high - low));
    moment right = moment_at(query, f, high - section * (high - low)), best = m;
    for (int step = 0; step < SECTION_STEPS; step++) {
        bool keep_left = left.distance < right.distance;
        const moment *inner = keep_left ? &left : &right;
        if (inner->distance < best.distance) best = *inner;
        if (keep_left) {
            high = right.t;
            right = left;
            left = moment_at(query, f, low + section * (high - low));
        } else {
            low = left.t;
            left = right;
            right = moment_at(query, f, high - section * (high - low));
        }
    }
    return best;
}

/* The points are coplanar all the time, as far as rounding tells. */
static bool is_flat(const near_zero *stretch) {
    return stretch->begin == 0.0 && stretch->end == 1.0;
}

/* The features come near with the square of the time that is left, so that the steps ran out at m, the last
 * one being last_step long; n such steps lie behind about n of them ahead. Looks that far for a touch, and
 * back from it for its beginning. False: there is none until the stretch ends. */
static bool look_ahead(const elementary_query *query, const approach_features *f, double last_step,
                       double end, double touching, moment *m) {
    double horizon = m->t + 4.0 * STEPS_MAX * last_step;
    moment touch = least_distance(query, f, *m, fmin(end, horizon));
    if (touch.distance > touching) return horizon < end;
    double before = m->t;
    for (int step = 0; step < SECTION_STEPS; step++) {
        moment middle = moment_at(query, f, 0.5 * (before + touch.t));
        if (middle.distance <= touching)
            touch = middle;
        else
            before = middle.t;
    }
    *m = touch;
    return true;
}

/* m is early by what the tolerance allows, which is much where the features approach slowly. The mark of the
 * stretch that comes next is the touch itself if the features touch there, too; in a stretch that is all of
 * [0,1] marks mean little, and the plane between the features is followed for a few steps. */
static moment settle(const elementary_query *query, const approach_features *f, moment m,
                     const near_zero *stretch, double touching) {
    for (int i = 0; i < stretch->mark_count; i++) {
        double mark = stretch->marks[i];
        if (mark < m.t || (is_flat(stretch) && mark - m.t > flat_window)) continue;
        if (mark < 1.0 && mark - m.t <= early_enough) return m;
        moment at_mark = moment_at(query, f, mark < 1.0 ? fmax(m.t, mark - mark_error) : mark);
        if (at_mark.distance <= touching && at_mark.distance <= m.distance) return at_mark;
    }
    for (int step = 0; step < SETTLE_STEPS_MAX && m.distance > 0.0; step++) {
        double later = m.t + time_separated(query, f, (const double(*)[3])m.x, m.direction, rounding);
        if (!(later > m.t)) break;
        moment next = moment_at(query, f, fmin(later, stretch->end));
        if (!(next.distance < m.distance)) break;
        m = next;
    }
    return m;
}

bool approach_find_touch(const elementary_query *query, const approach_features *f, const near_zero *stretch,
                         double touching, double *toi, double *u, double *v) {
    double speed = largest_speed(query, f), last_step = 0.0;
    moment m = moment_at(query, f, stretch->begin);
    for (int step = 0; step < STEPS_MAX && m.distance > touching; step++) {
        double by_plane = time_separated(query, f, (const double(*)[3])m.x, m.direction, 0.25 * touching);
        double by_speed = (m.distance - 0.5 * touching) / speed;
        double later = m.t + fmax(by_plane, by_speed);
        if (!(later <= stretch->end)) return false;
        last_step = later - m.t;
        m = moment_at(query, f, later);
    }
    if (m.distance > touching && !look_ahead(query, f, last_step, stretch->end, touching, &m)) return false;
    m = settle(query, f, m, stretch, touching);
    *toi = m.t;
    *u = m.u;
    *v = m.v;
    return true;
}
