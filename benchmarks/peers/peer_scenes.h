/* Scenes for the programs that we are compared with: one mesh, and the positions at both ends of an interval; and what
 * Embree finds in them. */
#pragma once

#include "tool/io/io.h"

#include <stdint.h>

typedef struct peer_scene {
    char name[64];
    uint32_t vertex_count, triangle_count;
    uint32_t *triangles; /* triangle_count * 3 */
    double *start, *end; /* vertex_count * 3 each */
} peer_scene;

/* Reads two mesh files with the same triangles. */
bool peer_scene_read(const char *first, const char *second, peer_scene *out, io_error *error);

/* Reads folder/name.obj, and of folder/name.pc2 this frame and the next. */
bool peer_scene_replay(const char *folder, const char *name, uint32_t frame, peer_scene *out,
                       io_error *error);

/* Scenes that are made here. Positions are exact in single precision.
 *   balls    64 balls, each turned its own way, come together until they cross
 *   rods     49 rods side by side are twisted and bound together
 *   crushed  a figure is pressed together along its height, into folds that run into each other
 *   pawn     a body bends and waves, and touches nothing */
typedef enum peer_scene_kind {
    PEER_BALLS,
    PEER_RODS,
    PEER_CRUSHED,
    PEER_PAWN,
    PEER_KIND_COUNT
} peer_scene_kind;

/* Makes a scene of about this number of triangles. */
bool peer_scene_make(peer_scene_kind kind, uint32_t triangle_count, peer_scene *out, io_error *error);

void peer_scene_free(peer_scene *s);

/* ---- Embree -------------------------------------------------------------------------------------------- */

/* Its broad phase: pairs of triangles whose boxes over the interval overlap. */
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
