/* The scenes of the recordings: a body, how it falls, and its obstacles. */
#pragma once

#include "models/shapes/catalogue.h"
#include "models/softbody/obstacles.h"
#include "models/softbody/soft_body.h"

/* Lengths are in the unit of the bodies, times in seconds. */
typedef struct soft_scene {
    const char *name, *text;
    body_kind kind;
    double spacing; /* of the lattice */
    material stuff;
    double axis[3], degrees; /* how the body is turned at the start, */
    double height;           /* height of its lowest point above the ground, and */
    double velocity[3];      /* how it moves; its centre is above x = y = 0 */
    obstacles around;
    uint32_t frame_count;
    double frame_seconds;
    uint32_t checks, steps; /* detector steps in a frame; small steps in each of these */
} soft_scene;

extern const soft_scene soft_scenes[];
extern const uint32_t soft_scene_count;

/* Returns NULL when no scene has this name. */
const soft_scene *soft_scene_find(const char *name);

/* Places a body, which is at rest as in catalogue.h, at the start of the scene. */
soft_body soft_scene_begin(const soft_scene *s, const body *shape);
