/* The kernels of this level for pairs of features, for the table. */
#pragma once

#include "runtime/bvh/kernels.h"
#include "src/core/simd.h"

void SIMD_NAME(keep_open_vf)(const feature_source *source, feature_pairs *pairs);
void SIMD_NAME(keep_open_ee)(const feature_source *source, feature_pairs *pairs);
void SIMD_NAME(roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out);
void SIMD_NAME(roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out);
void SIMD_NAME(two_roots_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             root_outcomes *out);
void SIMD_NAME(two_roots_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             root_outcomes *out);
void SIMD_NAME(proximity_vf)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             const struct separation *limit, proximity_outcomes *out);
void SIMD_NAME(proximity_ee)(const feature_source *source, const uint32_t *a, const uint32_t *b,
                             const struct separation *limit, proximity_outcomes *out);
