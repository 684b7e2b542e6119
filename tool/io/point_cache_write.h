/* Writes PC2 and MDD point caches, frame by frame. A cache takes the place of an older file when it is whole
 * (output_file.h). */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct point_cache_writer point_cache_writer;

/* Begins the file for path, whose extension (.pc2 or .mdd) says the format, and writes the header. Counts are
 * 1 to INT32_MAX. PC2 gets start 0 and rate 1, MDD 24 frames a second. On false *out is untouched. */
bool point_cache_writer_open(const char *path, uint32_t vertex_count, uint32_t frame_count,
                             point_cache_writer **out, io_error *error);

/* Appends a frame, vertex_count * 3 positions rounded to float32; a value that is not finite in float32 is an
 * error. After an error nothing is left of the file, every further write fails, and only close is left to do. */
bool point_cache_writer_write(point_cache_writer *writer, const double *positions, io_error *error);

/* Always frees the writer; NULL is fine. True if all frame_count frames are in the file. If not, none of it is
 * there; *error is set unless a write has already failed and said why. */
bool point_cache_writer_close(point_cache_writer *writer, io_error *error);
