/* The camera of a picture: all in view, and none of it below the caption. */
#include "tool/picture/scene.h"

#include <math.h>

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
