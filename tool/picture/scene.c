/* Renders a scene: places the camera, projects, finds what is visible, shades, draws the markers and
 * writes the file. */
#include "tool/picture/scene.h"

#include <stdlib.h>

picture_options picture_options_defaults(void) {
    return (picture_options){.width = 1280,
                             .height = 960,
                             .azimuth = 30.0,
                             .elevation = 25.0,
                             .shading = PICTURE_SMOOTH,
                             .samples = 3,
                             .text_scale = 1.0};
}

static bool check_triangles(const char *what, const uint32_t *triangles, uint32_t triangle_count,
                            uint32_t vertex_count, io_error *error) {
    for (size_t i = 0; i < 3 * (size_t)triangle_count; i++)
        if (triangles[i] >= vertex_count)
            return io_fail(error, "%s: triangle %zu names vertex %u, but there are %u", what, i / 3,
                           (unsigned)triangles[i], (unsigned)vertex_count);
    return true;
}

static bool check_scene(const picture_scene *scene, io_error *error) {
    const picture_mesh *scenery = scene->scenery;
    if (!check_triangles("picture", scene->triangles, scene->triangle_count, scene->vertex_count, error))
        return false;
    if (scenery == NULL) return true;
    if (scenery->triangle_count > PICTURE_NO_TRIANGLE - scene->triangle_count)
        return io_fail(error, "picture of %u and %u triangles: more than there are numbers for",
                       (unsigned)scene->triangle_count, (unsigned)scenery->triangle_count);
    return check_triangles("scenery", scenery->triangles, scenery->triangle_count, scenery->vertex_count,
                           error);
}

/* Per-vertex arrays of one mesh in one rendering. */
typedef struct vertex_arrays {
    double *projected;
    float *normals;
} vertex_arrays;

static void vertex_arrays_free(vertex_arrays *arrays) {
    free(arrays->projected);
    free(arrays->normals);
}

static bool prepare_vertices(const picture_mesh *mesh, bool smooth, const picture_camera *camera,
                             vertex_arrays *out, io_error *error) {
    size_t count = mesh->vertex_count;
    vertex_arrays arrays = {malloc(3 * (count + 1) * sizeof *arrays.projected), NULL};
    if (smooth) arrays.normals = malloc(3 * (count + 1) * sizeof *arrays.normals);
    if (arrays.projected == NULL || (smooth && arrays.normals == NULL)) {
        vertex_arrays_free(&arrays);
        return io_fail(error, "picture of %zu vertices: out of memory", count);
    }
    for (size_t vertex = 0; vertex < count; vertex++)
        picture_camera_project(camera, mesh->positions + 3 * vertex, arrays.projected + 3 * vertex);
    if (smooth)
        picture_vertex_normals(camera, mesh->positions, mesh->vertex_count, mesh->triangles,
                               mesh->triangle_count, arrays.normals);
    *out = arrays;
    return true;
}

static void draw_surfaces(const picture_surface surfaces[2], const picture_options *options,
                          const picture_camera *camera, picture_visibility *visibility,
                          picture_image *image) {
    uint32_t first_number = 0;
    for (int i = 0; i < 2; i++) {
        picture_visibility_draw(visibility, surfaces[i].projected, surfaces[i].triangles,
                                surfaces[i].triangle_count, first_number, camera->near_depth);
        first_number += surfaces[i].triangle_count;
    }
    picture_shade(visibility, surfaces, camera, options->transparent, image);
}

static bool draw_meshes(const picture_scene *scene, const picture_options *options,
                        const picture_camera *camera, picture_visibility *visibility, picture_image *image,
                        io_error *error) {
    static const picture_mesh nothing = {0};
    bool smooth = options->shading == PICTURE_SMOOTH;
    const picture_mesh body = {scene->vertex_count, scene->triangle_count, scene->positions,
                               scene->triangles};
    const picture_mesh *scenery = scene->scenery != NULL ? scene->scenery : &nothing;
    picture_shadow shadow = {0};
    const picture_ground ground = {options->square, options->y_up, &shadow};
    vertex_arrays own = {0}, other = {0};
    bool prepared = (scene->scenery == NULL ||
                     picture_shadow_create(scene->positions, scene->vertex_count, scene->triangles,
                                           scene->triangle_count, options->y_up, &shadow, error)) &&
                    prepare_vertices(&body, smooth, camera, &own, error) &&
                    prepare_vertices(scenery, smooth, camera, &other, error);
    const picture_surface surfaces[2] = {{.projected = own.projected,
                                          .normals = own.normals,
                                          .triangles = scene->triangles,
                                          .triangle_count = scene->triangle_count,
                                          .triangle_colours = scene->triangle_colours,
                                          .vertex_colours = scene->vertex_colours,
                                          .shading = options->shading,
                                          .wire = options->wire},
                                         {.projected = other.projected,
                                          .normals = other.normals,
                                          .triangles = scenery->triangles,
                                          .triangle_count = scenery->triangle_count,
                                          .shading = options->shading,
                                          .ground = &ground}};
    if (prepared) draw_surfaces(surfaces, options, camera, visibility, image);
    vertex_arrays_free(&own);
    vertex_arrays_free(&other);
    picture_shadow_free(&shadow);
    return prepared;
}

static bool draw_scene(const picture_scene *scene, const picture_options *options,
                       picture_visibility *visibility, picture_image *image, io_error *error) {
    picture_camera camera;
    picture_scene_camera(scene, options, &camera);
    if (!draw_meshes(scene, options, &camera, visibility, image, error) ||
        !picture_draw_markers(image, visibility, &camera, scene->markers, scene->marker_count, error))
        return false;
    picture_draw_caption(image, options->text_scale, scene->caption, scene->legend, scene->legend_count);
    return true;
}

bool picture_render_image(const picture_scene *scene, const picture_options *options, picture_image *out,
                          io_error *error) {
    picture_image image = {0};
    picture_visibility visibility = {0};
    bool drawn =
        check_scene(scene, error) && picture_image_create(options->width, options->height, &image, error) &&
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
