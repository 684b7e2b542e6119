/* Recorded animations for tests: point caches built byte by byte, mesh files, and checks of what is read. */
#pragma once

#include "tests/support/files.h"
#include "tool/io/animation.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A small file in memory. */
typedef struct frame_fixture_bytes {
    unsigned char data[4096];
    size_t size;
} frame_fixture_bytes;

/* Writes four bytes at offset, which may be the end. The test fails when there is no room. */
void frame_fixture_put_int(frame_fixture_bytes *bytes, size_t offset, int32_t value, bool big_endian);
void frame_fixture_put_float(frame_fixture_bytes *bytes, size_t offset, float value, bool big_endian);

/* Returns the coordinate that every fixture has at (frame, vertex, axis); it is exact in float32. */
double frame_fixture_value(uint32_t frame, uint32_t vertex, uint32_t axis);

/* Makes whole files of those coordinates. */
frame_fixture_bytes frame_fixture_pc2(uint32_t vertex_count, uint32_t frame_count);
frame_fixture_bytes frame_fixture_mdd(uint32_t vertex_count, uint32_t frame_count);

temp_path frame_fixture_write(const temp_folder *folder, const char *name, const frame_fixture_bytes *bytes);

/* Writes the frame as an OBJ file with one triangle. */
temp_path frame_fixture_write_mesh(const temp_folder *folder, const char *name, uint32_t vertex_count,
                                   uint32_t frame);

/* Opens one path; the test fails when it cannot be opened. */
animation *frame_fixture_open(const char *path, uint32_t vertex_count);

/* Reads a frame and compares every coordinate exactly with that of frame `expected`. The test fails when
 * the frame cannot be read. */
void frame_fixture_check(animation *opened, uint32_t vertex_count, uint32_t frame, uint32_t expected);

/* Checks that the error is one line that contains every one of the parts, a list up to NULL. */
void frame_fixture_check_error(const io_error *error, ...);

/* Expects that opening the path fails and leaves the output unchanged; fills in *error. */
void frame_fixture_open_fails(const char *path, uint32_t vertex_count, io_error *error);

/* Expects that reading the frame fails; fills in *error. */
void frame_fixture_read_fails(animation *opened, uint32_t vertex_count, uint32_t frame, io_error *error);
