/* Pairs that are left out: by the caller, with a callback, a list, and seams; or until they have once been
 * apart. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/core/context.h"
#include "src/mesh/mesh_change.h"

/* ---- sets of pairs ------------------------------------------------------------------------------------- */

/* A pair of features, or of triangles: a cscd_contact_kind, and a and b as in lists of that kind. */
typedef struct named_pair {
    uint32_t kind, a, b;
    uint32_t marked; /* of use to whoever goes through a set */
} named_pair;

typedef struct named_pair_set {
    named_pair *items; /* sorted by (kind, a, b) */
    size_t count, capacity;
    size_t triangle_pairs; /* the number of pairs of the kind TT */
} named_pair_set;

void named_pair_set_free(cscd_context *context, named_pair_set *set);

/* Appends a pair; the set is sorted later, by named_pair_set_sort. False: no memory. */
bool named_pair_set_add(cscd_context *context, named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                        uint32_t b);

/* Sorts what has been added, and drops repetitions. False: no memory. */
bool named_pair_set_sort(cscd_context *context, named_pair_set *set);

/* Keeps the marked pairs, and takes the marks off. */
void named_pair_set_keep_marked(named_pair_set *set);

/* Returns the pair of the set, or NULL. */
named_pair *named_pair_set_find(const named_pair_set *set, cscd_contact_kind kind, uint32_t a, uint32_t b);

static inline bool named_pair_set_has(const named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                                      uint32_t b) {
    return set->count > 0 && named_pair_set_find(set, kind, a, b) != NULL;
}

/* ---- what the caller leaves out ------------------------------------------------------------------------ */

/* The seams that a detector was given, until it has seen that their vertices belong together. */
typedef struct seam_list {
    uint32_t *vertices; /* two of each pair, in the caller's order; NULL: there is nothing left to check */
    size_t count;
    double reach; /* how far apart the vertices of a pair may be; 0: as far as the edges there are long */
} seam_list;

/* Copies pairs whose vertices exist. INVALID_ARGUMENT names a pair of equal vertices. */
cscd_status seam_list_create(const cscd_mesh *mesh, const uint32_t *pairs, size_t count, double reach,
                             seam_list *out);
void seam_list_free(cscd_context *context, seam_list *s);

/* Checks the first positions that the detector is given: INVALID_ARGUMENT names the first pair whose
 * vertices are farther apart there than the reach. Once all are near, this does nothing: later they may
 * part. */
cscd_status seam_list_check(const cscd_mesh *mesh, seam_list *s, const double *positions);

typedef struct exclusions {
    const cscd_mesh *mesh;
    bool (*ignore)(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);
    void *ignore_user;
    uint64_t *ignored; /* pairs of triangles, the smaller one in the upper half, sorted */
    size_t ignored_count;
    uint32_t *names;               /* per vertex: the smallest one of its seam; NULL: there are no seams */
    seam_list seams;               /* to be checked at the first positions */
    const named_pair_set *waiting; /* left out until they have once been apart; NULL: none */
    bool marked_wait;              /* only the marked ones of these are left out */
} exclusions;

/* Copies what the options say. INVALID_ARGUMENT names what does not fit. */
cscd_status exclusions_create(const cscd_mesh *mesh, const cscd_detector_options *options, exclusions *out);
void exclusions_free(cscd_context *context, exclusions *e);

/* Copy everything but the seams, or but the ignored pairs, and take these from the caller. Seams that are
 * still to be checked stay with *now. */
cscd_status exclusions_with_seams(const exclusions *now, const uint32_t *seams, size_t seam_count,
                                  double seam_reach, exclusions *out);
cscd_status exclusions_with_ignored(const exclusions *now, const uint32_t *ignored, size_t ignored_count,
                                    exclusions *out);

/* May there be a pair that seams and ignored pairs left out before and do not leave out now? */
bool exclusions_uncover(const exclusions *before, const exclusions *now);

/* The seams and ignored pairs alone, which are still those of *e. */
exclusions exclusions_listed(const exclusions *e);

