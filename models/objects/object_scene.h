/* Scenes of closed objects that touch and part by formula, and their objects. */
#pragma once

#include "models/shapes/catalogue.h"

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
