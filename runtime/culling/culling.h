/* Culling by orientation: which triangles are clean at the start of an interval, how they face the detector points of their regions
 * in it, whether that pays, and what contacts take away from it. docs/theory/culling.md. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/mesh/mesh_change.h"
#include "src/mesh/plan.h"

/* ---- rules --------------------------------------------------------------------------------------------- */

/* With none of these rules every pair is tested, and by_orientation alone loses no contact. */
typedef struct culling_rules {
    bool by_orientation; /* pairs of triangles of one region are culled by their orientation */
    bool where_it_pays;  /* ... in the components and intervals in which culling pays (culling_choice.c) */
    bool assumes_clean; /* as published: every triangle counts as clean at the start, and nothing is proven */
} culling_rules;

/* A stage between refit and orientation: it hides pairs of triangles in the BVH that, by its own test, do not touch in
 * the interval that the BVH was refitted to. */
typedef struct pair_hider {
    void *(*create)(cscd_context *context); /* NULL: out of memory */
    void (*destroy)(cscd_context *context, void *state);
    cscd_status (*hide)(void *state, bvh *hierarchy, const double *x0, const double *x1,
                        cscd_counters *counters);
} pair_hider;

/* ---- orientations -------------------------------------------------------------------------------------- */

typedef struct culling {
    cscd_context *context;
    const cscd_mesh *mesh;
    uint32_t region_count;
    uint32_t *triangle_regions;
    double *triangle_weights;        /* as in the plan */
    double (*detector_offsets)[3];   /* as in the plan */
    double (*detector_points)[2][3]; /* per region, at the start and at the end of the interval */
    uint8_t *facing;       /* orientations in the interval; ZERO for triangles that were not clean */
    uint8_t *orientations; /* the same, but also ZERO for triangles that contacts have tainted since */
    uint8_t *earlier;      /* the orientations of the last pass */
    uint64_t plus, minus;  /* how many triangles face PLUS, and MINUS */
} culling;

/* Its arrays, for those who copy them; mesh and region_count say their sizes. */
array_list culling_arrays(culling *c);

/* Copies what the detector needs from a plan. Without a plan, each component is one region, and the mean of its
 * triangles is its detector point. Nothing is culled yet. */
cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out);
void culling_destroy(culling *c);

/* Takes the orientations over from facing, which has been filled in, and counts them. */
void culling_begin(culling *c);

/* Ends a pass, after all pairs of triangles that the orientations keep have been tested. */
void culling_pass_done(culling *c);

/* Keeps all pairs of this triangle from now on. False: they were kept already. */
static inline bool culling_taint(culling *c, uint32_t triangle) {
    bool newly_kept = c->orientations[triangle] != ORIENTATION_ZERO;
    c->orientations[triangle] = ORIENTATION_ZERO;
    return newly_kept;
}

/* Sets all orientations to ZERO, so that nothing is culled. */
void culling_clear(culling *c);

/* Do the orientations keep this pair of triangles, so that it is tested? */
static inline bool culling_keeps(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->orientations[a], c->orientations[b]);
}

/* Did the orientations of the last pass keep this pair? */
static inline bool culling_kept(const culling *c, uint32_t a, uint32_t b) {
    return c->triangle_regions[a] != c->triangle_regions[b] ||
           orientations_may_touch(c->earlier[a], c->earlier[b]);
}

/* ---- what is known of starts --------------------------------------------------------------------------- */

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

/* Knowledge about one component at the start of the interval, and the pause before its next check. */
typedef struct component_start {
    uint32_t unknown, crossing, clean; /* numbers of triangles in these states */
    uint32_t pause, backoff;           /* in intervals: until the next check, and between the last two */

    /* State of culling_choice.c, with costs in its unit. In this interval: */
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
    double unproven;                  /* mean share of triangles that an interval has to prove again */
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
    uint64_t revision;        /* the number of times that positions have been seen */
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
    /* components are culled where it pays (culling_choice.c), and no other pause holds a check back */
    bool adapts;
    double share_worth_it; /* below this share of clean triangles neither culling nor a check pays */
} start_states;

/* Returns whether culling pays with this number of clean triangles of a component. With fewer, the pairs of
 * all other triangles, their neighbours among them, cost more than all pairs do without culling. */
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

