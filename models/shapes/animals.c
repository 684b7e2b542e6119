/* A hand and an octopus, of limbs. */
#include "models/shapes/animals.h"
#include "models/shapes/limbs.h"
#include "models/shapes/remesh.h"

#include <math.h>

/* A right hand, seen from its back, fingers up: its palm lies in the plane y = 0. */
static double to_hand(const double p[3]) {
    static const limb limbs[] = {
        {{-.20, 0.00, 0.10}, {-.26, 0.00, 0.62}, 0.150, 0.120, 0.10}, /* palm, forefinger's side */
        {{0.00, 0.00, 0.05}, {-.08, 0.00, 0.68}, 0.150, 0.120, 0.20},
        {{0.00, 0.00, 0.05}, {0.10, 0.00, 0.66}, 0.150, 0.120, 0.20},
        {{0.15, 0.00, 0.08}, {0.27, 0.00, 0.56}, 0.150, 0.120, 0.20}, /* little finger's side */
        {{-.20, 0.02, 0.20}, {-.44, -.06, 0.46}, 0.130, 0.105, 0.10}, /* ball of the thumb */
        {{-.44, -.06, 0.46}, {-.60, -.10, 0.74}, 0.105, 0.078, 0.04}, /* thumb */
        {{-.27, 0.00, 0.64}, {-.40, 0.00, 1.26}, 0.098, 0.068, 0.05}, /* fingers */
        {{-.09, 0.00, 0.70}, {-.12, 0.00, 1.38}, 0.100, 0.070, 0.05},
        {{0.11, 0.00, 0.68}, {0.16, 0.00, 1.30}, 0.098, 0.068, 0.05},
        {{0.28, 0.00, 0.56}, {0.42, 0.00, 1.08}, 0.088, 0.060, 0.05},
    };
    return limbs_distance(limbs, sizeof limbs / sizeof *limbs, p);
}

bool add_hand(body *b, uint32_t triangle_count) {
    static const implicit shape = {to_hand, {-0.85, -0.35, -0.25}, {0.65, 0.35, 1.6}, true};
    return body_add_even_implicit(b, &shape, triangle_count);
}

/* Returns about the distance to an octopus's arm, which curls up in a plane through the axis z; `angle` is that between
 * the point and this plane, and `radius` the distance to the axis. */
static double to_arm(double radius, double angle, double z) {
    static const limb limbs[] = {
        {{0.220, 0.0, 0.000}, {0.513, 0.0, -.062}, 0.125, 0.115, 0.05}, /* from its root */
        {{0.513, 0.0, -.062}, {0.791, 0.0, -.101}, 0.115, 0.104, 0.02},
        {{0.791, 0.0, -.101}, {1.047, 0.0, -.056}, 0.104, 0.094, 0.02},
        {{1.047, 0.0, -.056}, {1.194, 0.0, 0.107}, 0.094, 0.084, 0.02},
        {{1.194, 0.0, 0.107}, {1.164, 0.0, 0.275}, 0.084, 0.073, 0.02},
        {{1.164, 0.0, 0.275}, {1.035, 0.0, 0.327}, 0.073, 0.063, 0.02},
        {{1.035, 0.0, 0.327}, {0.947, 0.0, 0.253}, 0.063, 0.052, 0.02},
        {{0.947, 0.0, 0.253}, {0.967, 0.0, 0.155}, 0.052, 0.042, 0.02},
    };
    return limbs_distance(limbs, sizeof limbs / sizeof *limbs,
                          (double[3]){radius * cos(angle), radius * sin(angle), z});
}

/* Eight arms around the axis z. Between two of them the surface is round, as everywhere: an edge there would fold
 * the triangles of a fine mesh. */
static double to_octopus(const double p[3]) {
    static const limb middle[] = {
        {{0.000, 0.0, 0.000}, {0.000, 0.0, 0.060}, 0.250, 0.240, 0.05},
        {{0.000, 0.0, 0.420}, {0.000, 0.0, 0.620}, 0.230, 0.290, 0.20}, /* mantle */
    };
    const double between = 0.78539816339744831, angle = atan2(p[1], p[0]), radius = hypot(p[0], p[1]);
    const double nearest = fabs(angle - round(angle / between) * between);
    const double arms =
        round_union(to_arm(radius, nearest, p[2]), to_arm(radius, between - nearest, p[2]), 0.05);
    return round_union(limbs_distance(middle, sizeof middle / sizeof *middle, p), arms, 0.05);
}

bool add_octopus(body *b, uint32_t triangle_count) {
    static const implicit shape = {to_octopus, {-1.4, -1.4, -0.4}, {1.4, 1.4, 1.1}, true};
    return body_add_even_implicit(b, &shape, triangle_count);
}
