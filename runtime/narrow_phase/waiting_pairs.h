/* Pairs that a change has uncovered while they touched: they are left out until they have once been apart. */
#pragma once

#include "runtime/narrow_phase/exclusions.h"
#include "runtime/narrow_phase/pair_rules.h"

/* What was left out before a change: by seams and ignored pairs, or among objects. */
typedef struct former_exclusions {
    struct former_exclusions *next;
    exclusions exclusions;
    object_set
        *sets; /* one for each object, as it was; without kinds: it was not there. NULL: by the others */
} former_exclusions;

typedef struct waiting_pairs {
    named_pair_set pairs; /* of features, which searches leave out, and of triangles, which the check does */
    named_pair_set
        torn; /* pairs of neighbours that the mesh has parted: they wait if they are not apart at the next
                          * positions */
    former_exclusions *former; /* changes since positions were last seen, the last one first; NULL: none */
    former_exclusions *spare;  /* for the next change; NULL: none */
} waiting_pairs;

void waiting_pairs_free(const cscd_mesh *mesh, waiting_pairs *w);

/* How many pairs of features wait. */
static inline size_t waiting_features(const waiting_pairs *w) {
    return w->pairs.count - w->pairs.triangle_pairs;
}

/* Makes room for one change, so that it cannot fail later. */
cscd_status waiting_pairs_reserve(const cscd_mesh *mesh, waiting_pairs *w);

/* Remembers what has been left out until now, and owns it from then on: the seams and ignored pairs of *before, or
 * the sets of objects. Names are in the numbering of the present mesh: vertices of one name counted as one. Room has
 * been made. What an earlier change leaves out as well is not remembered twice, so changes to and fro take no memory. */
void waiting_pairs_uncover(const cscd_mesh *mesh, waiting_pairs *w, exclusions *before);
void waiting_pairs_uncover_objects(const cscd_mesh *mesh, waiting_pairs *w, object_set *before);

/* Did any of the changes uncover this pair of features, or of triangles that intersect at the positions? */
bool waiting_pairs_uncovered(const cscd_mesh *mesh, const waiting_pairs *w, cscd_contact_kind kind,
                             uint32_t a, uint32_t b, const double *positions);

/* Forgets the changes. */
void waiting_pairs_settled(const cscd_mesh *mesh, waiting_pairs *w);
