/* The first moment in a stretch of time at which two moving convex features touch. */
#ifndef CSCD_APPROACH_H
#define CSCD_APPROACH_H

#include "runtime/cubic.h"
#include "runtime/elementary.h"

/* Features a (the first first_count points) and b (the rest). closest: as in closest.h, squared. */
typedef struct approach_features {
    int first_count;
    double (*closest)(const double x[4][3], double *u, double *v);
    void (*points)(const double x[4][3], double u, double v, double on_a[3], double on_b[3]);
} approach_features;

/* Positions at t. */
void approach_positions(const elementary_query *query, double t, double x[4][3]);

/* Conservative advancement over the stretch: true when the features come within `touching` of each other,
 * with the moment and the parameters of the nearest points. Each step goes as far as a plane between the
 * features, or their speed, keeps them apart, so no touch is stepped over. Features that come near with the
 * square of the time left can use up the steps; then a search for the least distance ahead decides, which is
 * not certified: it takes the distance to fall and then rise. */
bool approach_find_touch(const elementary_query *query, const approach_features *features,
                         const near_zero *stretch, double touching, double *toi, double *u, double *v);

#endif
