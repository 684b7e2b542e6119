/* Bodies of any size that deform from frame to frame by about one edge length, with and without contact. */
#pragma once

#include "models/shapes/catalogue.h"
#include "tool/io/mesh_file.h"

typedef enum deformation {
    DEFORM_WAVE, /* bends, waves and stretches; never touches itself: see deforming_body.c */
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
