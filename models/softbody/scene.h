/* The recordings: which body falls how, onto what. */
#pragma once

#include "models/shapes/catalogue.h"
#include "models/softbody/obstacles.h"
#include "models/softbody/soft_body.h"

/* Lengths in the bodies' unit, times in seconds. */
typedef struct soft_scene {
    const char *name, *text;
    body_kind kind;
    double spacing; /* of the lattice */
    material stuff;
    double axis[3], degrees; /* how the body is turned at the start, */
    double height;           /* how far its lowest point is above the ground, */
    double velocity[3];      /* and how it moves; its centre is above x = y = 0 */
    obstacles around;
    uint32_t frame_count;
    double frame_seconds;
    uint32_t checks, steps; /* per frame: detector steps; and in each of these, small steps */
} soft_scene;

extern const soft_scene soft_scenes[];
extern const uint32_t soft_scene_count;

/* NULL: there is none of this name. */
const soft_scene *soft_scene_find(const char *name);

/* Places the body, which is at rest as catalogue.h says, as the scene begins. */
soft_body soft_scene_begin(const soft_scene *s, const body *shape);
