/* Distances to limbs, joined by round unions. */
#include "models/shapes/limbs.h"

#include <math.h>

static double to_limb(const double p[3], const limb *l) {
    double along = 0.0, length = 0.0, squared = 0.0;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - l->a[k]) * (l->b[k] - l->a[k]);
        length += (l->b[k] - l->a[k]) * (l->b[k] - l->a[k]);
    }
    double t = fmin(fmax(along / length, 0.0), 1.0);
    for (int k = 0; k < 3; k++) {
        double d = p[k] - l->a[k] - t * (l->b[k] - l->a[k]);
        squared += d * d;
    }
    return sqrt(squared) - (l->radius_a + t * (l->radius_b - l->radius_a));
}

double round_union(double a, double b, double blend) {
    double h = fmax(blend - fabs(a - b), 0.0) / blend;
    return fmin(a, b) - h * h * blend * 0.25;
}

double limbs_distance(const limb *limbs, size_t count, const double p[3]) {
    double distance = to_limb(p, &limbs[0]);
    for (size_t i = 1; i < count; i++)
        distance = round_union(distance, to_limb(p, &limbs[i]), limbs[i].blend);
    return distance;
}
