/* A closed surface with deep folds, as of a cortex, and 100 frames in which its ridges swell into each other.
 *
 * A sphere of 20,480 triangles, five times subdivided from an icosahedron, has trenches where a field of waves is 0. Vertices lie on
 * rays from the centre, so no two triangles meet in the first frame. Then each vertex moves along its normal of that frame, most in some
 * places and not at all in others, until the banks of some trenches have passed through each other, and back again. */
#pragma once

#include <stdint.h>

enum {
    FOLDS_FRAMES = 100,
    FOLDS_VERTICES = 10242,
    FOLDS_TRIANGLES = 20480,
};

typedef struct folds {
    uint32_t triangles[FOLDS_TRIANGLES][3];
    double positions[FOLDS_VERTICES][3]; /* of the first frame */
    double swelling[FOLDS_VERTICES][3];  /* where a vertex is, less where it was, when it has swollen most */
} folds;

void folds_make(folds *f);

/* Positions of a frame; the first and the last one are the same. */
void folds_pose(const folds *f, int frame, double (*positions)[3]);
