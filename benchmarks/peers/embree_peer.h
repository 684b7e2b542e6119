/* Embree's broad phase: pairs of triangles whose boxes over the interval overlap. */
#pragma once

#include "benchmarks/peers/peer_scenes.h"

typedef struct embree_peer embree_peer;

typedef struct embree_pairs {
    double update_ms, find_ms;
    uint64_t reported, pairs; /* pairs: distinct pairs whose boxes overlap */
} embree_pairs;

/* refit: the tree is kept, and its boxes follow; else it is built again for each interval. Returns NULL when
 * Embree gives no device. The scene must outlive it. */
embree_peer *embree_peer_open(const peer_scene *scene, bool refit, io_error *error);
void embree_peer_close(embree_peer *p);

/* Takes the interval in, and finds the pairs, on the calling thread. The first call builds the tree. */
bool embree_peer_step(embree_peer *p, embree_pairs *out, io_error *error);

/* "3.13.5" */
extern const char embree_peer_version[];
