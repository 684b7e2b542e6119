/* Letters as thick as their strokes, with round edges: T, U, V, W. */
#include "models/shapes/letters.h"
#include "models/shapes/remesh.h"

#include <math.h>

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
