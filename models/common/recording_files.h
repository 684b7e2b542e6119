/* The files of a recording, side by side in one folder: a model, its frames, and the same of its scenery. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/point_cache_write.h"

/* Writes FOLDER/NAMEending; an empty folder is the current one. */
bool recording_write_model(const char *folder, const char *name, const char *ending, const body *b,
                           io_error *error);
bool recording_open_frames(const char *folder, const char *name, const char *ending, uint32_t vertex_count,
                           uint32_t frame_count, point_cache_writer **out, io_error *error);
