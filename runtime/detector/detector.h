/* Internal state of a detector: what lives from one call to the next. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/culling/culling.h"
#include "runtime/detector/edge_rest.h"
#include "runtime/detector/interval_search.h"
#include "runtime/detector/method_table.h"
#include "runtime/detector/result_buffer.h"
#include "runtime/detector/rollback.h"
#include "runtime/detector/search_space.h"
#include "runtime/detector/verlet_list.h"
#include "runtime/intersections/intersections.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "src/core/names.h"
#include "src/mesh/collapsed.h"

struct cscd_detector {
    reference_count references; /* the caller, and lines */
    cscd_context *context;
    cscd_mesh *seen;        /* the mesh, which the detector holds, in its context */
    const cscd_mesh *mesh;  /* seen */
    uint32_t mesh_revision; /* so many times another one has come */
    cscd_detector_options options;
    separation limit; /* of the options, with the default tolerance filled in */
    const method_traits *traits;
    const method_stages *stages;
    culling_rules rules;
    exclusions exclusions; /* its waiting pairs are those of the next member */
    waiting_pairs waiting;

    pair_rules pair_rules;   /* for objects; without sets: there are none */
    uint32_t rules_revision; /* so many times they, or the active vertices, have been set */
    bool *never_culled; /* per component: its triangles are not looked at with each other, or have to stay
                              * farther apart than 0 */
    bool all_never_culled;

    search_space space;
    bvh_rebuild rebuild; /* of space.bvh */
    culling culling;
    start_states starts;
    static_check check;
    verlet_list verlet;
    collapsed_components collapsed; /* at the moment of the last check, or at an end of the last interval */
    bool
        leaves_collapsed; /* the current interval does not look at pairs of two components that are collapsed */
    void *baseline_state; /* of stages->hider or stages->search */
    rollback before;      /* the current call */

    struct {           /* of lists, where the options have one */
        bool *tainted; /* per triangle: by contacts that have left the lanes; NULL: there never was a cap */
        bool any_tainted;
        size_t beside;  /* so much room has a lane beside its share of the cap */
        int taint;      /* a cap_taint */
    } cap;

    /* Per component, in the current interval: */
    bool *culled; /* its pairs are culled */
    bool *closes; /* it is culled, and closing passes find all its contacts, or all that are early enough */
    uint32_t *touched; /* so many contacts it has with itself */
    bool *incomplete;  /* some of its contacts may be missing */
    uint32_t
        *kept; /* so many pairs of its triangles were not culled, where that decides (culling_choice.c) */
    uint32_t *kept_by_lanes; /* the same for each lane in turn */
    double *earliest; /* the least toi of its contacts with itself, where only the earliest are wanted */

    uint32_t intervals; /* that the vertices have gone through */
    bool counts_kept;   /* ... and of the current interval: */
    bool lists_earliest;
    uint64_t passes;            /* its closing passes */
    size_t *contacts_seen;      /* per lane: so many of its contacts have tainted triangles */
    cscd_guarantee *guarantees; /* per component, of the last step */

    result_buffer contacts, proximities;
    result_buffer pairs;             /* intersections */
    result_buffer names;             /* of proximities, while repetitions are found */
    size_t memory_most;              /* what answers may take, where the caller does not say */
    struct surface_answers *answers; /* NULL before the first call that asks for curves, patches and so on */
    part_labels parts;               /* see cscd_detector_set_parts */
    part_labels grouping;            /* see cscd_detector_set_bodies */
    part_summer part_sums;
    cscd_part_pairs part_pairs; /* what these have found last */
    result_buffer contact_parts;
    edge_rest rest;      /* see cscd_detector_set_rest */
    double *unpacked[2]; /* x0 and x1 of views that are not packed doubles; NULL before the first */
    double *reached;     /* the positions that cscd_detector_max_step tries; NULL before its first call */
    cscd_scalar *reached_scalars; /* per object: of what max_step or a line search reaches */
    void *pair_scratch; /* of displacement bounds and truncation, per near pair; NULL before the first */
    size_t pair_scratch_size;
    void *vertex_scratch; /* of truncation, per vertex; NULL before its first call */
    cscd_scalar *scalars; /* of truncation, per object, of x0 and of what is reached; the same */

    cscd_timings timings;
    cscd_counters counters;
};

/* The labels of what belongs together: cscd_detector_set_bodies, or else the parts. */
const part_labels *detector_grouping(const cscd_detector *d);

/* Does nothing say what belongs together in the only object? */
bool detector_bodies_are_components(const cscd_detector *d);

/* Lines hold their detector. */
void detector_hold(cscd_detector *d);
void detector_release(cscd_detector *d);

