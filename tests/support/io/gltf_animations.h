/* glTF files with animations of one triangle. */
#pragma once

#include "tests/support/io/gltf_fixture.h"

extern const double gltf_animations_triangle[9];

/* The keys of one channel. */
typedef struct gltf_channel_keys {
    const char *path, *interpolation, *type;
    size_t time_count, value_count; /* numbers */
    const double *times, *values;
} gltf_channel_keys;

/* A triangle that one channel of the animation "Walk" moves. Its two targets move vertex 1 by 1 along y, and vertex 2 by 1 along
 * z. */
file_bytes gltf_animations_channel(gltf_fixture *fixture, gltf_channel_keys keys);

#define GLTF_MOVE_NODE_1  "{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}}"
#define GLTF_SCALE_NODE_0 "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"scale\"}}"

/* Node 1 is above node 0, which has the triangle, and node 2 has a matrix. Animation "A" has these channels and two samplers: 0
 * moves by 8 along x in the times 0 to 2, 1 scales from 1 to 3 in the times 0.5 to 1. Animation "B" moves node 0 by 8 along x in
 * the times 0.5 to 1. */
file_bytes gltf_animations_two(gltf_fixture *fixture, const char *channels_of_a);
