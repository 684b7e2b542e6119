/* Do the swept 14-DOPs of two features overlap? */
#include "runtime/kernels/feature_kernels.h"
#include "runtime/kernels/keep.h"

#if SIMD_LEVEL == SIMD_SCALAR

typedef kdop volume;

static inline volume load_volume(const kdop *from) {
    return *from;
}

static inline volume join(volume a, volume b) {
    return kdop_union(&a, &b);
}

static inline uint32_t overlap(volume a, volume b) {
    return kdop_overlap(&a, &b);
}

#else

/* The bounds of a volume: those below (negated), and those above and another; seven of eight lanes count. */
typedef struct volume {
    f32x8 low, high;
} volume;

static inline volume load_volume(const kdop *from) {
    return (volume){f32x8_load(from->bounds), f32x8_load(from->bounds + KDOP_AXIS_COUNT - 1)};
}

static inline volume join(volume a, volume b) {
    return (volume){f32x8_max(a.low, b.low), f32x8_max(a.high, b.high)};
}

static inline f32x8 upper_bounds(volume v) {
    return __builtin_shufflevector(v.high, v.high, 1, 2, 3, 4, 5, 6, 7, 0);
}

/* A sum's sign is exact: the upper bound of one, less the lower one of the other. */
static inline uint32_t overlap(volume a, volume b) {
    f32x8 depth = f32x8_min(upper_bounds(a) + b.low, upper_bounds(b) + a.low);
    return (f32x8_below(depth, f32x8_all(0.0f)) & 127) == 0;
}

#endif

void SIMD_NAME(keep_near_vf)(const feature_source *source, feature_pairs *pairs) {
    const kdop *volumes = source->vertex_volumes;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pairs->count; i++) {
        const uint32_t *corners = source->triangles[pairs->b[i]];
        volume vertex = load_volume(&volumes[pairs->a[i]]), face = load_volume(&volumes[corners[0]]);
        face = join(join(face, load_volume(&volumes[corners[1]])), load_volume(&volumes[corners[2]]));
        kept = keep_pair(pairs, i, overlap(vertex, face), kept);
    }
    pairs->count = kept;
}

void SIMD_NAME(keep_near_ee)(const feature_source *source, feature_pairs *pairs) {
    const kdop *volumes = source->vertex_volumes;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < pairs->count; i++) {
        const uint32_t *ends_a = source->edges[pairs->a[i]], *ends_b = source->edges[pairs->b[i]];
        volume a = join(load_volume(&volumes[ends_a[0]]), load_volume(&volumes[ends_a[1]]));
        volume b = join(load_volume(&volumes[ends_b[0]]), load_volume(&volumes[ends_b[1]]));
        kept = keep_pair(pairs, i, overlap(a, b), kept);
    }
    pairs->count = kept;
}