/* A detector without any parts, which nobody holds, and which holds nothing; NULL: no memory. */
cscd_detector *detector_allocate(cscd_context *context, const cscd_mesh *mesh);

/* The same, which holds the mesh and the context. */
cscd_detector *detector_begin(cscd_context *context, const cscd_mesh *mesh);

/* Gives a detector without any parts the options of another one, and what follows from them. */
void detector_take_options(cscd_detector *d, const cscd_detector *from);

/* The detector is whole: see context_list_object. */
void detector_list(cscd_detector *d);

/* Its own arrays, whose sizes follow from the mesh and the number of lanes. */
array_list detector_arrays(cscd_detector *d);

/* Says which regions the trees are of. */
void detector_choose_regions(cscd_detector *d);

/* Creates the state of the method's own hider or search, if there is one. A failure has its sentence. */
cscd_status detector_create_baseline(cscd_detector *d);

/* Frees the detector and all that it has, without letting go of its mesh and context. */
void detector_free(cscd_detector *d);

/* Begins a call that can be cancelled or fail. Its positions have been checked, and the states are those of its
 * start. */
void detector_begin_call(cscd_detector *d);

/* Ends the call with a status other than CSCD_OK and with the sentence of that status. The detector is put back to
 * what it was before, so that the call can be repeated. IN_CONTACT, however, is an answer: nothing is taken back,
 * and it already has its sentence. */
cscd_status detector_fail_call(cscd_detector *d, cscd_status status);

/* Do the rules say distances? */
static inline bool detector_thick(const cscd_detector *d) {
    return d->pair_rules.greatest > 0.0;
}

/* Are the triangles of a component not looked at with each other, because the rule of its object says so? */
static inline bool detector_masks(const cscd_detector *d, uint32_t component) {
    if (d->pair_rules.sets == NULL || component_is_obstacle(d->mesh, component)) return false;
    return !d->pair_rules.sets[d->pair_rules.component_objects[component]].self;
}

/* A search of its own knows touching only. */
static inline bool detector_searches_alone(const cscd_detector *d) {
    return d->stages->search != NULL && d->limit.distance == 0.0 && d->pair_rules.greatest == 0.0;
}

/* With a minimum separation no pair is culled; nor, in a component, with a distance from itself. */
static inline bool detector_culls(const cscd_detector *d) {
    const bool knows_how = d->stages->search == NULL || detector_searches_alone(d);
    return d->rules.by_orientation && knows_how && d->limit.distance == 0.0 && !d->all_never_culled;
}

/* So does a hider, of pairs within a component. */
static inline bool detector_hides_pairs(const cscd_detector *d) {
    return d->stages->hider != NULL && d->limit.distance == 0.0 && d->pair_rules.greatest_to_itself == 0.0;
}

/* How far the volumes of a step are widened. */
static inline volume_growth detector_growth(const cscd_detector *d) {
    return (volume_growth){d->limit.distance, detector_thick(d) ? d->pair_rules.reaches : NULL, 0.0};
}

/* INVALID_ARGUMENT, if both min_separation and the rules say distances. */
cscd_status detector_check_distances(cscd_detector *d, double min_separation, double greatest_of_rules);

/* Finds the components that are collapsed at x0 or at x1, which may be the same. */
void detector_find_collapsed(cscd_detector *d, const double *x0, const double *x1);

/* Lets traversals of the trees, which have been refitted, leave out pairs of collapsed components, if there are any, until
 * it is told COLLAPSED_FOUND. OUT_OF_MEMORY: they find all pairs. */
cscd_status detector_leave_collapsed(cscd_detector *d, collapsed_trees which);

/* Sets the marks of components whose triangles are not looked at with each other to false. */
void detector_unmark_masked(const cscd_detector *d, bool *triangles);

/* INVALID_ARGUMENT names a vertex that moves, and is not active. */
cscd_status detector_check_still(const cscd_detector *d, const double *x0, const double *x1);

/* Begins a search for what comes nearer than it may, from x0 to x1. */
interval_search detector_search_begin(cscd_detector *d, const double *x0, const double *x1);

/* Returns how far beyond a distance and those of the rules volumes must reach, so that pairs that they part are sure of
 * their distance when the next motion asks; 0 where there is none. */
double detector_floors_beyond(const cscd_detector *d, double distance, const double *x0, const double *x1);

/* Begins a search for what falls below its floor; without a distance, for what touches. */
interval_search detector_search_floors(cscd_detector *d, const double *x0, const double *x1);

/* The number of regions that triangles are oriented by; 0 where they are not oriented. */
static inline uint32_t detector_region_count(const cscd_detector *d) {
    return detector_culls(d) ? d->culling.region_count : 0;
}
