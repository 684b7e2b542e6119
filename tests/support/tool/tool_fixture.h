/* Recordings that the tests of the tool replay: meshes with frames, and the files that hold them. */
#pragma once

#include "tests/support/files.h"

#include <stdbool.h>
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
