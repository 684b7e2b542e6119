/* A detector: what it was told, what it knows of the start, the interval at hand, and what it has found. The door of this
 * room, with the stages of a step and what the calls of the API share. */
#pragma once

#include "runtime/detector/config.h"
#include "runtime/detector/contact_list.h"
#include "runtime/detector/interval.h"
#include "runtime/detector/near_list.h"
#include "runtime/detector/search.h"
#include "runtime/detector/start_knowledge.h"
#include "runtime/detector/waiting.h"

/* The results of calls, and memory for them. */
typedef struct detector_results {
    cscd_guarantee *guarantees; /* per component, of the last step */
    cscd_timings timings;
    cscd_counters counters;
    result_buffer contacts, proximities, intersections, contact_parts, candidates, lenses, lens_points;
    near_list near;
    result_buffer repetitions;       /* of near pairs, while they are found */
    struct surface_answers *answers; /* NULL before the first call that asks for curves, patches and so on */
    part_summer part_sums;
    cscd_part_pairs part_pairs; /* what these have found last */
} detector_results;

/* Memory of cscd_detector_make_safe. */
typedef struct response_memory {
    void *vertices;   /* per vertex and object */
    active_set focus; /* see detector_focus */
    void *stops, *held, *divided;
    size_t stops_size, held_size, divided_size; /* in bytes */
} response_memory;

struct cscd_detector {
    reference_count references; /* the caller, and line searches */
    cscd_context *context;
    cscd_mesh *seen;        /* the mesh, which the detector holds, in its context */
    const cscd_mesh *mesh;  /* seen */
    uint32_t mesh_revision; /* grows whenever another one comes */

    detector_config config;
    start_knowledge known;
    detector_interval interval;
    detector_results results;

    search_space space;
    bvh_rebuild rebuild; /* of space.bvh */

    /* Memory that calls use; NULL before the first that needs it. */
    double *unpacked[2];          /* x0 and x1 of views that are not packed doubles */
    double *reached;              /* the positions that a call tries */
    cscd_scalar *reached_scalars; /* per object: of what a certified step reaches */
    void *pair_scratch;           /* of displacement bounds and truncation, per near pair */
    size_t pair_scratch_size;
    void *vertex_scratch; /* of truncation, per vertex */
    cscd_scalar *scalars; /* of truncation, per object, of x0 and of what is reached */
    response_memory response;
};

/* ---- life ---------------------------------------------------------------------------------------------- */

/* Line searches hold their detector. */
void detector_hold(cscd_detector *d);
void detector_release(cscd_detector *d);

/* Makes a detector without any parts, which nobody holds, and which holds nothing; NULL: no memory. */
cscd_detector *detector_allocate(cscd_context *context, const cscd_mesh *mesh);

/* Makes the same, which holds the mesh and the context. */
cscd_detector *detector_begin(cscd_context *context, const cscd_mesh *mesh);

/* Gives a detector without any parts the options of another one, and what follows from them. */
void detector_take_options(cscd_detector *d, const cscd_detector *from);

/* Lets debug builds check the detector, which is whole, at every call. */
void detector_list(cscd_detector *d);

/* Its own arrays, whose sizes follow from the mesh and the number of workers. */
array_list detector_arrays(cscd_detector *d);

/* Says which regions the trees are of. */
void detector_choose_regions(cscd_detector *d);

/* Creates the state of the method's own hider or search, if there is one. A failure has its sentence. */
cscd_status detector_create_baseline(cscd_detector *d);

/* Frees the detector and all that it has, without letting go of its mesh and context. */
void detector_free(cscd_detector *d);

/* Returns what is wrong with a detector between two calls, for debug builds and tests; NULL: nothing. */
const char *detector_validate(const cscd_detector *d);

/* ---- settings ------------------------------------------------------------------------------------------ */

/* Replaces the rules of a detector that has made no call yet. */
cscd_status detector_set_rules(cscd_detector *d, const given_rules *given);

/* Gives the detector rules, which become its own, in place of those before. */
void detector_take_rules(cscd_detector *d, const pair_rules *rules);

/* Sets longest_list from now on. */
cscd_status detector_set_longest_list(cscd_detector *d, size_t longest);

