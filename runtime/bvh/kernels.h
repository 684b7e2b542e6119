/* The inner loops, compiled once per instruction set: what differs between processors is behind this table.
 */
#pragma once

#include "src/core/context.h"

struct cscd_mesh;
struct bvh;
struct bvh_tree;
struct representatives;
struct separation;
struct traversal;
struct traversal_lane;
struct triangle_pair;

/* Of the records that were copied: the largest magnitude of a coordinate, and the sums by record_weights of
 * those at the start and at the end. */
typedef struct copied {
    double reach, weighted[2][3];
} copied;

/* Along the axes, added up. */
typedef struct extents {
    double leaves, triangles;
} extents;

enum { KERNEL_LANES = 8 };

/* Sets of pairs of features of two triangles a and b: bit i is vertex i of a against the face b,
 * FEATURE_VERTEX_B + i vertex i of b against the face a, FEATURE_EDGES + 3 i + j edge i of a against edge j
 * of b. */
enum { FEATURE_VERTEX_B = 3, FEATURE_EDGES = 6, FEATURE_ALL = (1 << 15) - 1 };

/* Where pairs of features and their points are found. */
typedef struct feature_source {
    const double *x0, *x1; /* three per vertex */
    const uint32_t (*triangles)[3], (*edges)[2];
} feature_source;

/* Pairs of features: vertex a[i] and triangle b[i], or edges a[i] and b[i]. Kernels take eight at a time, so
 * the arrays go on for seven more readable and writable places after the last pair. */
typedef struct feature_pairs {
    uint32_t *a, *b;
    uint32_t count;
} feature_pairs;

/* For eight pairs: what the roots say, and for hits the begin of the interval of the first that touches. */
typedef struct root_outcomes {
    uint32_t misses, hits; /* sets of lanes */
    double begin[KERNEL_LANES];
} root_outcomes;

typedef void root_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out);

/* For eight pairs: those that certainly stay farther apart than a limit's distance and tolerance, those
 * certainly within its distance at the start, and, for these, the nearest points there, as parameters and as
 * the way from b's to a's, and its length. */
typedef struct proximity_outcomes {
    uint32_t misses, hits; /* sets of lanes */
    double u[KERNEL_LANES], v[KERNEL_LANES], offset[3][KERNEL_LANES], distance[KERNEL_LANES];
} proximity_outcomes;

typedef void proximity_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                              const struct separation *limit, proximity_outcomes *out);

typedef struct kernels {
    const char *name;

    /* Fills records begin to end - 1, multiples of 8, of a part; see runtime/bvh/bvh.h. */
    void (*copy_in)(const struct bvh *f, const struct bvh_tree *p, uint32_t begin, uint32_t end,
                    const double *x0, const double *x1, copied *out);

    /* Bounds of the children of blocks begin to end - 1 of any level but the part level. */
    void (*refit)(const struct bvh *f, int level, uint32_t begin, uint32_t end);

    /* How far leaves, and their triangles, extend at the start. */
    extents (*extents_at_start)(const struct bvh *f);

    /* Flags of leaves begin to end - 1 of a part, and orientations of their triangles; states: triangle_state
     * of each triangle of the mesh, of which only the clean ones have an orientation; NULL: all. */
    void (*orient)(const struct bvh *f, const struct bvh_tree *p, uint32_t begin, uint32_t end,
                   const uint8_t *states, uint8_t *orientations);

    /* Visits block pairs of the lane's stack, at most visits_max, until it is empty or there is no room for
     * what another visit may add. */
    void (*search)(const struct traversal *t, struct traversal_lane *lane, size_t visits_max);

    /* Of the pairs of features of two triangles, in slots, those that may touch, or come within distance, by
     * their volumes, and that share no vertex. */
    void (*feature_filter)(const struct bvh *f, const struct triangle_pair *pairs, uint32_t count,
                           double distance, uint16_t *features);

    /* Of features of pairs of triangles, those that these represent; open: those whose representatives share
     * a vertex, where the features share none. */
    void (*represent)(const struct cscd_mesh *mesh, const struct representatives *r,
                      const struct triangle_pair *pairs, uint32_t count, uint16_t *features, uint16_t *open);

    /* Keeps the pairs that signs leave open, in their order. The same operations as separated_by_axes and
     * coplanarity_excluded, so the same verdicts. */
    void (*keep_open_vf)(const feature_source *source, feature_pairs *pairs);
    void (*keep_open_ee)(const feature_source *source, feature_pairs *pairs);

    /* Level two for pairs from a[0], b[0] to a[7], b[7]: where the cubic has one root for certain, */
    root_kernel *roots_vf, *roots_ee;

    /* and where it has two, or none. */
    root_kernel *two_roots_vf, *two_roots_ee;

    /* Pairs from a[0], b[0] to a[7], b[7]. */
    proximity_kernel *proximity_vf, *proximity_ee;

    /* Of pairs of different triangles, in place and in any order, keeps those that may meet (see
     * src/mesh/triangle_intersection.h) at positions, which are as positions_check wants them; returns how
     * many. */
    uint32_t (*keep_meeting)(const uint32_t (*triangles)[3], const double *positions,
                             struct triangle_pair *pairs, uint32_t count);

    /* Of triangles, in place, keeps those that may be without area. */
    uint32_t (*keep_thin)(const uint32_t (*triangles)[3], const double *positions, uint32_t *list,
                          uint32_t count);
} kernels;

/* Of the context's level. */
const kernels *kernels_of(const cscd_context *context);

/* One per level; the library holds those that the build's processor family has. */
extern const kernels kernels_scalar;
#ifdef CSCD_WITH_AVX
extern const kernels kernels_avx2, kernels_avx512;
#endif
