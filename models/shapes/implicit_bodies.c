/* Bodies that are the zero set of a function: a person, animals, letters, two rings that grew together, an ellipsoid. */
#include "models/shapes/bodies.h"
#include "models/shapes/implicit.h"

#include <math.h>
#include <stddef.h>

/* ---- bodies that are put together of limbs ------------------------------------------------------------- */

/* A cone with round ends. */
typedef struct limb {
    double a[3], b[3], radius_a, radius_b, blend; /* blend: how far its root is rounded */
} limb;

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

/* Returns the smaller of two distances, smoothly where they differ by less than `blend`. */
static double round_union(double a, double b, double blend) {
    double h = fmax(blend - fabs(a - b), 0.0) / blend;
    return fmin(a, b) - h * h * blend * 0.25;
}

/* Returns about the distance to all limbs together; each is joined to those before it. */
static double limbs_distance(const limb *limbs, size_t count, const double p[3]) {
    double distance = to_limb(p, &limbs[0]);
    for (size_t i = 1; i < count; i++)
        distance = round_union(distance, to_limb(p, &limbs[i]), limbs[i].blend);
    return distance;
}

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

/* ---- letters as thick as their strokes, with round edges ----------------------------------------------- */

/* All edges are rounded by this radius around a core: an outline in x and z that extends by half_depth to
 * both sides along y. */
static const double rounding = 0.1, half_depth = 0.15;

/* Returns the distance to a counter-clockwise polygon, negative inside. */
static double to_outline(double x, double z, const double (*corners)[2], int count) {
    double nearest = INFINITY;
    bool inside = false;
    for (int i = 0; i < count; i++) {
        const double *a = corners[i], *b = corners[(i + 1) % count];
        double along[2] = {b[0] - a[0], b[1] - a[1]}, from[2] = {x - a[0], z - a[1]};
        double part = (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        part = fmin(fmax(part, 0.0), 1.0);
        nearest = fmin(nearest, hypot(from[0] - part * along[0], from[1] - part * along[1]));
        if ((a[1] > z) != (b[1] > z) && from[0] < along[0] * from[1] / along[1]) inside = !inside;
    }
    return inside ? -nearest : nearest;
}

static double to_letter(const double p[3], const double (*corners)[2], int count) {
    double across = to_outline(p[0], p[2], corners, count), above = fabs(p[1]) - half_depth;
    return fmin(fmax(across, above), 0.0) + hypot(fmax(across, 0.0), fmax(above, 0.0)) - rounding;
}

#define TO_LETTER(p, corners) to_letter((p), (corners), (int)(sizeof(corners) / sizeof *(corners)))

static double to_t(const double p[3]) {
    static const double corners[][2] = {{-0.15, 0.1}, {0.15, 0.1}, {0.15, 1.6}, {0.9, 1.6},
                                        {0.9, 1.9},   {-0.9, 1.9}, {-0.9, 1.6}, {-0.15, 1.6}};
    return TO_LETTER(p, corners);
}

static double to_u(const double p[3]) {
    static const double corners[][2] = {{-0.8, 0.1}, {0.8, 0.1},  {0.8, 1.9},  {0.5, 1.9},
                                        {0.5, 0.4},  {-0.5, 0.4}, {-0.5, 1.9}, {-0.8, 1.9}};
    return TO_LETTER(p, corners);
}

static double to_v(const double p[3]) {
    static const double corners[][2] = {{-0.18, 0.1}, {0.18, 0.1}, {1.0, 1.9}, {0.7, 1.9},
                                        {0.0, 0.365}, {-0.7, 1.9}, {-1.0, 1.9}};
    return TO_LETTER(p, corners);
}

static double to_w(const double p[3]) {
    static const double corners[][2] = {
        {-0.96, 0.1},   {-0.74, 0.1}, {0.0, 1.744}, {0.74, 0.1},     {0.96, 0.1},  {1.5, 1.9}, {1.25, 1.9},
        {0.822, 0.473}, {0.18, 1.9},  {-0.18, 1.9}, {-0.822, 0.473}, {-1.25, 1.9}, {-1.5, 1.9}};
    return TO_LETTER(p, corners);
}

static bool add_letter(body *b, double (*distance)(const double point[3]), double half_width,
                       uint32_t triangle_count) {
    const implicit shape = {distance, {-half_width - 0.2, -0.45, -0.2}, {half_width + 0.2, 0.45, 2.2}, false};
    return body_add_even_implicit(b, &shape, triangle_count);
}

bool add_letter_t(body *b, uint32_t triangle_count) {
    return add_letter(b, to_t, 1.0, triangle_count);
}

bool add_letter_u(body *b, uint32_t triangle_count) {
    return add_letter(b, to_u, 0.9, triangle_count);
}

bool add_letter_v(body *b, uint32_t triangle_count) {
    return add_letter(b, to_v, 1.1, triangle_count);
}

bool add_letter_w(body *b, uint32_t triangle_count) {
    return add_letter(b, to_w, 1.6, triangle_count);
}
