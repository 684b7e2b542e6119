/* A mesh that is drawn beside the recording and never tested: ground, stairs, a ball. */
#pragma once

#include "tool/io/animation.h"
#include "tool/io/mesh_file.h"
#include "tool/picture/picture.h"

typedef struct scenery {
    picture_mesh mesh; /* points into the file */
    mesh_file file;
    animation *frames; /* NULL: it stands still */
    uint32_t frame_count;
    const char *path; /* where the positions come from */
} scenery;

/* frames_path: a point cache, a pattern or a folder, of frame_count frames or of one; or NULL. On false *out
 * holds nothing to close. */
bool scenery_open(const char *model_path, const char *frames_path, uint32_t frame_count, scenery *out,
                  io_error *error);

/* Moves it to its place in that frame of the recording. */
bool scenery_read(scenery *s, uint32_t frame, io_error *error);

/* Closes the files and frees the memory; a zeroed struct is fine. */
void scenery_close(scenery *s);
