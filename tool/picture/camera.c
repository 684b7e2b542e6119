/* The perspective camera: orientation from two angles, place from the points that must fit. */
#include "tool/picture/picture.h"

#include "tool/picture/shade.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Half the angle of view across the shorter side. It is moderate, so that depth shows and nothing looks
 * bulged. */
static const double half_view_degrees = 14.0;

/* Share of the shorter side that stays free on every side. */
static const double margin = 0.06;

static double dot_product(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void orient_camera(picture_camera *camera, double azimuth, double elevation, bool y_up) {
    const double side[3] = {1.0, 0.0, 0.0};
    const double front[3] = {0.0, y_up ? 0.0 : -1.0, y_up ? 1.0 : 0.0};
    const double up[3] = {0.0, y_up ? 1.0 : 0.0, y_up ? 0.0 : 1.0};
    double ca = cos(azimuth * pi / 180.0), sa = sin(azimuth * pi / 180.0);
    double ce = cos(elevation * pi / 180.0), se = sin(elevation * pi / 180.0);
    for (int i = 0; i < 3; i++) {
        double outward = ca * front[i] + sa * side[i];
        camera->right[i] = ca * side[i] - sa * front[i];
        camera->forward[i] = -(ce * outward + se * up[i]);
        camera->down[i] = se * outward - ce * up[i];
    }
}

/* The least distance of the eye: the greatest extent of the points along an axis or, for a single point, a
 * small share of its distance from the origin. */
static double least_distance(const double *points, size_t point_count) {
    double extent = 0.0, magnitude = 0.0;
    for (size_t i = 0; i < 3 * point_count; i++) {
        extent = fmax(extent, fabs(points[i] - points[i % 3]));
        magnitude = fmax(magnitude, fabs(points[i]));
    }
    return extent > 1e-9 * magnitude ? 0.01 * extent : 1e-3 * magnitude + 1e-30;
}

/* Tangents of the half angles of view, kept free of the margin. */
static void free_slopes(const picture_camera *camera, double width, double height, double slope[2]) {
    double frame = margin * fmin(width, height);
    slope[0] = (0.5 * width - frame) / camera->focal;
    slope[1] = (0.5 * height - frame) / camera->focal;
}

/* Places the eye. Across one image axis, with s the tangent of the half angle kept free of the margin, a
 * point at (r, f) in camera axes is inside when |r - eye_r| <= s (f - eye_f). With A = max(r - s f) and B =
 * max(-r - s f) over the points, both sides are tight at eye_r = (A - B) / 2 and eye_f = -(A + B) / (2 s);
 * the axis that asks for the greater distance decides eye_f, and eye_r stays the middle of what the other
 * axis allows. */
static void place_eye(picture_camera *camera, const double *points, size_t point_count, double width,
                      double height) {
    double slope[2], nearest = HUGE_VAL, across[2];
    double a[2] = {-HUGE_VAL, -HUGE_VAL}, b[2] = {-HUGE_VAL, -HUGE_VAL};
    free_slopes(camera, width, height, slope);
    for (size_t i = 0; i < point_count; i++) {
        double turned[3];
        picture_camera_turn(camera, points + 3 * i, turned);
        nearest = fmin(nearest, turned[2]);
        for (int axis = 0; axis < 2; axis++) {
            a[axis] = fmax(a[axis], turned[axis] - slope[axis] * turned[2]);
            b[axis] = fmax(b[axis], -turned[axis] - slope[axis] * turned[2]);
        }
    }
    double distance = least_distance(points, point_count), forward = nearest - distance;
    for (int axis = 0; axis < 2; axis++) {
        across[axis] = 0.5 * (a[axis] - b[axis]);
        forward = fmin(forward, -(a[axis] + b[axis]) / (2.0 * slope[axis]));
    }
    for (int i = 0; i < 3; i++)
        camera->eye[i] =
            across[0] * camera->right[i] + across[1] * camera->down[i] + forward * camera->forward[i];
    int exponent;
    camera->near_depth = frexp(0.02 * (nearest - forward), &exponent);
    camera->unit = ldexp(1.0, -exponent);
}

/* All but the eye. */
static void set_lens(picture_camera *out, double azimuth, double elevation, bool y_up, double width,
                     double height) {
    orient_camera(out, azimuth, elevation, y_up);
    out->focal = 0.5 * fmin(width, height) / tan(half_view_degrees * pi / 180.0);
    out->centre[0] = 0.5 * width;
    out->centre[1] = 0.5 * height;
}

void picture_camera_frame(const double *points, size_t point_count, double azimuth, double elevation,
                          bool y_up, uint32_t width, uint32_t height, picture_camera *out) {
    static const double origin[3] = {0.0, 0.0, 0.0};
    set_lens(out, azimuth, elevation, y_up, width, height);
    place_eye(out, point_count > 0 ? points : origin, point_count > 0 ? point_count : 1, width, height);
}

/* The points with the greatest A and B of either axis, and the nearest one; see place_eye. */
void picture_camera_outermost(const double *points, size_t point_count, double azimuth, double elevation,
                              bool y_up, uint32_t width, uint32_t height, double out[PICTURE_OUTERMOST][3]) {
    picture_camera camera;
    double slope[2], most[PICTURE_OUTERMOST];
    set_lens(&camera, azimuth, elevation, y_up, width, height);
    free_slopes(&camera, width, height, slope);
    for (int i = 0; i < PICTURE_OUTERMOST; i++) most[i] = -HUGE_VAL;
    memset(out, 0, PICTURE_OUTERMOST * sizeof *out);
    for (size_t i = 0; i < point_count; i++) {
        double turned[3];
        picture_camera_turn(&camera, points + 3 * i, turned);
        const double values[PICTURE_OUTERMOST] = {
            turned[0] - slope[0] * turned[2], -turned[0] - slope[0] * turned[2],
            turned[1] - slope[1] * turned[2], -turned[1] - slope[1] * turned[2], -turned[2]};
        for (int k = 0; k < PICTURE_OUTERMOST; k++) {
            if (!(values[k] > most[k])) continue;
            most[k] = values[k];
            memcpy(out[k], points + 3 * i, sizeof out[k]);
        }
    }
}

void picture_camera_unproject(const picture_camera *camera, double x, double y, double depth, double out[3]) {
    double across = (x - camera->centre[0]) / camera->focal, along = (y - camera->centre[1]) / camera->focal;
    double distance = depth / camera->unit;
    for (int i = 0; i < 3; i++)
        out[i] = camera->eye[i] +
                 distance * (across * camera->right[i] + along * camera->down[i] + camera->forward[i]);
}

void picture_camera_turn(const picture_camera *camera, const double direction[3], double out[3]) {
    double x = dot_product(camera->right, direction), y = dot_product(camera->down, direction);
    out[2] = dot_product(camera->forward, direction);
    out[0] = x;
    out[1] = y;
}

void picture_camera_project(const picture_camera *camera, const double point[3], double out[3]) {
    const double from_eye[3] = {point[0] - camera->eye[0], point[1] - camera->eye[1],
                                point[2] - camera->eye[2]};
    double turned[3];
    picture_camera_turn(camera, from_eye, turned);
    for (int i = 0; i < 3; i++) turned[i] *= camera->unit;
    out[0] = camera->focal * turned[0] + camera->centre[0] * turned[2];
    out[1] = camera->focal * turned[1] + camera->centre[1] * turned[2];
    out[2] = turned[2];
}

/* ---- the camera of a picture: all in view, and none of it below the caption ------------------------------ */

/* The points that must be in view, and from where they are seen. */
typedef struct view {
    const double *points;
    size_t count;
    const picture_options *options;
} view;

/* Shifts the camera as if the picture began at (left, top). */
static void frame_beside(const view *v, double left, double top, picture_camera *out) {
    const picture_options *o = v->options;
    picture_camera_frame(v->points, v->count, o->azimuth, o->elevation, o->y_up, o->width - (uint32_t)left,
                         o->height - (uint32_t)top, out);
    out->centre[0] += floor(left);
    out->centre[1] += floor(top);
}

static bool is_below(const view *v, const picture_camera *camera, const double size[2]) {
    for (size_t i = 0; i < v->count; i++) {
        double at[3];
        picture_camera_project(camera, v->points + 3 * i, at);
        if (at[0] < size[0] * at[2] && at[1] < size[1] * at[2]) return true;
    }
    return false;
}

/* Pixels per length in the depth of the first point. */
static double scale_at(const view *v, const picture_camera *camera) {
    double at[3];
    picture_camera_project(camera, v->points, at);
    return camera->unit * camera->focal / at[2];
}

void picture_scene_camera(const picture_scene *scene, const picture_options *options, picture_camera *out) {
    double corners[8][3], size[2];
    if (options->camera != NULL) {
        *out = *options->camera;
        return;
    }
    for (int corner = 0; corner < 8; corner++)
        for (int i = 0; i < 3; i++)
            corners[corner][i] = corner >> i & 1 ? options->focus_max[i] : options->focus_min[i];
    const view v = {options->focus ? corners[0] : scene->positions, options->focus ? 8 : scene->vertex_count,
                    options};
    frame_beside(&v, 0.0, 0.0, out);
    picture_caption_size(options->width, options->height, options->text_scale, scene->caption, scene->legend,
                         scene->legend_count, size);
    if (v.count == 0 || options->focus || !is_below(&v, out, size)) return;
    picture_camera right_of, under;
    bool fits_right = size[0] < 0.75 * options->width, fits_under = size[1] < 0.75 * options->height;
    if (fits_right) frame_beside(&v, size[0], 0.0, &right_of);
    if (fits_under) frame_beside(&v, 0.0, size[1], &under);
    if (fits_right && (!fits_under || scale_at(&v, &right_of) > scale_at(&v, &under)))
        *out = right_of;
    else if (fits_under)
        *out = under;
}
