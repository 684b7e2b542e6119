/* Bodies that are the zero set of a function: a person, two rings that grew together, an ellipsoid. */
#include "models/shapes/figure.h"
#include "models/shapes/limbs.h"
#include "models/shapes/remesh.h"

#include <math.h>
#include <stddef.h>

/* Returns about the distance to the figure. Its left half mirrors the right; the first two limbs stand in
 * the middle. */
static double to_figure(const double point[3]) {
    static const limb limbs[] = {
        {{0.00, 0.00, 1.00}, {0.00, 0.00, 1.22}, 0.160, 0.155, 0.05},    /* hips and belly */
        {{0.00, 0.00, 1.32}, {0.10, 0.00, 1.34}, 0.150, 0.135, 0.10},    /* chest */
        {{0.00, 0.00, 1.44}, {0.00, 0.00, 1.58}, 0.075, 0.070, 0.05},    /* neck */
        {{0.00, 0.00, 1.69}, {0.00, -.01, 1.73}, 0.125, 0.135, 0.02},    /* head */
        {{0.18, 0.00, 1.39}, {0.45, 0.00, 1.18}, 0.088, 0.076, 0.06},    /* upper arm */
        {{0.45, 0.00, 1.18}, {0.66, -.06, 1.01}, 0.076, 0.066, 0.02},    /* forearm */
        {{0.67, -.05, 1.00}, {0.77, -.07, 0.91}, 0.054, 0.048, 0.04},    /* hand, little finger's side */
        {{0.66, -.09, 1.00}, {0.77, -.12, 0.90}, 0.054, 0.048, 0.06},    /* forefinger's side */
        {{0.67, -.10, 0.99}, {0.70, -.165, 0.93}, 0.042, 0.040, 0.05},   /* thumb */
        {{0.12, 0.00, 0.90}, {0.19, 0.00, 0.50}, 0.120, 0.092, 0.05},    /* thigh */
        {{0.19, 0.00, 0.50}, {0.26, 0.00, 0.12}, 0.092, 0.082, 0.02},    /* shank */
        {{0.26, 0.01, 0.09}, {0.305, -.115, 0.057}, 0.092, 0.057, 0.08}, /* foot */
    };
    return limbs_distance(limbs, sizeof limbs / sizeof *limbs,
                          (double[3]){fabs(point[0]), point[1], point[2]});
}

bool add_figure(body *b, uint32_t triangle_count) {
    static const implicit shape = {to_figure, {-1.0, -0.45, -0.2}, {1.0, 0.45, 2.1}, false};
    return body_add_even_implicit(b, &shape, triangle_count);
}

static double to_ring(const double p[3], double centre, double major, double minor) {
    return hypot(hypot(p[0] - centre, p[1]) - major, p[2]) - minor;
}

static double to_genus2(const double p[3]) {
    return round_union(to_ring(p, -0.85, 0.7, 0.25), to_ring(p, 0.85, 0.7, 0.25), 0.2);
}

bool add_genus2(body *b, uint32_t triangle_count) {
    static const implicit shape = {to_genus2, {-2.0, -1.15, -0.45}, {2.0, 1.15, 0.45}, false};
    return body_add_even_implicit(b, &shape, triangle_count);
}

/* Returns a first approximation of the distance near the surface, and at most 1.5 / 0.7 times the distance elsewhere. */
static double to_ellipsoid(const double p[3]) {
    double x = p[0] / 1.5, y = p[1], z = p[2] / 0.7, level = sqrt(x * x + y * y + z * z);
    double gradient = hypot(hypot(x / 1.5, y), z / 0.7);
    return gradient > 0.0 ? level * (level - 1.0) / gradient : -0.7;
}

bool add_ellipsoid(body *b, uint32_t triangle_count) {
    static const implicit shape = {to_ellipsoid, {-1.8, -1.3, -1.0}, {1.8, 1.3, 1.0}, false};
    return body_add_even_implicit(b, &shape, triangle_count);
}
