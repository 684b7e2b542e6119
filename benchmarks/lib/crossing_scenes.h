/* Scenes whose surfaces pass through each other, at one moment. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/io.h"

/* figure    legs that pass through each other
 * knot      a closed tube that passes through itself 14 times: much of it is buried
 * spheres   27 balls, an object each, each in its neighbours
 * scan      a bumpy torus with a spike for each 330 vertices, which runs into the surface next to it: many small curves
 * clean     the same without spikes: no curve at all */
typedef enum crossing_kind {
    CROSSING_FIGURE,
    CROSSING_KNOT,
    CROSSING_SPHERES,
    CROSSING_SCAN,
    CROSSING_CLEAN
} crossing_kind;

const char *crossing_kind_name(crossing_kind kind);

enum { CROSSING_OBJECTS_MAX = 27 };

typedef struct crossing_scene {
    const char *name;
    uint32_t object_count;
    body objects[CROSSING_OBJECTS_MAX]; /* in the same coordinates */
} crossing_scene;

/* Makes a scene of about this number of triangles. */
bool crossing_scene_make(crossing_kind kind, uint32_t triangle_count, crossing_scene *out, io_error *error);
void crossing_scene_free(crossing_scene *s);
