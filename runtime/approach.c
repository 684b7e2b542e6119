/* The first moment in a stretch of time at which two moving convex features touch. */
#include "runtime/approach.h"

#include "runtime/vector.h"

enum { STEPS_MAX = 1000 };

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

bool approach_find_touch(const elementary_query *query, const approach_features *f, time_interval stretch,
                         double touching, double *toi, double *u, double *v) {
    double speed = largest_speed(query, f);
    double t = stretch.begin;
    for (int step = 0; step < STEPS_MAX; step++) {
        double x[4][3], on_a[3], on_b[3], n[3];
        approach_positions(query, t, x);
        double distance = sqrt(f->closest((const double(*)[3])x, u, v));
        *toi = t;
        if (!(distance > touching)) return true;
        f->points((const double(*)[3])x, *u, *v, on_a, on_b);
        for (int k = 0; k < 3; k++) n[k] = (on_a[k] - on_b[k]) / distance;
        double by_plane = time_separated(query, f, (const double(*)[3])x, n, 0.25 * touching);
        double by_speed = (distance - 0.5 * touching) / speed;
        double safe = fmax(by_plane, by_speed);
        if (!(t + safe <= stretch.end)) return false;
        t += safe;
    }
    return true;
}
