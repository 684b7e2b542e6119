/* Depths of what is looked at with each other. The library leaves out pairs of triangles, but not what lies inside of what:
 * where curves are left out, a patch goes on into the other object, and whether it counts as inside is chance. */
#pragma once

#include "tool/common/ignore_pairs.h"
#include "tool/io/io.h"

typedef struct shown_depths {
    const ignore_pairs *ignored;
    growable items, patches; /* cscd_depth, cscd_patch_depth: what is left */
    cscd_depths list;        /* of these */
    const cscd_depths *all;  /* the library's, until its next call */
} shown_depths;

shown_depths shown_depths_of(const ignore_pairs *ignored); /* of a whole recording; they outlive it */
void shown_depths_free(shown_depths *s);

/* Leaves out what ignored pairs say of a frame: found->depths is this list from now on, until the next call. False when out of
 * memory. */
bool shown_depths_choose(shown_depths *s, cscd_intersection_pairs *found);

/* Gives a pair of parts the greatest depth and bound that are shown, in the frame chosen last; 0: none. */
void shown_depths_of_parts(const shown_depths *s, const cscd_intersection_pairs *found, cscd_part_pair *pair);
