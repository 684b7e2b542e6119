/* Checks of what searches with volumes find: nothing that is in contact is missing, and k-DOPs nest. */
#pragma once

#include "runtime/baselines/volume_tree.h"
#include "runtime/culling/culling.h"

/* Pairs of triangles that have to be found: of the stars of two features in contact, those that share no vertex and that
 * culling keeps. The smaller number in the upper half; ascending. */
typedef struct wanted_pairs {
    uint64_t *keys;
    bool *marks;
    size_t count, capacity;
} wanted_pairs;

/* Replaces what was there. False: no memory. */
bool wanted_pairs_collect(wanted_pairs *p, const cscd_mesh *mesh, const culling *by,
                          const cscd_contacts *contacts);
void wanted_pairs_free(wanted_pairs *p);

/* Were all of them found? */
bool wanted_pairs_found(wanted_pairs *p, const volume_search *s);

/* Are all pairs of one search those of another one, in the same order, and did it test no more volumes? */
bool volume_search_within(const volume_search *s, const volume_search *of);
