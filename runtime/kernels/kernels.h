/* The inner loops, compiled once per instruction set: what differs between processors is behind this table.
 */
#ifndef CSCD_KERNELS_H
#define CSCD_KERNELS_H

#include "src/context.h"

typedef struct kernels {
    const char *name;
} kernels;

/* Of the context's level. */
const kernels *kernels_of(const cscd_context *context);

/* One per level; the library holds those that the build's processor family has. */
extern const kernels kernels_scalar;
#ifdef CSCD_WITH_AVX
extern const kernels kernels_avx2, kernels_avx512;
#endif

#endif
