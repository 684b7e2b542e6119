/* Pairs that the caller wants to be left out: by callback, by list, and by seams. */
#pragma once

#include "runtime/narrow_phase/named_pair_set.h"
#include "runtime/narrow_phase/seam_list.h"

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

/* Copy everything but the seams, or but the ignored pairs, and take these from the caller. Seams that are still to be
 * checked stay with *now. */
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

/* Is this contact, or proximity, of two features without a common vertex to be left out? */
bool exclusions_cover_features(const exclusions *e, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* Is this intersection of triangles a < b to be left out? Seams exclude it when every two of their features
 * that intersect have a vertex of one seam in common. */
bool exclusions_cover_triangles(const exclusions *e, uint32_t a, uint32_t b, const double *positions);

/* The same of a duplicate: triangles of three shared vertices, which seams do not exclude. */
bool exclusions_cover_duplicate(const exclusions *e, uint32_t a, uint32_t b);

/* Does the caller's function leave these triangles out? */
bool exclusions_host_ignores(const exclusions *e, uint32_t a, uint32_t b);
