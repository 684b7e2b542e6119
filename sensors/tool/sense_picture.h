/* A picture of cells, particles and the vertices that these have visited. */
#pragma once

#include "cscd/sensors.h"
#include "sensors/tool/sense_options.h"
#include "tool/io/io.h"

/* The places where the particles have been so far. */
typedef struct sense_paths {
    uint32_t particle_count;
    uint32_t *places; /* the vertex of each particle after the last interval */
    growable steps;   /* of uint32_t[2]: from a vertex to a vertex */
} sense_paths;

sense_paths sense_paths_none(void);
void sense_paths_free(sense_paths *paths);

/* Adds the steps of an interval. False when out of memory. */
bool sense_paths_follow(sense_paths *paths, const cscd_sensors *sensors);

/* Call it when particles get new numbers; the paths so far stay. */
void sense_paths_break(sense_paths *paths);

typedef struct sense_view {
    const recording *recording;
    const cscd_sensors *sensors;
    const sense_paths *paths;
    const double *positions; /* of the frame */
    int32_t frame;
    const cscd_warnings *warnings; /* of the interval that ends there; NULL: there is none */
} sense_view;

bool sense_picture_draw(const sense_view *view, const sense_options *options, io_error *error);
