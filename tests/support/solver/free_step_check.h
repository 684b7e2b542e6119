/* Checks by brute force everything that a step certified free of contact promises. */
#pragma once

#include "tests/support/rig.h"

/* A call of cscd_detector_max_step or cscd_line_max_step, and its results. Before the call,
 * free_step_prepare fills the step and the end. */
typedef struct free_step_call {
    const double *x0, *x1;
    double longest, step_factor;
    cscd_status status;
    cscd_free_step step;
    double end[SCENE_VERTICES_MAX * 3];
} free_step_call;

void free_step_prepare(const double *x0, const double *x1, double longest, double step_factor,
                       free_step_call *call);

/* Makes a detector of method BRUTE with the lengths in the options of the detector that is to be checked. */
rig free_step_reference(const scene *s, const cscd_detector_options *options);

/* Computes x0 + length (x1 - x0), rounded as documented. */
void free_step_positions(const rig *r, const double *x0, const double *x1, double length, double *out);

/* Asserts everything that the call promises; `called` is the context in which it was made. Returns false
 * when the status is IN_CONTACT. */
bool free_step_check(const rig *reference, const cscd_context *called, const free_step_call *call);

/* Returns whether the mesh is free of intersections and of triangles without area. */
bool free_step_embedded(const rig *reference, const double *positions);
