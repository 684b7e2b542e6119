/* Random recordings whose meshes go into themselves, lie still, come out, and go in again. */
#pragma once

#include "tests/support/scenes.h"

enum { SEQUENCE_FRAMES_MAX = 64 };

typedef enum sequence_kind {
    SEQUENCE_SCENE, /* a closed scene, its frames along and beyond its interval, to and fro */
    SEQUENCE_GRID,  /* small closed shapes of small integer coordinates: everything degenerate, all at once */
    SEQUENCE_KIND_COUNT
} sequence_kind;

typedef struct sequence {
    scene shape; /* its triangles and its rest, x0 */
    uint32_t frame_count;
    double frames[SEQUENCE_FRAMES_MAX][SCENE_VERTICES_MAX * 3];
} sequence;

/* The same seed gives the same sequence; half of them face inwards. */
void sequence_make(sequence_kind kind, uint64_t seed, uint32_t frame_count, sequence *out);