static inline bool exclusions_any(const exclusions *e) {
    return e->ignore != NULL || e->ignored_count > 0 || e->names != NULL ||
           (e->waiting != NULL && e->waiting->count > 0);
}

/* Is this pair of triangles among those that the caller lists? */
bool exclusions_have(const exclusions *e, uint32_t a, uint32_t b);

/* A seam joins what has become of its vertices: of vertices that came apart, the first. A pair of ignored
 * triangles becomes all pairs of triangles that came from the two. Pairs do not wait. OUT_OF_MEMORY without
 * a sentence: *out is untouched. */
cscd_status exclusions_move(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                            exclusions *out);

/* The same of what was left out before, where all vertices that came from one count as it did. */
cscd_status exclusions_move_former(const exclusions *e, const cscd_mesh *mesh, const cscd_mesh_change *change,
                                   exclusions *out);

/* Copies all of it but the waiting pairs; mesh: the same one in the context of the copy. On failure *out is
 * untouched. */
cscd_status exclusions_copy(const exclusions *e, const cscd_mesh *mesh, exclusions *out);

/* ---- pairs that wait: a change has uncovered them while they touched ----------------------------------- */

/* The pairs that were left out before a change: by seams and ignored pairs, or among objects. */
typedef struct former_exclusions {
    struct former_exclusions *next;
    exclusions exclusions;
    /* One for each object, as it was; a set without kinds: the object did not exist. NULL: only the exclusions count. */
    object_set *sets;
} former_exclusions;

typedef struct waiting_pairs {
    named_pair_set pairs; /* of features, which searches leave out, and of triangles, which the check does */
    /* Pairs of neighbours that the mesh has parted: they wait if they are not apart at the next positions. */
    named_pair_set torn;
    former_exclusions *former; /* changes since positions were last seen, the last one first; NULL: none */
    former_exclusions *spare;  /* for the next change; NULL: none */
} waiting_pairs;

void waiting_pairs_free(const cscd_mesh *mesh, waiting_pairs *w);

/* Returns the number of pairs of features that wait. */
static inline size_t waiting_features(const waiting_pairs *w) {
    return w->pairs.count - w->pairs.triangle_pairs;
}

/* Makes room for one change, so that it cannot fail later. */
cscd_status waiting_pairs_reserve(const cscd_mesh *mesh, waiting_pairs *w);

/* Remembers what has been left out until now, and owns it from then on: the seams and ignored pairs of
 * *before, or the sets of objects. Names are in the numbering of the present mesh: vertices of one name
 * counted as one. Room has been made. Pairs that an earlier change leaves out as well are not remembered
 * twice, so changes to and fro take no memory. */
void waiting_pairs_uncover(const cscd_mesh *mesh, waiting_pairs *w, exclusions *before);
void waiting_pairs_uncover_objects(const cscd_mesh *mesh, waiting_pairs *w, object_set *before);

/* Did any of the changes uncover this pair of features, or of triangles that intersect at the positions? */
bool waiting_pairs_uncovered(const cscd_mesh *mesh, const waiting_pairs *w, cscd_contact_kind kind,
                             uint32_t a, uint32_t b, const double *positions);

/* Forgets the changes. */
void waiting_pairs_settled(const cscd_mesh *mesh, waiting_pairs *w);

/* The exclusions and rules of the old mesh, as the detector sees them. */
typedef struct left_out_before {
    const cscd_mesh *mesh;
    const exclusions *exclusions;
    const struct pair_rules *rules;
} left_out_before;

/* A pair that waits becomes all pairs that came from its two features. Neighbours that the change has parted,
 * because their common vertex, or the seam between them, came apart, are added to *out as torn. If obstacles
 * become free, the pairs that they left out are uncovered. mesh: the new one. OUT_OF_MEMORY without a
 * sentence: *out holds nothing. */
cscd_status waiting_pairs_move(const waiting_pairs *w, const left_out_before *before, const cscd_mesh *mesh,
                               const cscd_mesh_change *change, waiting_pairs *out);

/* Copies all of it; mesh: the same one in the context of the copy. The same of failure. */
cscd_status waiting_pairs_copy(const waiting_pairs *w, const cscd_mesh *mesh, waiting_pairs *out);
