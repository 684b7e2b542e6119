/* What is known of the triangles at the start of an interval: which are clean, and from where. */
#pragma once

#include "src/mesh/mesh.h"

/* Of a triangle at one moment. Free: nothing of its component meets it but its neighbours in shared features,
 * and it has an area. Clean: free, and of those free triangles of its component that, as far as is proven,
 * have one winding number on their outer sides (docs/theory/culling.md). A component is embedded when all are clean.
 */
typedef enum triangle_state {
    TRIANGLE_UNKNOWN,
    TRIANGLE_CROSSING,
    TRIANGLE_FREE,
    TRIANGLE_CLEAN
} triangle_state;

/* What is known of one component at the start of the interval at hand, and how long its next check waits. */
typedef struct component_start {
    uint32_t unknown, crossing, clean; /* triangles in these states */
    uint32_t waiting, patience;
} component_start;

/* A run of start_states.queue: free triangles that are connected over edges. */
typedef struct free_patch {
    uint32_t begin, count;
} free_patch;

/* States at the positions seen last: the end of the last interval, or those of a static check. */
typedef struct start_states {
    cscd_context *context;
    const cscd_mesh *mesh;
    double *positions;
    bool known;            /* positions holds something */
    bool vouched;          /* clean is, of some triangles, the caller's word */
    bool *moved;           /* scratch, per component */
    uint8_t *triangles;    /* triangle_state, of each */
    component_start *of;   /* per component; up to date after start_states_count */
    bool counted;          /* they are */
    uint8_t *saved;        /* states as they were when start_states_save was called */
    uint32_t *queue;       /* scratch, per triangle */
    free_patch *largest;   /* scratch, per component */
    double share_worth_it; /* of a component, clean: with less neither culling nor a check pays */
} start_states;

/* Are so many clean triangles of a component enough for culling to pay? Below, the pairs of all others, their
 * neighbours among them, cost more than all pairs do without. */
static inline bool start_states_pay(const start_states *s, uint32_t clean, uint32_t triangle_count) {
    return clean > 0 && (double)clean >= s->share_worth_it * (double)triangle_count;
}

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out);
void start_states_destroy(start_states *s);

/* Is x, bit for bit, where the vertices were seen last? */
bool start_states_hold(start_states *s, const double *x);

/* An interval begins at x, which is elsewhere: triangles of components whose vertices are not where they were
 * seen last become UNKNOWN. */
void start_states_begin(start_states *s, const double *x);

/* Marks the triangles that a static check has to compare with one another, and returns how many: those not
 * known to be free, of closed manifold components that hold unknown ones and wait no longer; those that wait
 * do so for one interval less. After a check that leaves too little of a component clean (start_states_pay),
 * its next one waits 1 interval, then 2, 4, 8 and 16. */
uint32_t start_states_suspect(start_states *s, bool *suspects);

/* The suspects were compared with one another: crossing says which meet another one, or have no area. */
void start_states_checked(start_states *s, const bool *suspects, const bool *crossing);

/* The caller says that all components are embedded; what a check of these positions found stands. */
void start_states_vouch(start_states *s);

/* Fills in the numbers of triangles per component. */
void start_states_count(start_states *s);

/* A feature of the triangle's closure takes part in a contact with its component. */
static inline void start_states_taint(start_states *s, uint32_t triangle) {
    s->triangles[triangle] = TRIANGLE_UNKNOWN;
    s->counted = false;
}

/* The interval ends at x, and all triangles in contact were tainted, but for components that are lost: what
 * becomes of those is UNKNOWN. All others that were free or clean still are. */
void start_states_end(start_states *s, const double *x, const bool *lost);

/* For an interval whose end may not be where the vertices go: before its contacts are looked at, and, if they
 * do not go there, afterwards; then what the contacts have tainted is as before. */
void start_states_save(start_states *s);
void start_states_restore(start_states *s);

/* Nothing is known of the end of the interval. */
void start_states_forget(start_states *s);
