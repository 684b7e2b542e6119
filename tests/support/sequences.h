/* Random recordings whose meshes pass into themselves, rest, come out, and pass in again. */
#pragma once

#include "tests/support/scenes.h"

enum { SEQUENCE_FRAMES_MAX = 64 };

typedef enum sequence_kind {
    SEQUENCE_SCENE, /* a closed scene; its frames lie along and beyond its interval, to and fro */
    SEQUENCE_GRID,  /* small closed shapes with small integer coordinates: everything is degenerate at once */
    SEQUENCE_KIND_COUNT
} sequence_kind;

typedef struct sequence {
    scene shape; /* its triangles and its rest positions x0 */
    uint32_t frame_count;
    double frames[SEQUENCE_FRAMES_MAX][SCENE_VERTICES_MAX * 3];
} sequence;

/* Makes a sequence; the same seed gives the same one. Half of the sequences face inwards. */
void sequence_make(sequence_kind kind, uint64_t seed, uint32_t frame_count, sequence *out);
