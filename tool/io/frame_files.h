/* Sequences of mesh files, one per frame; only their positions are read. */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct frame_files frame_files;

/* Looks at names only. On false *out is untouched. frame_pattern.h, frame_folder.h and frame_series.h say what belongs to
 * a sequence, in which order, and what allow_gaps allows. */
bool frame_files_open_pattern(const char *pattern, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                              io_error *error);
bool frame_files_open_folder(const char *folder, bool allow_gaps, uint32_t vertex_count, frame_files **out,
                             io_error *error);

/* Takes the paths, percent signs included, in the order of their numbers if they are a series, else in the order given;
 * each must be a file that exists. model_path, unless NULL, joins a series that it belongs to and is not in yet, and names that are no
 * series: it is then the first of them. */
bool frame_files_open_list(const char *const *paths, size_t path_count, const char *model_path,
                           bool allow_gaps, uint32_t vertex_count, frame_files **out, io_error *error);

/* From now on a frame with face_count faces is refused if they are not those of this hash (mesh_file.h): its vertices most
 * likely have another order. 0: none is. */
void frame_files_expect_faces(frame_files *files, uint32_t face_count, uint64_t faces_hash);
void frame_files_close(frame_files *files);

uint32_t frame_files_frame_count(const frame_files *files);

/* What the artist calls a frame: the number in its name, else its index. */
int32_t frame_files_number(const frame_files *files, uint32_t frame);

/* A sentence about the order of a list; NULL when there is nothing to say. */
const char *frame_files_note(const frame_files *files);

/* frame is below the count; positions takes vertex_count * 3 and is undefined on false. */
bool frame_files_read(frame_files *files, uint32_t frame, double *positions, io_error *error);

/* As animation_expect. */
void frame_files_expect(frame_files *files, uint32_t frame);
