/* A picture of a triangle mesh with markers and a caption, as a PNG file; several of them as one; and colours
 * of numbers. */
#pragma once

#include "tool/io/animation.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- images -------------------------------------------------------------------------------------------- */

/* No side may be longer: keeps every size computation far from overflow. */
#define PICTURE_SIDE_MAX 16384u

/* Rows from the top, pixels from the left, four bytes each: red, green, blue and straight (not premultiplied)
 * alpha, the colours in sRGB. */
typedef struct picture_image {
    uint32_t width, height;
    uint8_t *pixels;
} picture_image;

/* A fully transparent picture. On false *out is untouched. */
bool picture_image_create(uint32_t width, uint32_t height, picture_image *out, io_error *error);

/* Frees what create allocated and zeroes the struct; a zeroed struct is fine. */
void picture_image_free(picture_image *image);

/* Lays `colour` with weight `coverage` (0..1) over the pixel; outside the picture nothing happens. */
void picture_image_blend(picture_image *image, int64_t x, int64_t y, const uint8_t colour[3],
                         double coverage);

/* On false *error names the file and the reason, and no half-written file is left. */
bool picture_image_write_png(const char *path, const picture_image *image, io_error *error);

/* ---- the camera ---------------------------------------------------------------------------------------- */

/* Camera space is right-handed: right, down, forward. */
typedef struct picture_camera {
    double right[3], down[3], forward[3], eye[3];
    double focal;      /* pixels */
    double centre[2];  /* pixels from the upper left corner */
    double near_depth; /* nearer than this along `forward` nothing is drawn; 0.5 to 1 */
    double unit;       /* depths are lengths times this power of two: single precision holds any model's */
} picture_camera;

/* Looks from azimuth and elevation (degrees) so that the points (x, y, z each; the corners of a box, say)
 * just fit into the picture, with a margin. Azimuth 0 looks along +y (z up: x to the right) or along -z (y
 * up: x to the right); it grows towards +x. A positive elevation looks down from above. */
void picture_camera_frame(const double *points, size_t point_count, double azimuth, double elevation,
                          bool y_up, uint32_t width, uint32_t height, picture_camera *out);

enum { PICTURE_OUTERMOST = 5 };

/* Picks those of many points that decide where picture_camera_frame, with the same arguments, places the
 * eye. So a whole motion can be framed with a few points of each of its frames. */
void picture_camera_outermost(const double *points, size_t point_count, double azimuth, double elevation,
                              bool y_up, uint32_t width, uint32_t height, double out[PICTURE_OUTERMOST][3]);

/* Homogeneous pixel coordinates: the point lies at (out[0] / out[2], out[1] / out[2]) in depth out[2], in
 * the camera's unit, which is negative behind the eye. */
void picture_camera_project(const picture_camera *camera, const double point[3], double out[3]);

/* The point of the world seen at pixel (x, y) in the given depth. */
void picture_camera_unproject(const picture_camera *camera, double x, double y, double depth, double out[3]);

/* A direction in camera space. */
void picture_camera_turn(const picture_camera *camera, const double direction[3], double out[3]);

/* ---- markers and a legend, which are drawn over the surface -------------------------------------------- */

/* A filled disc with an outline around a point; half transparent where the surface hides the point. */
typedef struct picture_marker {
    double position[3];
    float radius_pixels;
    uint8_t colour[4]; /* red, green, blue, alpha */
} picture_marker;

/* A coloured dot and what it stands for. */
typedef struct picture_legend {
    uint8_t colour[3];
    const char *text;
} picture_legend;

/* ---- pictures ------------------------------------------------------------------------------------------ */

#define PICTURE_SAMPLES_MAX 4u

/* Smooth: normals are interpolated, except across creases. Unlit: the colours exactly as given. */
typedef enum picture_shading { PICTURE_SMOOTH, PICTURE_FLAT, PICTURE_UNLIT } picture_shading;

typedef struct picture_mesh {
    uint32_t vertex_count, triangle_count;
    const double *positions;
    const uint32_t *triangles;
} picture_mesh;

/* All arrays stay the caller's. Coordinates must be finite. Scenery is drawn where it is in view, its
 * triangles from either side, and never decides on the camera. */
