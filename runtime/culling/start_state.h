/* Knowledge about the triangles at the start of an interval: which are clean, and at which positions. */
#pragma once

#include "src/mesh/mesh.h"

/* The state of a triangle at one moment. A free triangle has an area, and no triangle of its component intersects
 * it, except for its neighbours in the features that they share. The clean triangles of a component are free ones
 * that, as far as is proven, have one winding number in common on their outer sides (docs/theory/culling.md). A
 * component is embedded when all its triangles are clean. */
typedef enum triangle_state {
    TRIANGLE_UNKNOWN,
    TRIANGLE_CROSSING,
    TRIANGLE_FREE,
    TRIANGLE_CLEAN
} triangle_state;

/* Knowledge about one component at the start of the interval, and how long its next check waits. */
typedef struct component_start {
    uint32_t unknown, crossing, clean; /* numbers of triangles in these states */
    uint32_t waiting, backoff;         /* in intervals: until the next check, and between the last two */

    /* Of culling_choice.c, with costs in its unit. In this interval: */
    bool moved;          /* its start is not the end of the last one */
    bool chosen;         /* it is culled, if enough of it is clean */
    double proof;        /* what the proof of the start costs, if it is culled */
    double unproven_now; /* `unproven`, with this interval */
    /* From one interval to the next: */
    bool seen, culls, has_been_plain; /* the last interval, its choice, and whether it was ever not to cull */
    uint32_t distrust;                /* what culling would save counts for 2^-distrust */
    double regret;                    /* what the other way would have saved */
    double stay;                      /* what culling has saved since it was chosen */
    double kept;                      /* pairs that it keeps, for each triangle */
    double unproven;                  /* mean share of triangles that an interval has to prove anew */
    double touched;                   /* about that share of triangles was tainted in the last interval */
} component_start;

/* A run of start_states.queue that holds free triangles connected over edges. */
typedef struct free_patch {
    uint32_t begin, count;
} free_patch;

/* States at the positions seen last: the end of the last interval, or those of a static check. */
typedef struct start_states {
    cscd_context *context;
    const cscd_mesh *mesh;
    double *positions;
    uint64_t revision;        /* so many times positions have been seen */
    bool known;               /* positions have been seen */
    bool partly;              /* ... but not those of all vertices; the others are no numbers */
    bool vouched;             /* some triangles are clean only because the caller says so */
    uint8_t *triangles;       /* the triangle_state of each */
    component_start *of;      /* per component; its numbers of triangles are valid if counted is set */
    const bool *never_culled; /* per component: it is not proven, since it is not culled either; NULL: none */
    bool counted;             /* start_states_count was called after the last change of states */
    uint8_t *saved;           /* the states when start_states_save was called */
    bool *clean;              /* per triangle: the outcome of start_states_clean */
    uint32_t *queue;          /* scratch, per triangle */
    free_patch *largest;      /* scratch, per component */
    bool *component_scratch;
    uint32_t *counts; /* scratch, per component */
    bool
        adapts; /* components are culled where it pays (culling_choice.h), and checks wait for nothing else */
    double share_worth_it; /* below this share of clean triangles neither culling nor a check pays */
} start_states;

/* Do so many clean triangles of a component suffice for culling to pay? With fewer, the pairs of all other triangles,
 * their neighbours among them, cost more than all pairs do without culling. */
static inline bool start_states_pay(const start_states *s, uint32_t clean, uint32_t triangle_count) {
    return clean > 0 && (double)clean >= s->share_worth_it * (double)triangle_count;
}

/* Nothing is known, and nothing has been seen. */
void component_start_begin(component_start *start);

/* Its arrays, for those who copy them. */
array_list start_states_arrays(start_states *s);

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out);
void start_states_destroy(start_states *s);

/* Are the positions x, bit for bit, those that were seen last? */
bool start_states_hold(start_states *s, const double *x);

/* Begins an interval at positions x that differ from those seen last. All triangles of a component become UNKNOWN if
 * one of its vertices has moved. */
void start_states_begin(start_states *s, const double *x);

/* Marks the triangles that a static check has to compare with one another, and returns their number. These are the
 * triangles not known to be free, in closed manifold components that have unknown triangles and need not wait.
 * Components that wait do so for one interval less from now on. After a check that leaves too little of a component
 * clean (start_states_pay), its next check waits for 1 interval, then for 2, 4, 8 and from then on always 16. If the
 * number is 0, unproven is not written. */
uint32_t start_states_mark_unproven(start_states *s, const bool *collapsed, bool *unproven);

/* Takes over the outcome of a static check of the unproven triangles; crossing marks those that intersect another
 * one of them or have no area. */
void start_states_checked(start_states *s, const bool *unproven, const bool *crossing);

/* Makes all triangles clean, because the caller vouches that all components are embedded, except in components that
 * a check of these positions found not to be embedded. */
void start_states_vouch(start_states *s);

/* Fills in the numbers of triangles per component. */
void start_states_count(start_states *s);

/* Returns which triangles are clean; the array is valid until the next call. */
const bool *start_states_clean(const start_states *s);

/* Records that a feature of the triangle is in contact with the triangle's own component. */
static inline void start_states_taint(start_states *s, uint32_t triangle) {
    s->triangles[triangle] = TRIANGLE_UNKNOWN;
    s->counted = false;
}

/* Ends the interval at x, after all triangles in contact were tainted. Triangles that were free or clean and have
 * not been tainted stay so, except in components whose contacts are incomplete, where all triangles become UNKNOWN. */
void start_states_end(start_states *s, const double *x, const bool *incomplete);

/* For an interval whose end the vertices may not reach: save before its contacts taint triangles, and restore if the
 * vertices do not go there. Restoring takes back what the contacts have tainted. */
void start_states_save(start_states *s);
void start_states_restore(start_states *s);

/* Makes the triangles of one component UNKNOWN. */
void start_states_forget_component(start_states *s, uint32_t component);

/* Makes all triangles UNKNOWN, because nothing is known of the end of the interval. */
void start_states_forget(start_states *s);
