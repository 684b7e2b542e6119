/* The inner loops, compiled once per instruction set: what differs between processors is behind this table.
 */
#ifndef CSCD_KERNELS_H
#define CSCD_KERNELS_H

#include "src/context.h"

struct forest;
struct forest_part;
struct traversal;
struct traversal_lane;

/* Of the records that were copied: the largest magnitude of a coordinate, and the sums by record_weights of
 * those at the start and at the end. */
typedef struct copied {
    double reach, weighted[2][3];
} copied;

typedef struct kernels {
    const char *name;

    /* Fills records begin to end - 1, multiples of 8, of a part; see runtime/forest.h. */
    void (*copy_in)(const struct forest *f, const struct forest_part *p, uint32_t begin, uint32_t end,
                    const double *x0, const double *x1, copied *out);

    /* Bounds of the children of blocks begin to end - 1 of any level but the part level. */
    void (*refit)(const struct forest *f, int level, uint32_t begin, uint32_t end);

    /* Flags of leaves begin to end - 1 of a part, and orientations of their triangles; held: per triangle of
     * the mesh, those that are ZERO whatever their orientation; NULL: none. */
    void (*orient)(const struct forest *f, const struct forest_part *p, uint32_t begin, uint32_t end,
                   const uint8_t *held, uint8_t *orientations);

    /* Visits block pairs of the lane's stack, at most visits_max, until it is empty or there is no room for
     * what another visit may add. */
    void (*search)(const struct traversal *t, struct traversal_lane *lane, size_t visits_max);
} kernels;

/* Of the context's level. */
const kernels *kernels_of(const cscd_context *context);

/* One per level; the library holds those that the build's processor family has. */
extern const kernels kernels_scalar;
#ifdef CSCD_WITH_AVX
extern const kernels kernels_avx2, kernels_avx512;
#endif

#endif
