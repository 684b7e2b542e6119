/* The scenes of the IPC solver: which bodies, of what, between which obstacles. */
#pragma once

#include "models/ipc/contact_energy.h"
#include "models/ipc/springs.h"

/* Closed bodies where they begin, at rest. An obstacle moves along `travel` and back in travel_seconds,
 * evenly but for its turning points, again and again. */
typedef struct ipc_object {
    body shape;
    bool obstacle;
    double travel[3];
} ipc_object;

enum { IPC_OBJECTS_MAX = 8 };

/* Lengths in the models' unit, about a metre; seconds; z is up. */
typedef struct ipc_scene {
    const char *name, *text;
    uint32_t triangle_count; /* about; of all objects together, by default */
    uint32_t (*make)(uint32_t triangle_count, ipc_object objects[IPC_OBJECTS_MAX]); /* returns how many */
    ipc_stuff stuff;
    double gravity;
    ipc_barrier_options barrier;
    double min_separation; /* no pair comes nearer */
    double travel_seconds;
    double step_seconds;         /* one time step */
    uint32_t steps, frame_count; /* steps: per frame */
} ipc_scene;

extern const ipc_scene ipc_scenes[];
extern const uint32_t ipc_scene_count;

/* NULL: there is none of this name. */
const ipc_scene *ipc_scene_find(const char *name);

/* The share of its travel that an obstacle has made. */
double ipc_scene_travelled(const ipc_scene *s, double seconds);
