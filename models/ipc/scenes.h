/* The scenes of the IPC solver: bodies, their materials, and obstacles. */
#pragma once

#include "models/ipc/contact_energy.h"
#include "models/ipc/springs.h"

/* A closed body at rest, where it begins. An obstacle moves along `travel` and back in travel_seconds,
 * again and again, at an even speed except near its turning points. */
typedef struct ipc_object {
    body shape;
    bool obstacle;
    double travel[3];
} ipc_object;

enum { IPC_OBJECTS_MAX = 8 };

/* Lengths are in the unit of the models, about a metre; times in seconds; z is up. */
typedef struct ipc_scene {
    const char *name, *text;
    uint32_t triangle_count; /* about so many in all objects together, by default */
    uint32_t (*make)(uint32_t triangle_count,
                     ipc_object objects[IPC_OBJECTS_MAX]); /* returns the number of objects */
    ipc_stuff stuff;
    double gravity;
    ipc_barrier_options barrier;
    double min_separation; /* no pair comes nearer */
    double travel_seconds;
    double step_seconds;         /* one time step */
    uint32_t steps, frame_count; /* steps of each frame; frames */
} ipc_scene;

extern const ipc_scene ipc_scenes[];
extern const uint32_t ipc_scene_count;

/* Returns NULL when no scene has this name. */
const ipc_scene *ipc_scene_find(const char *name);

/* Returns the share of its travel that an obstacle has made. */
double ipc_scene_travelled(const ipc_scene *s, double seconds);
