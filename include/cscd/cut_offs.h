/* What curves cut off of open surfaces. Part of cscd/cscd.h, which says what holds for every function.
 *
 * An open surface, as cloth, has no inside, so nothing can be buried in it. But where a curve divides it, the smaller part
 * is most likely the one that has come through, which a solver draws back (global intersection analysis: D. Baraff,
 * A. Witkin, M. Kass, Untangling Cloth, ACM Transactions on Graphics 22, 2003). Theory: docs/theory/curves.md, Lemma 11. */
#ifndef CSCD_CUT_OFFS_API_H
#define CSCD_CUT_OFFS_API_H

#include <cscd/patches.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which trace of a curve. Later versions may add values. */
typedef enum cscd_curve_trace {
    CSCD_TRACE_FIRST,  /* that on the first sheet */
    CSCD_TRACE_SECOND, /* that on the second one */
    CSCD_TRACE_BOTH, /* both in one: they go over into each other at vertices where the curve ends, or it is swapped */
    CSCD_TRACE_MAX_ENUM = 0x7fffffff
} cscd_curve_trace;

/* A trace that divides an open component in two, so that no way on the surface leads from one part into the other without
 * crossing it. A closed trace may do so, and one from border to border; one that ends within the surface does not, nor one
 * around the waist of a ring with further holes. Other curves do not matter here. It never grows. */
typedef struct cscd_cut_off {
    size_t curve; /* in the list of curves */
    cscd_curve_trace trace;
    uint32_t component, object; /* that it divides */
    uint32_t reserved;          /* 0 */
    double area;                /* of the smaller part, which is what the trace cuts off */
    double rest;                /* of the other part, not less, up to rounding */
    size_t first_patch,
        patch_count; /* in the list of patches: those of the smaller part, ascending. None if it lies within triangles */
} cscd_cut_off;

/* Sorted by (curve, trace). Components are those of the mesh, as it was created: a trace that runs over a seam divides
 * nothing, and what is joined by a seam alone is not joined here. A trace costs as much as it is long, and as the side
 * with fewer patches, or the smaller one, has patches. The lists belong to the detector and live until its next call. */
typedef struct cscd_cut_offs {
    const cscd_cut_off *items;
    size_t count;
    const uint32_t *patches; /* places in the list of patches */
    size_t patch_count;
} cscd_cut_offs;

#ifdef __cplusplus
}
#endif

#endif
