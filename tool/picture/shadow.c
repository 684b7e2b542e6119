/* The ground below a body, and the soft shadow that the body casts straight down: each cell of a map of its
 * heights spreads its shadow over a disc that widens with its height above the point. */
#include "tool/picture/shade.h"

#include <math.h>
#include <stdlib.h>

/* Cells along the body's greatest extent. */
static const double resolution = 192.0;

/* The radius of a cell's shadow per height, and at most, as a share of the body's extent. */
static const double widening = 0.4, widest = 0.18;

/* A body that is no higher above the point than this touches it. Heights are shares of the body's extent. */
static const double nothing = 1e-3;

/* Points of a disc of the widest shadow, in cells, the denser the nearer to its middle, and the area that
 * each stands for. The golden angle keeps them out of line with each other and with the grid. */
static void spread_taps(picture_shadow *shadow) {
    const double golden_angle = 2.39996322972865332, turn = 6.28318530717958648;
    const double reach = widest * resolution, step = 1.0 / PICTURE_SHADOW_TAPS;
    for (int i = 0; i < PICTURE_SHADOW_TAPS; i++) {
        double t = (i + 0.5) * step, radius = reach * t * t;
        shadow->taps[i] =
            (picture_shadow_tap){.offset = {radius * cos(golden_angle * i), radius * sin(golden_angle * i)},
                                 .radius = radius,
                                 .area = turn * radius * reach * 2.0 * t * step};
    }
}

static void measure_scene(const double *positions, uint32_t vertex_count, double low[3], double high[3]) {
    for (int k = 0; k < 3; k++) low[k] = HUGE_VAL, high[k] = -HUGE_VAL;
    for (size_t i = 0; i < 3 * (size_t)vertex_count; i++) {
        low[i % 3] = fmin(low[i % 3], positions[i]);
        high[i % 3] = fmax(high[i % 3], positions[i]);
    }
}

static void add_height(picture_shadow *shadow, size_t cell, double height) {
    shadow->low[cell] = fminf(shadow->low[cell], (float)height);
    shadow->high[cell] = fmaxf(shadow->high[cell], (float)height);
}

/* Visits the cells whose middles the triangle covers. The triangles of a closed surface leave no hole. */
static void add_triangle(picture_shadow *shadow, const double *const corners[3]) {
    double u[3], v[3], height[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (corners[k][shadow->across] - shadow->origin[shadow->across]) / shadow->cell;
        v[k] = (corners[k][shadow->along] - shadow->origin[shadow->along]) / shadow->cell;
        height[k] = (corners[k][shadow->up] - shadow->origin[shadow->up]) / shadow->extent;
    }
    double area = (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]);
    if (area == 0.0) return;
    int64_t first = (int64_t)ceil(fmin(u[0], fmin(u[1], u[2]))), end = (int64_t)fmax(u[0], fmax(u[1], u[2]));
    int64_t top = (int64_t)ceil(fmin(v[0], fmin(v[1], v[2]))), bottom = (int64_t)fmax(v[0], fmax(v[1], v[2]));
    for (int64_t row = top; row <= bottom; row++)
        for (int64_t column = first; column <= end; column++) {
            double x = (double)column, y = (double)row;
            double a = ((u[1] - x) * (v[2] - y) - (u[2] - x) * (v[1] - y)) / area;
            double b = ((u[2] - x) * (v[0] - y) - (u[0] - x) * (v[2] - y)) / area;
            double c = 1.0 - a - b;
            if (a < 0.0 || b < 0.0 || c < 0.0) continue;
            add_height(shadow, (size_t)row * shadow->columns + (size_t)column,
                       a * height[0] + b * height[1] + c * height[2]);
        }
}

bool picture_shadow_create(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                           uint32_t triangle_count, bool y_up, picture_shadow *out, io_error *error) {
    picture_shadow shadow = {.across = 0, .along = y_up ? 2 : 1, .up = y_up ? 1 : 2};
    double high[3];
    measure_scene(positions, vertex_count, shadow.origin, high);
    for (int k = 0; k < 3; k++) shadow.extent = fmax(shadow.extent, high[k] - shadow.origin[k]);
    shadow.cell = shadow.extent / resolution;
    if (!(shadow.cell > 0.0 && shadow.extent < HUGE_VAL)) {
        *out = (picture_shadow){0};
        return true;
    }
    shadow.columns = (uint32_t)((high[shadow.across] - shadow.origin[shadow.across]) / shadow.cell) + 1;
    shadow.rows = (uint32_t)((high[shadow.along] - shadow.origin[shadow.along]) / shadow.cell) + 1;
    size_t count = (size_t)shadow.columns * shadow.rows;
    shadow.low = malloc(count * sizeof *shadow.low);
    shadow.high = malloc(count * sizeof *shadow.high);
    if (shadow.low == NULL || shadow.high == NULL) {
        picture_shadow_free(&shadow);
        return io_fail(error, "picture: out of memory for a shadow of %zu cells", count);
    }
    for (size_t i = 0; i < count; i++) shadow.low[i] = HUGE_VALF, shadow.high[i] = -HUGE_VALF;
    for (size_t t = 0; t < triangle_count; t++) {
        const uint32_t *v = triangles + 3 * t;
        add_triangle(&shadow,
                     (const double *const[3]){positions + 3 * (size_t)v[0], positions + 3 * (size_t)v[1],
                                              positions + 3 * (size_t)v[2]});
    }
    spread_taps(&shadow);
    *out = shadow;
    return true;
}

