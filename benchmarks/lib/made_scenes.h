/* Scenes of any size that are made here: bodies that deform from frame to frame by about one edge length, with and
 * without contact; and surfaces that pass through each other, at one moment. */
#pragma once

#include "models/shapes/body.h"
#include "models/shapes/catalogue.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

typedef enum deformation {
    DEFORM_WAVE, /* bends, waves and stretches; never touches itself: see made_scenes.c */
    DEFORM_LEGS, /* of a figure: its legs pass through each other */
    DEFORM_PAIR  /* two given frames, the same interval every time */
} deformation;

typedef struct deforming_body {
    uint32_t vertex_count, triangle_count;
    uint32_t *triangles;
    double *rest, *last; /* vertex_count * 3 each; last: with DEFORM_PAIR only */
    deformation motion;
    double low[3], high[3]; /* at rest */
    double edge;            /* mean length of an edge */
    double length;          /* greatest extent, rounded down to a power of two */
} deforming_body;

/* Makes a body. shuffled: vertices and triangles stand in random order, else in the order of the model, in
 * which neighbours are close. */
bool deforming_body_make(body_kind kind, uint32_t triangle_count, deformation motion, bool shuffled,
                         deforming_body *out, io_error *error);

/* Reads two successive frames of the same triangles: folder/name<first>.ply and the one after it. */
bool deforming_body_read(const char *folder, const char *name, int first, deforming_body *out,
                         io_error *error);
void deforming_body_free(deforming_body *b);

/* Computes both ends of interval i, which moves everything by `shift` along x, from i * shift to (i + 1) *
 * shift. The start is bit for bit the end of the interval before, except with DEFORM_PAIR. Positions are
 * multiples of 2^-30, so shifts by small multiples of `length` are exact. */
void deforming_body_interval(const deforming_body *b, uint32_t i, double shift, double *start, double *end);

/* Returns the root mean square distance that vertices move in interval 1, in edge lengths. */
double deforming_body_speed(const deforming_body *b);

/* ---- surfaces that cross ------------------------------------------------------------------------------- */

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
