/* Two panels at equal positions that are sewn together all over, and a detector for them. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/rig.h"

enum { SIDE = 5, PANEL = SIDE * SIDE, VERTICES = 2 * PANEL, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

/* The vertices i and PANEL + i are sewn together. */
typedef struct equal_panels {
    counting_allocator counter;
    rig rig;
    cscd_context *context; /* these three are of the rig */
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_line_search *line;
    uint32_t seams[PANEL][2];
    double x0[VERTICES * 3], x1[VERTICES * 3], reached[VERTICES * 3];
    size_t touching; /* pairs of features, without the seams */
} equal_panels;

/* Any failure fails the test. */
void panels_begin(equal_panels *p, double min_separation, uint32_t threads);
void panels_end(equal_panels *p);

/* Takes all seams away. */
void panels_open(const equal_panels *p);

/* Writes positions in which the first panel lies higher than the second one. */
void panels_part(const equal_panels *p, double gap, double *x);
