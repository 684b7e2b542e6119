/* Calls of the API for tests: with packed positions, with refusals that say why, and with an allocator that counts. */
#pragma once

#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/test.h"

#include <string.h>

/* Positions are packed doubles, one array for all objects, and objects are all of the mesh's context. NULL goes on as NULL. */
cscd_status plan_create_packed(const cscd_mesh *mesh, const double *positions,
                               const cscd_plan_options *options, cscd_plan **out);
cscd_status plan_from_parts_packed(const cscd_mesh *mesh, const double *positions,
                                   const cscd_plan_parts *parts, cscd_plan **out);
cscd_status detector_create_here(const cscd_mesh *mesh, const cscd_plan *plan,
                                 const cscd_detector_options *options, cscd_detector **out);

cscd_status step_packed(cscd_detector *detector, const double *x0, const double *x1, cscd_contacts *out);
/* What meets, as oracles know it: without duplicates. */
cscd_status check_packed(cscd_detector *detector, const double *positions, cscd_intersections *out);
cscd_status find_intersections_packed(cscd_detector *detector, const double *positions,
                                      const cscd_intersection_options *options, cscd_intersections *out);
cscd_status find_near_packed(cscd_detector *detector, const double *positions, double distance,
                             cscd_proximities *out);
cscd_status find_unique_packed(cscd_detector *detector, const double *positions, double distance,
                               cscd_proximities *out);
cscd_status set_rest_packed(cscd_detector *detector, const double *rest);
cscd_status max_step_packed(cscd_detector *detector, const double *x0, const double *x1, double *reached,
                            cscd_free_step *out);
cscd_status displacement_bounds_packed(cscd_detector *detector, const double *x0, double search_radius,
                                       double *bounds, cscd_displacement_bounds *out);
cscd_status truncate_packed(cscd_detector *detector, const double *x0, const double *x1, double search_radius,
                            double *reached, cscd_truncation *out);
cscd_status make_safe_packed(cscd_detector *detector, const double *x0, const double *x1,
                             const cscd_response_options *options, double *reached, cscd_safe_motion *out);

cscd_status line_begin_packed(cscd_line_search *line, const double *x0, const double *x1, double reach);
cscd_status line_positions_packed(cscd_line_search *line, double fraction, double *positions);
cscd_status line_max_step_packed(cscd_line_search *line, double longest, double *reached,
                                 cscd_free_step *out);

/* Pairs of points; out as in the functions of the API. */
cscd_status pairs_step_packed(cscd_context *context, const cscd_pairs *pairs, const double *x0,
                              const double *x1, double min_separation, double tolerance,
                              cscd_pair_contact *out);
cscd_status pairs_near_packed(cscd_context *context, const cscd_pairs *pairs, const double *positions,
                              double distance, cscd_pair_distance *out);

/* ---- refusals ------------------------------------------------------------------------------------------ */

/* The stencil that kind, a, b and the weights of an item stand for. */
static inline cscd_stencil stencil_of_item(const cscd_mesh *mesh, const cscd_proximity *p) {
    double u, v;
    cscd_stencil_parameters(p->kind, p->weights, &u, &v);
    return cscd_mesh_stencil(mesh, p->kind, p->a, p->b, u, v);
}

/* Two items are alike in every bit, but for what the rules of one detector make them keep. */
static inline void expect_alike_but_separation(const cscd_proximity *found, const cscd_proximity *expected) {
    cscd_proximity alike = *found;
    alike.separation = expected->separation;
    assert_memory_equal(&alike, expected, sizeof alike);
}

/* The call in this context was refused as INVALID_ARGUMENT, and its sentence has these words. */
static inline void expect_invalid(const cscd_context *context, cscd_status status, const char *words) {
    const char *detail = cscd_context_detail(context);
    assert_int_equal(status, CSCD_INVALID_ARGUMENT);
    if (strstr(detail, words) == NULL) fail_msg("\"%s\" does not say \"%s\"", detail, words);
}

/* ---- an allocator -------------------------------------------------------------------------------------- */

/* It counts its calls, can be told to fail, and ends the program where a caller has written behind a block. */
typedef struct counting_allocator {
    size_t calls;       /* calls of allocate */
    size_t fail_at;     /* the number of the call that fails; SIZE_MAX: none */
    size_t live, bytes; /* blocks and bytes not yet released */
    size_t peak;        /* the most bytes at one time */
} counting_allocator;

counting_allocator counting_allocator_start(void);
cscd_allocator counting_allocator_interface(counting_allocator *counter);
