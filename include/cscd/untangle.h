/* Untangling: which points of surfaces are on the wrong side, and positions without intersections that are near
 * given ones. docs/theory/untangle.md says how. */
#ifndef CSCD_UNTANGLE_API_H
#define CSCD_UNTANGLE_API_H

#include <cscd/surface.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Lenses ================================================================================================ */

/* A *lens* is what two sheets of surface that pass through each other bound together. The curve between them
 * (cscd_curve) divides both, and of each sheet one side is the wrong one. Most lenses come in twos: the tip of
 * one body in another one, and the hollow of that one which the tip fills. */

/* Why the points of a lens are on the wrong side. */
typedef enum cscd_lens_reason {
    CSCD_LENS_BURIED,     /* a body winds around them once or more (cscd_patch) */
    CSCD_LENS_INSIDE_OUT, /* their own body winds less than 0 times around them */

    /* More than 0.55 of their closed component is buried, so what looks out of the others is what is wrong. */
    CSCD_LENS_LOOKS_OUT,

    CSCD_LENS_SMALLER, /* they are on the smaller side of the curves in which it crosses open surfaces */

    /* An edge passes through the other sheet and back. Its points are the middles of such pieces. */
    CSCD_LENS_EDGE,

    /* No curve leads between the two, which only touch or lie in one plane. The corners that do have to part. */
    CSCD_LENS_FLUSH,
    CSCD_LENS_REASON_MAX_ENUM = 0x7fffffff
} cscd_lens_reason;

/* Returns the name of a reason: see CSCD_LENS_REASONS. */
static inline const char *cscd_lens_reason_name(cscd_lens_reason reason) {
    return cscd_name(CSCD_LENS_REASONS, reason);
}

/* A point of the surface that is on the wrong side, and the nearest place on the other sheet: beyond the curve,
 * or in the triangles along it. */
typedef struct cscd_lens_point {
    uint32_t vertex;   /* UINT32_MAX: the point is on an edge */
    uint32_t edge;     /* UINT32_MAX: the point is a vertex */
    uint32_t triangle; /* with the place, which is (1-u-v) p0 + u p1 + v p2 */

    /* False: x + thickness * direction is the place, up to rounding. True: the direction is a normal of the other
     * sheet, or of the triangle that touches it. The place is then nearer than a thousandth of the mean edge,
     * or it leads along the sheet or against its outward normal, as at the rim of thick lenses, and the
     * thickness is 0. */
    bool along_normal;
    uint8_t reserved[3];
    double s; /* on the edge (e0, e1) the point is (1-s) e0 + s e1; 0 for a vertex */
    double u, v;
    double x[3];         /* the point */
    double direction[3]; /* a unit vector; 0 if the normal has no length */
    double thickness;
} cscd_lens_point;

/* The points of one patch that are wrong for one reason and belong on one other sheet: of one component, and of
 * one part. Points of edges are those of one curve; flush ones are those of two components and their parts. */
typedef struct cscd_lens {
    cscd_lens_reason reason;

    /* Its number in cscd_patches of these positions; of several the first. UINT32_MAX: none, as for EDGE, FLUSH, and
     * vertices at which curves end. */
    uint32_t patch;

    /* Of its points, then of the sheet where they belong. Parts are as in cscd_detector_set_parts. */
    uint32_t components[2], objects[2], parts[2];

    bool
        fold; /* both sides of a curve are in the patch, as in skin folded through itself: this is one half */
    uint8_t reserved[7];
    size_t first_point, point_count; /* its range of points, ascending by vertex, edge and s */
    size_t thickest;  /* the index of the point with the greatest thickness, of several the first */
    double thickness; /* of that one */

    /* A unit vector: the way on which the points leave together. Of a closed component it is the vector area of
     * the patch, which depends on the curves around it alone, if all of its points are in this lens; else the mean
     * of their ways, or 0 where these cancel each other. */
    double axis[3];
} cscd_lens;

/* The findings of cscd_detector_find_lenses. The lists live until the detector's next call. */
typedef struct cscd_lenses {
    const cscd_lens *items; /* the thickest first */
    size_t count;
    const cscd_lens_point *points; /* lens by lens */
    size_t point_count;
    double thickness; /* of the first lens; 0 if there is none */

    /* The number of pairs that intersect, and of curves that bound none of the points: they say of no side that it is
     * the wrong one, as a curve from the border of one sheet to the border of the other. */
    size_t pairs, undecided;
} cscd_lenses;

/* Finds which points of surfaces are on the wrong side at the given positions, where on the other sheet each
 * belongs, in which direction, and how far: what one calls the depth between two limbs, or of a fold. Unlike a
 * depth (cscd_depth), which is the way to the outer surface of a body, a thickness is the way to the sheet on
 * the other side of the same curve.
 *
 * Which side is wrong is exact where bodies decide it, and a rule of thumb where areas do; places are up to
 * rounding. Pairs to leave out are those of the detector, and obstacles have lenses, too. Of the options, which
 * may be NULL, part_bodies, orientation and max_memory count. The lenses are the same for any number of threads.
 *
 * INVALID_ARGUMENT: an option asks for fewer pairs. LIST_TOO_LONG: max_memory, or longest_list. CANCELLED: see
 * cscd_progress. An example, which prints who is how thick in whom:
 *
 *     cscd_lenses lenses = {0};
 *     cscd_status status = cscd_detector_find_lenses(detector, CSCD_DOUBLES(x1, n), NULL, &lenses);
 *     for (size_t i = 0; status == CSCD_OK && i < lenses.count; i++) {
 *         const cscd_lens *lens = &lenses.items[i];
 *         printf("part %u is in part %u: %g thick, %d points (%s)\n", (unsigned)lens->parts[0],
 *                (unsigned)lens->parts[1], lens->thickness, (int)lens->point_count,
 *                cscd_lens_reason_name(lens->reason));
 *     }
 */
CSCD_API cscd_status cscd_detector_find_lenses(cscd_detector *detector, const cscd_view *positions,
                                               const cscd_intersection_options *options, cscd_lenses *out);

/* ==== Untangling ============================================================================================ */

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
     * 0, taken as 1e-12 where they are less and as 1e12 where they are more. INFINITY pins it. NULL, the
     * default: 1 each. Vertices of obstacles, vertices that are not active and those without triangles are
     * pinned anyway, and all vertices of a seam are where one is. */
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

    /* A shape without intersections, in the same unit: near what intersects, edges are drawn to the lengths and
     * angles that they have there, turned as the surface is now. NULL, the default: to those of the input. */
    const cscd_view *rest;

    /* A length: displacements bend smoothly over it, at about three times the cost. 0, the default: they need
     * not. */
    double bending;

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

    /* How deep the parts were in each other: of the thickest lens (cscd_lenses), where areas count by weight.
     * 0 if lenses do not fit memory. */
    double thickness;
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
