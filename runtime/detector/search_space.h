/* The data that the searches of a detector work with and keep: trees, lanes, and which triangle pair tests which
 * features. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "runtime/loose/loose.h"
#include "runtime/narrow_phase/narrow_phase.h"

typedef struct search_space {
    cscd_context *context;
    const cscd_mesh *mesh;
    bvh bvh; /* refitted to the current interval or moment before a search begins */
    traversal traversal;
    const pair_rules *rules; /* NULL: all objects are looked at */
    active_set active;       /* the trees have marks of it */
    contact_lane *lanes;     /* one per lane of the traversal */
    size_t longest;          /* list of the present search; 0: there is no cap */
    size_t moves_from; /* so many contacts are moved out of the lanes, which give back their memory; shorter
                              * lists are copied, so that later steps take none from the allocator */
    size_t counted;    /* contacts of the list that found no room in the lanes; then no list is given out */
    representatives representatives;
    orphan_pairs
        orphans; /* made by the first search that skips adjacent triangles, unless there are too many */
    bool orphans_known, orphans_usable;
    loose_elements loose;
    bool *skipped; /* per component: pairs of its adjacent triangles are not traversed */
} search_space;

/* The trees are not built yet. On failure *out holds nothing. */
cscd_status search_space_create(const cscd_mesh *mesh, search_space *out);
void search_space_destroy(search_space *s);

/* OUT_OF_MEMORY: a lane had no room for a contact. */
cscd_status search_space_status(const search_space *s);

/* Does any lane have a contact? */
bool search_space_found_any(const search_space *s);
