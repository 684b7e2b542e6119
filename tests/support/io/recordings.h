/* Recordings for tests: meshes with frames and the files that hold them, point caches built byte by byte, and
 * checks of what is read. */
#pragma once

#include "tests/support/files.h"
#include "tool/io/animation.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Every position is exact in float32, so that all formats hold the same numbers. */
typedef struct recorded {
    uint32_t vertex_count, triangle_count, frame_count;
    uint32_t *triangles; /* triangle_count * 3 */
    double *frames;      /* frame_count * vertex_count * 3 */
} recorded;

/* The tetrahedron 4 5 6 7 flies with its tip 4 at (3.5 - k, 1, 1) in frame k through the tetrahedron 0 1 2
 * 3, whose face 0 1 2 (triangle 0) lies in x = 0 and whose opposite face passes through x = -2 there. So
 * the tip touches triangle 0 at (0, 1, 1) half way through interval 3, frames 4 and later have an
 * intersection, nothing happens in interval 4, and the tip leaves at (-2, 1, 1) half way through interval
 * 5. */
recorded recorded_tetrahedra(uint32_t frame_count);

/* An open strip of columns by rows quads (columns: 8 or more), slightly wavy, whose right half folds over by
 * 200 degrees, so that it passes through the left half in the last third of the frames. */
recorded recorded_fold(uint32_t columns, uint32_t rows, uint32_t frame_count);

/* A turned cube flies in three frames into the tip of a tetrahedron, and on. Clean, it has 8 vertices
 * beside the 4 of the tetrahedron. Split, it has 24: each side has its own four vertices, as exporters
 * write them. The triangles come in the same order. */
recorded recorded_cube(bool split);

/* A closed torus of rings by segments quads. One frame. */
recorded recorded_torus(uint32_t rings, uint32_t segments);

void recorded_free(recorded *r);

const double *recorded_position(const recorded *r, uint32_t frame, uint32_t vertex);

/* Writes one frame as a mesh file: .obj or .ply (ascii), by the name's extension. */
temp_path recorded_write_mesh(const temp_folder *folder, const char *name, const recorded *r, uint32_t frame);

/* Writes the first frame as an OBJ file in which each triangle stands below records of its own: "o Wall", "o Dart\ng Tip". */
temp_path recorded_write_parts(const temp_folder *folder, const char *name, const recorded *r,
                               const char *const *records);

/* Writes all frames as a point cache: .pc2 or .mdd. */
temp_path recorded_write_cache(const temp_folder *folder, const char *name, const recorded *r);

/* Writes frame_count frames as a point cache: those of the recording forwards, backwards, forwards, ... */
temp_path recorded_write_cycle(const temp_folder *folder, const char *name, const recorded *r,
                               uint32_t frame_count);

/* ---- point caches byte by byte ------------------------------------------------------------------------- */

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
