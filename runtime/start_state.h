/* Is the start of an interval embedded? What is known of each component, and from where. */
#ifndef CSCD_START_STATE_H
#define CSCD_START_STATE_H

#include "src/mesh.h"

typedef enum start_state {
    START_UNKNOWN,  /* nothing is known */
    START_EMBEDDED, /* no two of its features without a common vertex touch: proven */
    START_CROSSING  /* some do */
} start_state;

/* What is known of one component, and how long the next check of it waits. */
typedef struct component_start {
    start_state state;
    uint32_t waiting, patience;
} component_start;

/* States at the positions seen last: the end of the last interval, or those of a static check. */
typedef struct start_states {
    cscd_context *context;
    const cscd_mesh *mesh;
    double *positions;
    bool known;          /* positions holds something */
    bool *moved;         /* scratch, per component */
    component_start *of; /* per component */
} start_states;

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out);
void start_states_destroy(start_states *s);

/* An interval begins at x: components whose vertices are not where they were seen last become UNKNOWN. */
void start_states_begin(start_states *s, const double *x);

/* Of a component that could be culled, is UNKNOWN, and waits no longer: does any want a static check? Those
 * that wait do so for one interval less. After a check that finds a component crossing, the next one waits 1
 * interval, then 2, 4, 8 and 16: a check costs about half of what culling saves. */
bool start_states_want_check(start_states *s);

/* A static check at x: crossing per component. */
void start_states_checked(start_states *s, const double *x, const bool *crossing);

/* The caller says that all components are embedded; what a check of these positions found stands. */
void start_states_vouch(start_states *s);

/* The interval ends at x; touched: components with a contact with themselves, NULL: that is not known. What
 * was embedded and did not touch itself still is; all else is UNKNOWN. */
void start_states_end(start_states *s, const double *x, const bool *touched);

#endif
