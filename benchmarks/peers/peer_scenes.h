/* Scenes for the programs that we are compared with: one mesh, and the positions at both ends of an
 * interval. */
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