/* Looks only for pairs of which one has such a vertex, until detector_unfocus. All vertices are active. */
cscd_status detector_focus(cscd_detector *d, const uint32_t *vertices, size_t count);
void detector_unfocus(cscd_detector *d);

/* Returns INVALID_ARGUMENT, and names a vertex that moves and is not active. */
cscd_status detector_check_still(const cscd_detector *d, const double *x0, const double *x1);

/* ---- a call -------------------------------------------------------------------------------------------- */

/* Begins a call that can be cancelled or fail. Its positions have been checked, and the states are those of its
 * start. */
void detector_begin_call(cscd_detector *d);

/* Ends the call with a status other than CSCD_OK and with the sentence of that status. The detector is put back to
 * what it was before, so that the call can be repeated. IN_CONTACT, however, is an answer: nothing is taken back,
 * and it already has its sentence. */
cscd_status detector_fail_call(cscd_detector *d, cscd_status status);

/* Finds the components that are collapsed at x0 or at x1, which may be the same. */
void detector_find_collapsed(cscd_detector *d, const double *x0, const double *x1);

/* Lets traversals of the trees, which have been refitted, leave out pairs of collapsed components, if there are any, until
 * it is told COLLAPSED_FOUND. OUT_OF_MEMORY: they find all pairs. */
cscd_status detector_leave_collapsed(cscd_detector *d, collapsed_trees which);

/* Returns how far beyond a distance and those of the rules volumes must reach, so that pairs that they part are sure of
 * their distance when the next motion asks; 0 where there is none. */
double detector_floors_beyond(const cscd_detector *d, double distance, const double *x0, const double *x1);

/* Begins a search for what falls below its floor; without a distance, for what touches. */
interval_search detector_search_floors(cscd_detector *d, const double *x0, const double *x1);

/* The means to look for waiting pairs. */
static inline waiting_place detector_waiting_place(cscd_detector *d) {
    return (waiting_place){&d->config, &d->space, &d->rebuild, &d->known.check};
}

/* The number of regions that triangles are oriented by; 0 where they are not oriented. */
static inline uint32_t detector_region_count(const cscd_detector *d) {
    return config_culls(&d->config) ? d->interval.culling.region_count : 0;
}

/* These do what the calls of the API do, within a call. */
cscd_status detector_find_intersections(cscd_detector *d, const cscd_view *positions,
                                        const cscd_intersection_options *options, cscd_intersections *out);
cscd_status detector_curve_lengths(cscd_detector *d, const cscd_view *positions,
                                   const cscd_intersection_options *options, cscd_measures *out);

/* Finds all pairs, curves and patches; of the options, which may be NULL, part_bodies, orientation and max_memory count. */
cscd_status detector_find_patches(cscd_detector *d, const cscd_view *positions,
                                  const cscd_intersection_options *options, cscd_intersections *out);

/* ---- one interval -------------------------------------------------------------------------------------- */

/* check_ms and total_ms are left at 0. */
typedef struct step_outcome {
    cscd_contacts contacts;
    cscd_timings timings;
    cscd_counters counters;
} step_outcome;

/* Checks both arrays, and forgets what is known of triangles at other positions than x0. */
cscd_status step_check_positions(cscd_detector *d, const double *x0, const double *x1);

/* The rule by which pairs are contacts. */
typedef enum step_rule {
    STEP_WITHIN,      /* they come within their distance */
    STEP_BELOW_FLOOR, /* they fall below their floor */
    STEP_NEARLY       /* the same, and some that come within twice their distance: quicker */
} step_rule;

/* Finds the contacts between x0 and x1, both checked, that the mode promises, and fills in the guarantees. Then the
 * caller either takes the step or, only with a rule other than STEP_WITHIN, withdraws it. */
cscd_status step_find(cscd_detector *d, const double *x0, const double *x1, cscd_mode mode, step_rule rule,
                      step_outcome *out);

/* The vertices have gone to the end of the interval found last: carries the states of its triangles over to there,
 * except in components whose contacts may be incomplete. */
void step_take(cscd_detector *d, const double *end);

/* The vertices have not gone there: the states are those at the interval's start again. */
void step_withdraw(cscd_detector *d);
