/* Renders a scene: places the camera, projects, finds what is visible, shades, draws the markers and writes
 * the file. Puts pictures side by side, and gives numbers colours. */
#include "tool/picture/picture.h"

#include "tool/picture/shade.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* ---- colours of numbers ---------------------------------------------------------------------------------- */

/* The transfer functions of IEC 61966-2-1. */
static double decode_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

void picture_gamma_set(picture_gamma *out) {
    for (int i = 0; i < 256; i++) out->linear[i] = (float)decode_srgb(i / 255.0);
    for (int i = 0; i <= PICTURE_ENCODE_STEPS; i++)
        out->encoded[i] = (uint8_t)(255.0 * encode_srgb((double)i / PICTURE_ENCODE_STEPS) + 0.5);
}

uint8_t picture_gamma_encode(const picture_gamma *gamma, double linear) {
    if (!(linear > 0.0)) return 0;
    return gamma->encoded[linear < 1.0 ? (int)(linear * PICTURE_ENCODE_STEPS + 0.5) : PICTURE_ENCODE_STEPS];
}

/* Viridis (Smith and van der Walt, 2015, in the public domain) at every eighth; linear between is not told
 * apart by the eye. */
static const uint8_t viridis[9][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                      {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                      {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};

void picture_colour_map(double value, uint8_t rgb[3]) {
    double place = 8.0 * (value > 0.0 ? fmin(value, 1.0) : 0.0);
    int lower = place < 7.0 ? (int)place : 7;
    double share = place - lower;
    for (int i = 0; i < 3; i++)
        rgb[i] = (uint8_t)(viridis[lower][i] * (1.0 - share) + viridis[lower + 1][i] * share + 0.5);
}

/* The colours of Okabe and Ito (2008), told apart with any colour vision; then the same lighter, and
 * darker. */
void picture_colour_category(uint32_t index, uint8_t rgb[3]) {
    static const uint8_t hues[7][3] = {{86, 180, 233}, {230, 159, 0}, {0, 158, 115},  {213, 94, 0},
                                       {240, 228, 66}, {0, 114, 178}, {204, 121, 167}};
    static const struct {
        uint16_t target, share; /* how many 256ths of the way to this grey */
    } tones[3] = {{0, 0}, {255, 128}, {0, 112}};
    const uint8_t *hue = hues[index % 7];
    uint32_t tone = index / 7 % 3, share = tones[tone].share, target = tones[tone].target;
    for (int i = 0; i < 3; i++) rgb[i] = (uint8_t)((hue[i] * (256 - share) + target * share) / 256);
}

/* ---- several pictures as one ----------------------------------------------------------------------------- */

static const uint8_t line_colour[3] = {150, 152, 156};

/* Lines to the left and above, but not at the rim of the sheet. */
static void rule_place(picture_sheet *sheet, uint32_t index) {
    uint32_t left = index % sheet->columns * sheet->tile_width,
             top = index / sheet->columns * sheet->tile_height;
    for (uint32_t row = 0; left > 0 && row < sheet->tile_height; row++)
        picture_image_blend(&sheet->image, left, top + row, line_colour, 1.0);
    for (uint32_t column = 0; top > 0 && column < sheet->tile_width; column++)
        picture_image_blend(&sheet->image, left + column, top, line_colour, 1.0);
}

bool picture_sheet_create(uint32_t tile_count, uint32_t columns, uint32_t tile_width, uint32_t tile_height,
                          picture_sheet *out, io_error *error) {
    uint64_t rows = columns > 0 ? ((uint64_t)tile_count + columns - 1) / columns : 0;
    uint64_t width = (uint64_t)columns * tile_width, height = rows * tile_height;
    if (width == 0 || height == 0 || width > PICTURE_SIDE_MAX || height > PICTURE_SIDE_MAX)
        return io_fail(error,
                       "%u tiles of %u x %u pixels in %u columns make %llu x %llu pixels: each side must be "
                       "1 to %u; draw fewer or smaller tiles",
                       (unsigned)tile_count, (unsigned)tile_width, (unsigned)tile_height, (unsigned)columns,
                       (unsigned long long)width, (unsigned long long)height, PICTURE_SIDE_MAX);
    picture_sheet sheet = {.columns = columns, .tile_width = tile_width, .tile_height = tile_height};
    if (!picture_image_create((uint32_t)width, (uint32_t)height, &sheet.image, error)) return false;
    memset(sheet.image.pixels, 255, (size_t)width * height * 4);
    for (uint32_t i = 0; i < rows * columns; i++) rule_place(&sheet, i);
    *out = sheet;
    return true;
}

void picture_sheet_place(picture_sheet *sheet, uint32_t index, const picture_image *tile) {
    uint32_t left = index % sheet->columns * sheet->tile_width,
             top = index / sheet->columns * sheet->tile_height;
    picture_image *image = &sheet->image;
    assert(top + sheet->tile_height <= image->height);
    assert(tile->width == sheet->tile_width && tile->height == sheet->tile_height);
    for (uint32_t row = 0; row < sheet->tile_height; row++)
        memcpy(image->pixels + 4 * ((size_t)(top + row) * image->width + left),
               tile->pixels + 4 * (size_t)row * tile->width, 4 * (size_t)tile->width);
    rule_place(sheet, index);
}

/* ---- scenery: a mesh that is drawn beside the recording and never tested ------------------------------- */

static bool open_frames(const char *frames_path, uint32_t frame_count, picture_scenery *s, io_error *error) {
    io_error reason;
    if (!animation_open(&frames_path, 1, s->file.vertex_count, NULL, &s->frames, &reason))
        return io_fail(error, "--scenery-frames: %s", reason.text);
    s->frame_count = animation_frame_count(s->frames);
    if (s->frame_count == 1 || s->frame_count == frame_count) return true;
    return io_fail(error, "--scenery-frames %s: %u frames, expected one or the recording's %u", frames_path,
                   s->frame_count, frame_count);
}

bool picture_scenery_open(const char *model_path, const char *frames_path, uint32_t frame_count,
                          picture_scenery *out, io_error *error) {
    picture_scenery s = {.path = frames_path != NULL ? frames_path : model_path};
    if (!mesh_file_read(model_path, &s.file, error) ||
        (frames_path != NULL && !open_frames(frames_path, frame_count, &s, error))) {
        picture_scenery_close(&s);
        return false;
    }
    s.mesh = (picture_mesh){s.file.vertex_count, s.file.triangle_count, s.file.positions, s.file.triangles};
    *out = s;
    return true;
}

/* Checks the range that can be drawn: products of a few coordinates must stay finite. */
static bool check_range(const picture_scenery *s, uint32_t frame, io_error *error) {
    const double *x = s->file.positions;
    for (size_t i = 0; i < (size_t)s->file.vertex_count * 3; i++)
        if (!(fabs(x[i]) <= 0x1p300))
            return io_fail(
                error, "%s: frame %u of it: vertex %zu has %c = %g, expected a magnitude of 2^300 at most",
                s->path, frame, i / 3, "xyz"[i % 3], x[i]);
    return true;
}

bool picture_scenery_read(picture_scenery *s, uint32_t frame, io_error *error) {
    uint32_t own = s->frame_count > 1 ? frame : 0;
    if (s->frames != NULL && !animation_read(s->frames, own, s->file.positions, error)) return false;
    return check_range(s, own, error);
}

void picture_scenery_close(picture_scenery *s) {
    animation_close(s->frames);
    mesh_file_free(&s->file);
    *s = (picture_scenery){0};
}
