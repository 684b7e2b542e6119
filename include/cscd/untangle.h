/* Untangling: positions without intersections that are near given ones. docs/theory/untangle.md says how. */
#ifndef CSCD_UNTANGLE_API_H
#define CSCD_UNTANGLE_API_H

#include <cscd/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The clean positions from which the result comes. */
typedef enum cscd_untangle_start {
    CSCD_UNTANGLE_NO_START, /* none were found, or none were needed: the positions were clean */
    CSCD_UNTANGLE_GIVEN,    /* those of the caller */
    CSCD_UNTANGLE_PUSHED,   /* surfaces pushed out of each other, through what they have in common */
    CSCD_UNTANGLE_SHRUNK,   /* components shrunk around their middles */
    CSCD_UNTANGLE_START_MAX_ENUM = 0x7fffffff
} cscd_untangle_start;

/* Options of cscd_detector_untangle; start from cscd_untangle_defaults. Arrays and views are read during the
 * call. */
typedef struct cscd_untangle_options {
    uint32_t struct_size; /* set by cscd_untangle_defaults */

    /* The most rounds of pushing, and the most steps of the descent, for each start that is tried; 60 and 40 by
     * default. */
    uint32_t max_rounds, max_steps;
    uint32_t reserved; /* 0 */

    /* How strongly each vertex is drawn to where it was given, relative to others: vertex_count numbers above
     * 0. INFINITY pins it. NULL, the default: 1 each. Vertices of obstacles, vertices that are not active and
     * those without triangles are pinned anyway. */
    const double *weights;

    /* Clean positions to start from, such as the result of the frame before; NULL, the default: none. */
    const cscd_view *start;

    /* The positions that `start` was the result for; NULL, the default: unknown. The displacement is then
     * carried over, and `steady`, a number in [0,1), draws the result towards it: 0, the default, for not at
     * all, near 1 for motion without jitter. */
    const cscd_view *start_input;
    double steady;

    /* A length: displacements are spread over so much of the surface. 0, the default: about twice the
     * thickness of what intersects. */
    double spread;

    double max_seconds; /* then the call ends with the best so far; INFINITY by default */
} cscd_untangle_options;

/* Returns the default options. */
CSCD_API void cscd_untangle_defaults_sized(cscd_untangle_options *out, size_t size);
static inline cscd_untangle_options cscd_untangle_defaults(void) {
    cscd_untangle_options options;
    cscd_untangle_defaults_sized(&options, sizeof options);
    return options;
}

/* The findings of cscd_detector_untangle. */
typedef struct cscd_untangled {
    cscd_untangle_start start;
    bool clean;   /* no pair intersects, and all keep what they have to, in the positions as stored */
    bool moved;   /* some vertex is not where it was, bit for bit */
    bool stopped; /* max_seconds or the host ended the call before it was done */
    uint8_t reserved;
    size_t pairs_before, pairs_after; /* that intersect (cscd_detector_find_intersections) */
    size_t near_before, near_after;   /* of features that are nearer than they have to keep, without these */
    uint32_t moved_vertices;
    uint32_t farthest; /* the first vertex with the greatest displacement; UINT32_MAX if none moved */
    double displacement, mean_displacement; /* the greatest, and the mean of the vertices that moved */
    double thickness; /* about how deep the parts were in each other: see cscd_lens; 0 if that is not known */
    uint32_t rounds, steps; /* of all starts that were tried */
} cscd_untangled;

/* Finds positions near the given ones at which nothing intersects, and writes them to `reached`, which may be
 * the same, or NULL. Two stages: clean positions are found (cscd_untangle_start), and a descent by certified steps
 * leads from them as near to the given ones as surfaces allow, so that displacements are smooth.
 *
 * The result is never worse: it is the input, bit for bit, or has strictly fewer intersecting pairs in the
 * positions as stored, or as many of these and fewer that are too near. `clean` is decided by the exact check.
 * From clean positions in `start` in which pinned vertices are where they are now, and which are clean as they
 * would be stored, the result is always clean. Where no start is found, the result is the best that was met, and
 * what is left can be asked of cscd_detector_find_intersections. Pinned vertices do not change by a bit, and
 * vertices of a seam that are at one place, in `start` too, stay at one place. min_separation, rules and pairs
 * to leave out are those of the detector. The result is the same for any number of threads, unless max_seconds
 * ends the call.
 *
 * Where the host cancels, the result is the best so far, and `stopped` says so; the status is CSCD_OK, and
 * cscd_context_detail says who did. CANCELLED: the host did so before the pairs at the given positions were
 * counted; nothing is written then.
 * INVALID_ARGUMENT also for the methods PUBLISHED and ICCD_PUBLISHED, where `start` is not clean, and for
 * doubles in `positions` with floats in `reached`. LIST_TOO_LONG: there are more pairs than fit memory. An
 * example, in which whatever crosses at x1 parts:
 *
 *     cscd_untangled found;
 *     double apart[3 * VERTICES];
 *     cscd_status status = cscd_detector_untangle(detector, CSCD_DOUBLES(x1, n), NULL,
 *                                                 CSCD_MUTABLE_DOUBLES(apart, n), &found);
 *     if (status == CSCD_OK && !found.clean) printf("%d pairs are left", (int)found.pairs_after);
 */
CSCD_API cscd_status cscd_detector_untangle(cscd_detector *detector, const cscd_view *positions,
                                            const cscd_untangle_options *options,
                                            const cscd_mutable_view *reached, cscd_untangled *out);

#ifdef __cplusplus
}
#endif

#endif