typedef struct picture_scene {
    uint32_t vertex_count, triangle_count;
    const double *positions;         /* x, y, z per vertex */
    const uint32_t *triangles;       /* 3 per triangle, counter-clockwise from outside */
    const uint8_t *triangle_colours; /* RGB per triangle, or NULL */
    const uint8_t *vertex_colours;   /* RGB per vertex, or NULL; triangle_colours go first */
    const picture_mesh *scenery;     /* ground, stairs, a ball beside it; or NULL */
    const picture_marker *markers;   /* may be NULL when marker_count is 0 */
    size_t marker_count;
    const char *caption;          /* one line in the upper left corner, or NULL */
    const picture_legend *legend; /* lines below it; may be NULL when legend_count is 0 */
    size_t legend_count;
} picture_scene;

typedef struct picture_options {
    uint32_t width, height;    /* pixels */
    double azimuth, elevation; /* degrees, see picture_camera_frame */
    bool y_up;                 /* else z is up */
    picture_shading shading;
    bool wire;        /* thin dark lines along the edges of triangles that are large enough */
    bool transparent; /* background, else white */
    uint32_t samples; /* a pixel is samples x samples samples, 1 to PICTURE_SAMPLES_MAX */
    bool focus;       /* frame the box below instead of all vertices: to zoom, or to keep still over frames */
    double focus_min[3], focus_max[3];
    const picture_camera *camera; /* this one instead of a framing of its own, or NULL */
    double text_scale;            /* of caption and legend, 1: as usual, 0: without them */
    double square; /* side of the faint squares on level scenery, which show motion and scale; 0: none */
} picture_options;

/* 1280 x 960, from the right and above, z up, smooth, no wires, on white, 3 x 3 samples, all in view. */
picture_options picture_options_defaults(void);

/* The camera that a rendering with these arguments uses. */
void picture_scene_camera(const picture_scene *scene, const picture_options *options, picture_camera *out);

/* Renders into a new image, which the caller frees. On false *out is untouched. */
bool picture_render_image(const picture_scene *scene, const picture_options *options, picture_image *out,
                          io_error *error);

/* Renders into a file. On false *error says why and no file is left. */
bool picture_render(const picture_scene *scene, const picture_options *options, const char *png_path,
                    io_error *error);

#define PICTURE_ENCODE_STEPS 4096

/* Tables for both directions; light is added and averaged in linear values. */
typedef struct picture_gamma {
    float linear[256];
    uint8_t encoded[PICTURE_ENCODE_STEPS + 1];
} picture_gamma;

void picture_gamma_set(picture_gamma *out);

/* linear is clamped to 0..1. */
uint8_t picture_gamma_encode(const picture_gamma *gamma, double linear);

/* A perceptually uniform map (viridis) from dark violet at 0 over green to yellow at 1; value is clamped. */
void picture_colour_map(double value, uint8_t rgb[3]);

/* One of 21 distinct colours, the first seven the most; those of index and index + 21 are the same. */
void picture_colour_category(uint32_t index, uint8_t rgb[3]);

typedef struct picture_sheet {
    picture_image image;
    uint32_t columns, tile_width, tile_height;
} picture_sheet;

/* White with thin lines between the tiles, exactly columns x ceil(tile_count / columns) tiles large. On false
 * *out is untouched. */
bool picture_sheet_create(uint32_t tile_count, uint32_t columns, uint32_t tile_width, uint32_t tile_height,
                          picture_sheet *out, io_error *error);

/* Copies the tile, which has the sheet's tile size, to place `index`, counted row by row from the upper left
 * corner; the lines stay, one pixel inside its left and upper side. */
void picture_sheet_place(picture_sheet *sheet, uint32_t index, const picture_image *tile);

/* ---- scenery ------------------------------------------------------------------------------------------- */

/* A mesh that is drawn beside the recording and never tested: ground, stairs, a ball. */
typedef struct picture_scenery {
    picture_mesh mesh; /* points into the file */
    mesh_file file;
    animation *frames; /* NULL: it stands still */
    uint32_t frame_count;
    const char *path; /* where the positions come from */
} picture_scenery;

/* frames_path: a point cache, a pattern or a folder, of frame_count frames or of one; or NULL. On false *out
 * holds nothing to close. */
bool picture_scenery_open(const char *model_path, const char *frames_path, uint32_t frame_count,
                          picture_scenery *out, io_error *error);

/* Moves it to its place in that frame of the recording. */
bool picture_scenery_read(picture_scenery *s, uint32_t frame, io_error *error);

/* Closes the files and frees the memory; a zeroed struct is fine. */
void picture_scenery_close(picture_scenery *s);
