/* A small recording of two objects, and a run of the library over it that exports each frame. */
#pragma once

#include "src/tool/export/exports.h"
#include "tests/support/temp_file.h"

enum { FIRST_FRAME = 7, FRAMES = 3, FRAME_APART = 1 };

typedef struct export_scene {
    temp_folder folder;
    temp_path wall_path, bar_path, bar_pattern;
    recording_options options; /* the recording points into these */
    recording recording;
    part_names parts;
    cscd_plan *plan; /* NULL: none */
    cscd_detector *detector;
    double *x0, *x1; /* of the last frame: x1 */
    cscd_contact *contacts;
    size_t contact_count;
    cscd_intersection_pairs found;
    exports exports;
} export_scene;

/* The wall is a box from -1 to 1 (Box) with a seed in its middle (Seed). The bar (Rod) reaches 0.5 deep into it through the side
 * where x is largest, is out in the second frame, and then in by 0.25. Each of the three has 8 vertices and 12 triangles,
 * two for each of its six quads. plan: with one by charge. */
void export_scene_open(export_scene *s, const temp_folder *folder, bool plan);
void export_scene_close(export_scene *s);

/* The same, of the exports, which come after the scene and are closed with it. The test fails if they cannot be opened. */
void export_scene_start(export_scene *s, const export_request *request);

/* Frames in their order. */
void export_scene_add_frame(export_scene *s, uint32_t frame);