/* Marks the triangles that a static check has to compare with one another, and returns their number. These
 * are the triangles not known to be free, in closed manifold components that have unknown triangles and no
 * pause. The pauses of the others become one interval shorter. After a check that leaves too little of a
 * component clean (start_states_pay), the pause before its next check is 1 interval, then 2, 4, 8 and from
 * then on always 16. If the number is 0, unproven is not written. */
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

/* ---- whether culling pays ------------------------------------------------------------------------------ */

/* Decides which components are culled in the interval that begins, where their starts turn out to be clean enough
 * (component_start.chosen). The numbers of triangles are counted. proves: the interval proves its start; otherwise a start that
 * is not known costs nothing, and is not culled. A repetition of the interval decides the same. */
void culling_choice_decide(start_states *s, bool proves);

/* Is a component culled that was not in the last interval? */
bool culling_choice_begins(const start_states *s);

/* The work that an interval has shown. */
typedef struct culling_outcome {
    const bool *culled; /* per component */
    const uint32_t *
        kept; /* per component that is culled: pairs of its triangles that were not left out; NULL: as before */
    const uint32_t *contacts; /* per component: with itself */
    bool forgets;             /* a component that has contacts is not known at the end (mode EARLIEST) */
    uint64_t passes;          /* closing passes */
} culling_outcome;

/* Learns from the interval that ends, before its end becomes the start of the next. */
void culling_choice_learn(start_states *s, const culling_outcome *outcome);

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* The state that the contacts of an interval change. */
typedef struct tainting {
    const cscd_mesh *mesh;
    start_states *starts;
    culling *culling;
    const bool *closes; /* per component: tainted triangles lose their orientations */
    uint32_t *touched;  /* per component: how many contacts it has with itself */
    double *earliest;   /* per component: the least toi of a contact with itself that was noted */
    double within;      /* contacts that are later than the earliest by more than this taint nothing */
} tainting;

/* Returns the component that both features of a contact belong to; UINT32_MAX if they do not belong to one. */
uint32_t tainting_component(const cscd_mesh *mesh, const cscd_contact *contact);

/* Notes the time of a contact of a component with itself, if it is the earliest so far. */
void tainting_note(const cscd_mesh *mesh, const cscd_contact *contact, double *earliest);

/* Taints the stars of both features of a contact of a component with itself, also of one that the caller ignores. Returns how
 * many triangles have lost their orientations, so that pairs of them are newly kept. */
uint32_t tainting_look(const tainting *t, const cscd_contact *contact);

/* The same in two parts, for a contact that is not kept: first the triangles that it taints are marked, and its
 * component as touched once more; later each is tainted, which returns 1 if its pairs are newly kept, else 0. */
void tainting_mark(const cscd_mesh *mesh, const cscd_contact *contact, bool *triangles, uint32_t *touched);
uint32_t tainting_triangle(const tainting *t, uint32_t triangle);

/* ---- another mesh -------------------------------------------------------------------------------------- */

/* The regions of the new mesh: those of untouched components stay in their order; then each other component
 * is one. */
typedef struct region_move {
    uint32_t *to_new;        /* per old region; UINT32_MAX: gone */
    uint32_t *of_components; /* per component of the new mesh its region, UINT32_MAX: it is untouched */
    uint32_t old_count, kept_count; /* kept: regions of untouched components, which come first */
    fresh_region *fresh;            /* all others */
    uint32_t fresh_count;
} region_move;

/* c: of the old mesh. On failure *out holds nothing. */
cscd_status region_move_find(cscd_context *context, const culling *c, const cscd_mesh_change *change,
                             region_move *out);
void region_move_free(cscd_context *context, region_move *m);

/* Nothing is culled yet. mesh: the new one; on failure *out holds nothing. */
cscd_status culling_move(const culling *c, const cscd_mesh *mesh, const cscd_mesh_change *change,
                         const region_move *regions, culling *out);

/* Triangles of untouched components keep their states, and their vertices the positions seen last; all others are
 * UNKNOWN. mesh: the new one; on failure *out holds nothing. */
cscd_status start_states_move(const start_states *s, const cscd_mesh *mesh, const cscd_mesh_change *change,
                              start_states *out);
