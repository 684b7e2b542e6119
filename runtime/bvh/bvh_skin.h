/* How far trees have moved since a moment: while it is little, what was found then, with volumes widened by as much, holds.
 *
 * The skin of a Verlet list (Verlet 1967) for triangles. At the reference every vertex has a place in the frame of its tree.
 * Later it is off by at most `distance`, the same for all. Signs of triangles last while, besides, two corners of one
 * triangle are off by almost the same. Frames move linearly within an interval, so both bounds hold throughout if they hold at
 * both ends. Where corners in a leaf differ by more than its `stretch` at either end, its signs are computed for the interval. */
#pragma once

#include "runtime/bvh/bvh.h"

/* Records of one tree that one thread looks at at a time, and what it finds. */
typedef struct skin_chunk {
    uint32_t tree, begin, end;
    double farthest; /* squared */
} skin_chunk;

typedef struct skin_tree {
    uint32_t region, first_record, record_count;
    double origin[3];  /* of its frame at the reference, and */
    double ends[2][3]; /* at both ends of the interval looked at */
    double reach;
    float detector[3]; /* in the frame, where it stays */
} skin_tree;

typedef struct skin_leaf {
    uint32_t corners[3 * LANES]; /* records */
    uint32_t tree;
    uint8_t plus, minus; /* as in lane_flags */
} skin_leaf;

/* Everything is a copy, so that it does not matter what becomes of the trees. */
typedef struct bvh_skin {
    cscd_context *context;
    const bvh_kernels *kernels;
    uint32_t tree_count, record_count, leaf_count, chunk_count;
    skin_tree *trees;
    uint32_t *vertices; /* per record */
    float (*items)[8];  /* per record: x y z . at the reference, and how far it is from there: x y z . */
    skin_leaf *leaves;
    float *stretches; /* per leaf, scaled and squared */
    bool *stray_at_start,
        *stray_at_end; /* per leaf: its corners differ by more at that end of the interval */
    bool *within;      /* per SKIN_LEAVES leaves: the outcome */
    skin_chunk *chunks;
    double scale;
    double distance; /* a length */
} bvh_skin;

enum { SKIN_LEAVES = 256 };

/* Makes room for the records and leaves of trees. The skin is zeroed before its first call; its memory is used again. False: no
 * memory, and nothing holds. */
bool bvh_skin_reserve(bvh_skin *s, const bvh *hierarchy);

/* What orientations have to endure, for bvh_orient, so that bvh_skin_set can follow. */
orientation_lasting bvh_skin_lasting(const bvh_skin *s, const bvh *hierarchy, double distance,
                                     double least_stretch);

/* Takes the places that the last refit, which was to a moment, has given to the records, and what the last bvh_orient says of
 * leaves and detector points. */
void bvh_skin_set(bvh_skin *s, const bvh *hierarchy, double distance);
void bvh_skin_free(bvh_skin *s);

/* Are all vertices near their places throughout an interval, at the start of which they are, and do all signs last? */
bool bvh_skin_holds(bvh_skin *s, const double *x0, const double *x1);

/* The interval that bvh_skin_holds has looked at last was gone through: its end is the start of the next one. */
void bvh_skin_take(bvh_skin *s);

/* Writes where the detector points of regions are in the interval that bvh_skin_holds has looked at last. */
void bvh_skin_points(const bvh_skin *s, double (*points)[2][3]);

/* How far vertices move in the frames of trees, and by how much the corners of a leaf differ in this. */
typedef struct skin_motion {
    double distance, stretch; /* lengths */
} skin_motion;

/* Estimates the motion from x0 to x1, by samples: no bound. */
skin_motion bvh_skin_estimate(const bvh *hierarchy, const double *x0, const double *x1);
