/* Detectors whose scenes tear, are refined, come and go, with all that they have been told; and the pairs that wait
 * after a tear. */
#pragma once

#include "src/mesh/mesh.h"
#include "tests/support/changing_mesh.h"

/* Which pairs wait after a mesh has torn, told by brute force over all pairs of features. */
void torn_model_begin(void);

/* made: a change that the detector has followed. labels: of the seams of each old vertex, UINT32_MAX: none. */
void torn_model_change(const cscd_mesh_change *made, const uint32_t *labels);

/* What a detector that leaves out nothing that waits reports of a step at rest, and of a check, where a motion starts. */
void torn_model_settle(const cscd_contacts *at_rest, const cscd_intersections *crossing);

bool torn_model_waits(cscd_contact_kind kind, uint32_t a, uint32_t b);

/* How many pairs of features wait. */
size_t torn_model_count(void);

/* ---- scenes and their detectors ------------------------------------------------------------------------ */

enum { MOVING_VERTICES = SCENE_VERTICES_MAX };

/* A scene on its way through changes, with what its detector has been told, in the numbering of now. */
typedef struct moving_scene {
    random_stream random;
    cscd_context *context;
    changing_scene shape;
    cscd_mesh_change *last; /* keeps the mesh; NULL: first does */
    cscd_mesh *first;
    cscd_detector *detector;
    cscd_detector_options options;
    bool rules, seams, ignored;
    bool earliest; /* the mode of the detector */
    cscd_object_rule object_rules[CHANGING_OBJECTS_MAX];
    uint32_t labels[MOVING_VERTICES]; /* of a seam, UINT32_MAX: of none */
    uint32_t (*ignored_pairs)[2];
    size_t ignored_count;
    double x0[MOVING_VERTICES * 3], x1[MOVING_VERTICES * 3];
} moving_scene;

/* The scene, its objects joined with their positions of now as x0 and x1, and its last change. */
extern moving_scene moving;
extern scene moving_joined;
extern scene_change moving_change;

/* Begins with random objects and options; plain: no obstacles, no options but the method. Any failure fails the test. */
void moving_begin_scene(cscd_context *context, uint64_t seed, bool plain);
void moving_end_scene(void);

const cscd_mesh *moving_mesh_now(void);

/* A detector that begins with all that was said, in the numbering of now. plan: NULL for none. */
cscd_detector *moving_new_detector(const cscd_mesh *mesh, const cscd_plan *plan);

/* Changes the scene at random; the detector moves over. */
void moving_change_scene(void);

/* Takes over what the change says of all that was told; the detector has moved over. */
void moving_take_change(cscd_mesh_change *made);

/* A clone goes on in place of the detector. */
void moving_replace_by_clone(void);

/* Makes x0 and x1 of the next step; some objects rest. Then the end becomes the start. */
void moving_move_scene(double speed);
void moving_go_on(void);
