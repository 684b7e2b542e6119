/* Scenes of several objects that tear, are refined, lose triangles, are renumbered, come and go; and their meshes. */
#pragma once

#include "cscd/cscd.h"
#include "src/mesh/mesh.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

enum { CHANGING_OBJECTS_MAX = 6, CHANGING_VERTICES_MAX = 320, CHANGING_TRIANGLES_MAX = 600 };

typedef struct changing_object {
    uint32_t vertex_count, triangle_count;
    bool obstacle;
    uint32_t triangles[CHANGING_TRIANGLES_MAX * 3];
    double positions[CHANGING_VERTICES_MAX * 3];
} changing_object;

typedef struct changing_scene {
    uint32_t object_count;
    changing_object objects[CHANGING_OBJECTS_MAX];
} changing_scene;

/* What became of the scene, as cscd_mesh_change_create takes it. */
typedef struct scene_change {
    uint32_t count;
    cscd_object_change list[2 * CHANGING_OBJECTS_MAX];
    cscd_object_desc descs[2 * CHANGING_OBJECTS_MAX];
    uint32_t vertex_origins[2 * CHANGING_OBJECTS_MAX][CHANGING_VERTICES_MAX];
    uint32_t triangle_origins[2 * CHANGING_OBJECTS_MAX][CHANGING_TRIANGLES_MAX];
} scene_change;

/* Three objects or more, closed and open, of one component or several; with_obstacles: some may be obstacles. */
void changing_scene_make(random_stream *random, bool with_obstacles, changing_scene *out);

/* Changes some objects at random; scene becomes what it is afterwards. */
void changing_scene_change(random_stream *random, changing_scene *s, scene_change *out);

/* Tears one object at a random vertex, and names it alone. False: its vertex has one triangle only. */
bool changing_scene_tear(random_stream *random, changing_scene *s, uint32_t object, scene_change *out);

/* One description for each object. */
void changing_scene_describe(const changing_scene *s, cscd_object_desc *descs);

/* All objects joined: the triangles, and the positions as x0 and x1. */
void changing_scene_join(const changing_scene *s, scene *out);

/* ---- their meshes -------------------------------------------------------------------------------------- */

cscd_mesh *changing_scene_mesh(cscd_context *context, const changing_scene *s);

void check_same_mesh(const cscd_mesh *a, const cscd_mesh *b);
