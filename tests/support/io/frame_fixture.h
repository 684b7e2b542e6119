/* Recorded animations for tests: point caches built byte by byte, mesh files, and checks of what is read. */
#pragma once

#include "src/io/animation.h"
#include "src/io/io_error.h"
#include "tests/support/temp_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The folder of a test's files; the two functions are its cmocka set-up and tear-down. */
extern temp_folder frame_fixture_folder;
int frame_fixture_make_folder(void **state);
int frame_fixture_remove_folder(void **state);

/* A small file in memory. */
typedef struct frame_fixture_bytes {
    unsigned char data[4096];
    size_t size;
} frame_fixture_bytes;

/* Four bytes at offset, which may be the end; they fail the test where there is no room. */
void frame_fixture_put_int(frame_fixture_bytes *bytes, size_t offset, int32_t value, bool big_endian);
void frame_fixture_put_float(frame_fixture_bytes *bytes, size_t offset, float value, bool big_endian);

/* The coordinate that every fixture holds at (frame, vertex, axis); exact in float32. */
double frame_fixture_value(uint32_t frame, uint32_t vertex, uint32_t axis);

/* Whole files of those coordinates. */
frame_fixture_bytes frame_fixture_pc2(uint32_t vertex_count, uint32_t frame_count);
frame_fixture_bytes frame_fixture_mdd(uint32_t vertex_count, uint32_t frame_count);

temp_path frame_fixture_write(const temp_folder *folder, const char *name, const frame_fixture_bytes *bytes);

/* The frame as a mesh file with one triangle, in the format that the name's extension says. */
temp_path frame_fixture_write_mesh(const temp_folder *folder, const char *name, uint32_t vertex_count,
                                   uint32_t frame);

/* Opens what must open, one path. */
animation *frame_fixture_open(const char *path, uint32_t vertex_count);

/* Reads a frame that must be readable and compares every coordinate, exactly, with that of frame `expected`.
 */
void frame_fixture_check(animation *opened, uint32_t vertex_count, uint32_t frame, uint32_t expected);

/* The error is one line and holds every one of the parts (up to NULL). */
void frame_fixture_check_error(const io_error *error, ...);

/* Opening the one path fails and leaves the output alone; the error is put in *error. */
void frame_fixture_open_fails(const char *path, uint32_t vertex_count, io_error *error);

/* Reading the frame fails; the error is put in *error. */
void frame_fixture_read_fails(animation *opened, uint32_t vertex_count, uint32_t frame, io_error *error);
