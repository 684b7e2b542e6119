/* What a detector knows of the start of its next step, and exact winding numbers beside the triangles that it calls clean. */
#pragma once

#include "runtime/detector/detector.h"

static inline triangle_state start_state_of(const cscd_detector *detector, uint32_t triangle) {
    return (triangle_state)detector->known.starts.triangles[triangle];
}

/* How many triangles of a component are in a state. */
static inline uint32_t start_states_in(const cscd_detector *detector, uint32_t component,
                                       triangle_state state) {
    const cscd_mesh *mesh = detector->mesh;
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count += mesh->triangle_components[t] == component && start_state_of(detector, t) == state;
    return count;
}

/* ---- winding numbers ----------------------------------------------------------------------------------- */

/* Counts the winding numbers of components just outside the triangles that are clean at the positions that the detector
 * has seen last, by rays and in exact arithmetic. Fails the test unless all clean triangles of a component have the same
 * one. `where` says in a failure which step it was. Returns how many triangles were compared.
 *
 * The first looks at one triangle of each patch that clean triangles form over edges, which is enough where these are
 * free, and quick; the second looks at each triangle, and with `outer` their number must be 0. */
uint32_t expect_one_number(const cscd_detector *detector, const char *where);
uint32_t expect_one_number_everywhere(const cscd_detector *detector, bool outer, const char *where);

/* The winding number of a triangle's component just outside the triangle. False: no line tells. */
bool exact_number_outside(const cscd_mesh *mesh, const double *positions, uint32_t triangle, int *number);
