/* Answers about intersecting surfaces besides their pairs of triangles: curves, patches, overlaps, depths. */
#pragma once

#include "runtime/depths/depths.h"
#include "runtime/detector/config.h"
#include "runtime/intersections/intersections.h"

/* The memory of a detector for these answers, and those of its last call. Made at the first call that asks. */
typedef struct surface_answers {
    size_t kept; /* bytes, from one call to the next */
    left_out_pairs left_out;
    placed_names names;
    curve_joiner joiner;
    orientation_finder *orientations;
    patch_finder patch_finder;
    overlap_finder *overlap_finder;
    cut_off_finder *cut_off_finder;
    depth_finder *depth_finder;
    same_solids same_solids;
    measure_finder *measure_finder;
    cscd_curves curves;
    cscd_patches patches;
    cscd_overlaps overlaps;
    cscd_cut_offs cut_offs;
    cscd_depths depths;
    cscd_measures measures;
} surface_answers;

/* The measure that a call asks for, besides what its options do. */
typedef enum surface_measure { MEASURE_NOTHING, MEASURE_VOLUMES, MEASURE_LENGTHS } surface_measure;

/* The surfaces that answers are about. */
typedef struct surface_scene {
    const detector_config *config;
    search_space *space; /* whose trees are at the positions */
    const double *positions;
    const bool *collapsed; /* per component; NULL: none is */
    surface_measure measure;
} surface_scene;

void surface_answers_free(cscd_context *context, surface_answers *a);

/* Does the caller want any of them? */
bool surface_answers_wanted(const cscd_intersection_options *options);

/* The list, now empty, of the pairs that the call leaves out, which is to be filled where overlaps are wanted. To be called
 * before the other function. Makes the answers if there are none. NULL: no memory. */
left_out_pairs *surface_answers_begin(const search_space *space, surface_answers **answers);

/* Adds to *found, which has all pairs, what the options ask for and the budget has room for. The trees are at the positions.
 * OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status surface_answers_find(surface_answers *a, const surface_scene *scene,
                                 const cscd_intersection_options *options, memory_budget *budget,
                                 cscd_intersections *found);

/* Something did not fit the budget: says so in *found, and goes on. */
void surface_answers_leave_out(memory_budget *budget, cscd_left_out what, cscd_intersections *found);

/* Leaves out all that the options ask for, since the pairs themselves do not fit. */
void surface_answers_leave_out_list(const cscd_intersection_options *options, cscd_intersections *found);

/* Finds a measure of the surfaces in a call of its own. Of the options only part_bodies, orientation and max_memory are
 * used. *out belongs to the detector. LIST_TOO_LONG: something does not fit the memory. */
cscd_status surface_measure_ask(cscd_detector *d, const cscd_view *positions,
                                const cscd_intersection_options *options, surface_measure measure,
                                cscd_measures *out);

/* Gives back what is kept from one call to the next, if that exceeds a number of bytes. */
void surface_answers_shrink(cscd_context *context, surface_answers **answers, size_t most);
