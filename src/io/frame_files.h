/* Sequences of mesh files, one per frame; only their positions are read. */
#pragma once

#include "src/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct frame_files frame_files;

/* Looks at names only. On false *out is untouched. frame_pattern.h and frame_folder.h say what belongs to a sequence
 * and in which order. */
bool frame_files_open_pattern(const char *pattern, uint32_t vertex_count, frame_files **out, io_error *error);
bool frame_files_open_folder(const char *folder, uint32_t vertex_count, frame_files **out, io_error *error);

/* Takes the paths as they are, percent signs included, in the order given; each must be a file that
 * exists. */
bool frame_files_open_list(const char *const *paths, size_t path_count, uint32_t vertex_count,
                           frame_files **out, io_error *error);
void frame_files_close(frame_files *files);

uint32_t frame_files_frame_count(const frame_files *files);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool frame_files_read(frame_files *files, uint32_t frame, double *positions, io_error *error);
