/* Faint squares and the shadow of the body, which let a viewer read scenery as the ground below it. */
#include "tool/picture/ground.h"

#include <math.h>

/* How much darker every other square is. */
static const double contrast = 0.13;

/* How much darker the deepest shadow is. */
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
