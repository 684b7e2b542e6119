/* The scenes of `objects`: closed objects that touch and part by formula, soft bodies that tumble, and a census of touches. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"
#include "models/shapes/catalogue.h"
#include "models/softbody/softbody.h"
#include "tool/io/io.h"

/* ---- objects that move by formula ---------------------------------------------------------------------- */

enum { SCENE_OBJECTS_MAX = 8 };

/* Time runs from 0 to 1. The middle of an object moves to and fro between place + away, where it begins
 * unless it is late, and place, which it reaches `visits` times. It turns about an axis, and may become
 * longer and thinner, then shorter and thicker, along its own z. */
typedef struct moving_object {
    body_kind kind;
    uint32_t triangle_count; /* 0: the default */
    double scale;
    double place[3], away[3], visits; /* 0: it stays at place + away */
    double late;                      /* time by which its motion starts later */
    double axis[3], degrees, spin;    /* rotation at time 1/2, and over the whole time */
    double stretch;                   /* the share of its length that it gains and loses once; 0: rigid */
} moving_object;

typedef struct object_scene {
    const char *name, *text;
    uint32_t frame_count, object_count;
    moving_object objects[SCENE_OBJECTS_MAX];
} object_scene;

extern const object_scene object_scenes[];
extern const uint32_t object_scene_count;

/* Returns NULL when no scene has this name. */
const object_scene *object_scene_find(const char *name);

/* All objects of a scene in one mesh, object by object. */
typedef struct object_stage {
    const object_scene *scene;
    body rest;   /* each about the origin */
    body placed; /* where they are now, in single precision */
    uint32_t first_vertex[SCENE_OBJECTS_MAX + 1];
} object_stage;

/* Opens a scene at frame 0. When it returns false, there is nothing to close and *error says why. */
bool object_stage_open(const object_scene *scene, object_stage *out, io_error *error);
void object_stage_close(object_stage *s);

/* Moves all objects to a frame below frame_count. */
void object_stage_go(object_stage *s, uint32_t frame);

/* ---- soft bodies that tumble --------------------------------------------------------------------------- */

enum { TUMBLE_BODIES = 8, TUMBLE_FRAMES = 150 };

extern const char tumble_name[], tumble_text[];

typedef struct tumble {
    body shape;    /* as the bodies begin, in single precision */
    double *frame; /* its vertices now, in single precision */
    obstacles around;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    soft_body soft; /* all bodies in one lattice of separate pieces */
    self_contacts contacts;
    double *start; /* the vertices where the detector's interval starts */
} tumble;

/* Opens the scene at its first frame, with a context that outlives it. When it returns false, there is
 * nothing to close and *error says why. */
bool tumble_open(cscd_context *context, tumble *out, io_error *error);
void tumble_close(tumble *t);

/* Advances by one frame. */
bool tumble_advance(tumble *t, io_error *error);

/* ---- which objects touch each other, and when ---------------------------------------------------------- */

/* Counts so far. Objects are the components of the mesh. */
typedef struct census {
    const cscd_mesh *mesh;
    cscd_detector *detector;
    double *last;       /* the last frame */
    double edge_length; /* the mean in the first frame */
    uint32_t frame_count, object_count;
    uint32_t between_intervals;   /* with contacts between objects */
    uint32_t within_intervals;    /* with contacts within an object */
    uint32_t intersecting_frames; /* with intersections */
    uint64_t contacts;            /* between and within objects */
    double largest_motion;        /* of a vertex from frame to frame, in edge lengths */
    bool *pairs;                  /* object_count^2: those that have touched; on the diagonal, themselves */
    bool touching;                /* whether objects touched each other in the last interval */
} census;

/* Begins without a frame. When the status is not CSCD_OK, there is nothing to free. */
cscd_status census_begin(const cscd_mesh *mesh, census *out);
cscd_status census_add(census *c, const double *frame);
void census_free(census *c);

/* Returns the number of pairs of different objects that have touched. */
uint32_t census_pair_count(const census *c);
