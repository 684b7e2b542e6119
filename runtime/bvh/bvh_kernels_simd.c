/* The table of the BVH's kernels, one per instruction set. */
#include "runtime/bvh/bvh_kernels_simd.h"

const bvh_kernels SIMD_NAME(bvh_kernels) = {
    .copy_in = SIMD_NAME(copy_in),
    .refit = SIMD_NAME(refit),
    .extents_at_start = SIMD_NAME(extents_at_start),
    .orient = SIMD_NAME(orient),
    .orient_lasting = SIMD_NAME(orient_lasting),
    .skin_move = SIMD_NAME(skin_move),
    .skin_signs = SIMD_NAME(skin_signs),
    .near_children = SIMD_NAME(near_children),
    .near_triangles = SIMD_NAME(near_triangles),
    .search = SIMD_NAME(search),
};
