/* What tests of calls for solvers share: brute force about certified steps, lists of proximities with their
 * energies, and truncations. */
#pragma once

#include "cscd/cscd.h"
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

/* ---- proximities and truncations ----------------------------------------------------------------------- */

typedef struct item_list {
    cscd_proximity *items;
    size_t count;
} item_list;

/* A detector that does not cull. */
rig near_rig(const scene *s, uint32_t threads);

/* Lengths at rest from these positions; NULL forgets them. */
void set_rest(const rig *r, const double *rest);

/* Copies the list, which lives until the next call; the caller frees it. */
item_list find_items(const rig *r, const double *x, double distance, cscd_near_form form);

/* The mollifier of Li et al. 2020, eq. 24, of an item's four vertices. */
double mollifier_of(const cscd_proximity *p, const double *x);

/* The sum of mollifier times a barrier without its pole, so that scenes with contacts have an energy, too. counted: each
 * item as often as it counts. */
double sum_energies(const item_list *list, const double *x, double reach, bool counted);

/* ---- truncation ---------------------------------------------------------------------------------------- */

/* A detector of a method, or of none where this is not built in, that keeps features apart. */
rig rig_apart(const scene *s, double apart, cscd_method method, uint32_t threads);

/* Makes two triangles, one above the other, at rest. */
void scene_two_triangles(scene *s, double apart);

/* Truncates the motion of a scene, whose coordinates are numbers of the scalar, in views of it; asserts OK. */
cscd_truncation truncate_scene(const rig *r, const scene *s, double radius, cscd_scalar scalar, double *end);