void picture_shadow_free(picture_shadow *shadow) {
    free(shadow->low);
    free(shadow->high);
    *shadow = (picture_shadow){0};
}

/* Is there something above the height, in the cell nearest to (u, v)? */
static bool point_covered(const picture_shadow *shadow, double u, double v, double height, double *distance) {
    double column = floor(u + 0.5), row = floor(v + 0.5);
    if (!(column >= 0.0 && row >= 0.0 && column < shadow->columns && row < shadow->rows)) return false;
    size_t cell = (size_t)row * shadow->columns + (size_t)column;
    if (!(shadow->high[cell] > height + nothing)) return false;
    *distance = fmax(shadow->low[cell] - height, 0.0);
    return true;
}

/* The shadow per area, in cells, that a cell so high above casts at that distance from below it; it adds up
 * to 1 over a disc, less what is lost on the way. */
static double shadow_density(double height, double distance) {
    const double pi = 3.14159265358979324;
    double radius = fmin(2.0 + widening * height * resolution, widest * resolution);
    double inside = 1.0 - distance * distance / (radius * radius);
    return inside > 0.0 ? 2.0 * inside / (pi * radius * radius) / (1.0 + 0.5 * height) : 0.0;
}

double picture_shadow_at(const picture_shadow *shadow, const double point[3]) {
    if (!(shadow->extent > 0.0)) return 0.0;
    double u = (point[shadow->across] - shadow->origin[shadow->across]) / shadow->cell,
           v = (point[shadow->along] - shadow->origin[shadow->along]) / shadow->cell,
           height = (point[shadow->up] - shadow->origin[shadow->up]) / shadow->extent;
    double reach = widest * resolution, sum = 0.0, above = 0.0;
    if (!(u > -reach && v > -reach && u < shadow->columns + reach && v < shadow->rows + reach)) return 0.0;
    for (int i = 0; i < PICTURE_SHADOW_TAPS; i++) {
        const picture_shadow_tap *tap = &shadow->taps[i];
        if (point_covered(shadow, u + tap->offset[0], v + tap->offset[1], height, &above))
            sum += tap->area * shadow_density(above, tap->radius);
    }
    return fmin(sum, 1.0);
}

/* ---- faint squares and the shadow of the body ------------------------------------------------------------ */

/* The darkness of every other square. */
static const double contrast = 0.13;

/* The darkness of the deepest shadow. */
static const double depth_of_shadow = 0.55;

static double dot_product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Integral of the square wave that is 1 where floor(x) is even, else -1. */
static double wave_integral(double x) {
    double phase = x - 2.0 * floor(0.5 * x);
    return phase < 1.0 ? phase : 2.0 - phase;
}

/* The wave's mean over the width. */
static double mean_wave(double x, double width) {
    return (wave_integral(x + 0.5 * width) - wave_integral(x - 0.5 * width)) / width;
}

/* Squares along the two level axes, averaged over what the pixel covers, so that they blend far off. */
static double square_pattern(const picture_ground *ground, const double point[3], double pixel_extent) {
    double first = point[0] / ground->square, second = point[ground->y_up ? 2 : 1] / ground->square;
    double width = fmax(pixel_extent / ground->square, 1e-6);
    return mean_wave(first, width) * mean_wave(second, width);
}

static double clamp_unit(double x) {
    return fmin(fmax(x, 0.0), 1.0);
}

double picture_ground_light(const picture_ground *ground, const picture_camera *camera,
                            const double normal[3], const double view[3], double x, double y, double depth) {
    const double up[3] = {0.0, ground->y_up ? 1.0 : 0.0, ground->y_up ? 0.0 : 1.0};
    double turned_up[3], point[3];
    picture_camera_turn(camera, up, turned_up);
    picture_camera_unproject(camera, x, y, depth, point);
    double upward = dot_product(normal, turned_up), light = 1.0;
    if (upward > 0.1)
        light -= clamp_unit(2.0 * upward - 0.2) * depth_of_shadow * picture_shadow_at(ground->shadow, point);
    double level = clamp_unit((fabs(upward) - 0.8) / 0.15);
    if (!(ground->square > 0.0) || level == 0.0) return light;
    double pixel_extent = depth / camera->unit / camera->focal / fmax(fabs(dot_product(normal, view)), 1e-3);
    return light * (1.0 - level * contrast * (0.5 - 0.5 * square_pattern(ground, point, pixel_extent)));
}
