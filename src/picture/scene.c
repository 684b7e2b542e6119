/* Rendering as a whole: frame, project, see, shade, mark, write. */
#include "src/picture/scene.h"

#include <stdlib.h>

picture_options picture_options_defaults(void) {
    return (picture_options){.width = 1280,
                             .height = 960,
                             .azimuth = 30.0,
                             .elevation = 25.0,
                             .shading = PICTURE_SMOOTH,
                             .samples = 3};
}

static bool check_triangles(const picture_scene *scene, io_error *error) {
    for (size_t i = 0; i < 3 * (size_t)scene->triangle_count; i++)
        if (scene->triangles[i] >= scene->vertex_count)
            return io_fail(error, "picture: triangle %zu names vertex %u, but there are %u", i / 3,
                           (unsigned)scene->triangles[i], (unsigned)scene->vertex_count);
    return true;
}

void picture_scene_camera(const picture_scene *scene, const picture_options *options, picture_camera *out) {
    double corners[8][3];
    for (int corner = 0; corner < 8; corner++)
        for (int i = 0; i < 3; i++)
            corners[corner][i] = corner >> i & 1 ? options->focus_max[i] : options->focus_min[i];
    picture_camera_frame(options->focus ? corners[0] : scene->positions,
                         options->focus ? 8 : scene->vertex_count, options->azimuth, options->elevation,
                         options->y_up, options->width, options->height, out);
}

/* Per-vertex arrays of one rendering. */
typedef struct vertex_arrays {
    double *projected;
    float *normals;
} vertex_arrays;

static void vertex_arrays_free(vertex_arrays *arrays) {
    free(arrays->projected);
    free(arrays->normals);
}

static bool prepare_vertices(const picture_scene *scene, const picture_options *options,
                             const picture_camera *camera, vertex_arrays *out, io_error *error) {
    size_t count = scene->vertex_count;
    bool smooth = options->shading == PICTURE_SMOOTH;
    vertex_arrays arrays = {malloc(3 * (count + 1) * sizeof *arrays.projected), NULL};
    if (smooth) arrays.normals = malloc(3 * (count + 1) * sizeof *arrays.normals);
    if (arrays.projected == NULL || (smooth && arrays.normals == NULL)) {
        vertex_arrays_free(&arrays);
        return io_fail(error, "picture of %zu vertices: out of memory", count);
    }
    for (size_t vertex = 0; vertex < count; vertex++)
        picture_camera_project(camera, scene->positions + 3 * vertex, arrays.projected + 3 * vertex);
    if (smooth)
        picture_vertex_normals(camera, scene->positions, scene->vertex_count, scene->triangles,
                               scene->triangle_count, arrays.normals);
    *out = arrays;
    return true;
}

static bool draw_scene(const picture_scene *scene, const picture_options *options,
                       picture_visibility *visibility, picture_image *image, io_error *error) {
    picture_camera camera;
    vertex_arrays arrays = {0};
    picture_scene_camera(scene, options, &camera);
    if (!prepare_vertices(scene, options, &camera, &arrays, error)) return false;
    const picture_surface surface = {.projected = arrays.projected,
                                     .normals = arrays.normals,
                                     .triangles = scene->triangles,
                                     .triangle_colours = scene->triangle_colours,
                                     .vertex_colours = scene->vertex_colours,
                                     .shading = options->shading,
                                     .wire = options->wire};
    picture_visibility_draw(visibility, arrays.projected, scene->triangles, scene->triangle_count,
                            camera.near_depth);
    picture_shade(visibility, &surface, &camera, options->transparent, image);
    vertex_arrays_free(&arrays);
    if (!picture_draw_markers(image, visibility, &camera, scene->markers, scene->marker_count, error))
        return false;
    picture_draw_caption(image, scene->caption, scene->legend, scene->legend_count);
    return true;
}

bool picture_render_image(const picture_scene *scene, const picture_options *options, picture_image *out,
                          io_error *error) {
    picture_image image = {0};
    picture_visibility visibility = {0};
    bool drawn =
        check_triangles(scene, error) &&
        picture_image_create(options->width, options->height, &image, error) &&
        picture_visibility_create(options->width, options->height, options->samples, &visibility, error) &&
        draw_scene(scene, options, &visibility, &image, error);
    picture_visibility_free(&visibility);
    if (drawn)
        *out = image;
    else
        picture_image_free(&image);
    return drawn;
}

bool picture_render(const picture_scene *scene, const picture_options *options, const char *png_path,
                    io_error *error) {
    picture_image image;
    if (!picture_render_image(scene, options, &image, error)) return false;
    bool written = picture_image_write_png(png_path, &image, error);
    picture_image_free(&image);
    return written;
}
