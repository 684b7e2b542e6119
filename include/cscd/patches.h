/* Patches: the parts into which intersection curves cut the surface of a mesh, and what they are buried in. Part of
 * cscd/cscd.h, which says what holds for every function. Theory: docs/theory/curves.md. */
#ifndef CSCD_PATCHES_API_H
#define CSCD_PATCHES_API_H

#include <cscd/curves.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A *body* is what winding numbers count as one. The objects are the bodies; with the option part_bodies an object may have
 * several. By labels of parts (cscd/parts.h) two components are in one body if a part has triangles of both, or if other
 * components join them so: a slab and a ball in one file, each with a part of its own, are two bodies; the limbs of one
 * skin are parts of one. A component of no part is a body of its own, and so is each component of a mesh that has one object
 * and no labels. A cavity (below) has the body of the shell around it.
 *
 * How often a body winds around a patch: the sum over its closed components, exact, and under the same infinitely small
 * motion as the curves. A point outside has number 0, one within the body 1, one within two of its components, or two of
 * its limbs, 2; in a cavity, whose shell has its normals inwards, it is 0 again. Components
 * that are turned inside out count as turned around (cscd_patches.turned). Below 0, a component passes through itself with its
 * inside out, or orientations are taken as given. It never grows. */
typedef struct cscd_winding {
    uint32_t body;
    int32_t number; /* not 0 */
} cscd_winding;

/* A part of a component's surface that is connected over edges which no curve cuts. It is on one side of every surface. It
 * is buried in another body whose number is 1 or more. Its own body has the number that holds just outside of the patch,
 * on the side of the normals, or on the other one if its component is taken as turned around: from 1 on the patch is buried in its own body, and below 0 it is inverted, as of a body or a
 * limb that is inside out. Open components have no inside, and do not count in the numbers of their body. Where a pair
 * of triangles is left out although a curve runs through both, no patch ends there, and its numbers are those at its
 * example. It never grows. */
typedef struct cscd_patch {
    uint32_t component, object, body;
    uint32_t triangle, corner; /* an example: it has this corner of this triangle */
    uint32_t vertex_count,
        triangle_count; /* those that are wholly in it: of triangles those that no curve cuts */
    uint32_t first_winding,
        winding_count; /* in the list of all numbers, ascending by body; all others are 0. Those of objects that
                                            * the patch's object is not looked at with are left out */
    int32_t own;       /* the number of its own body, which is in the list too if it is not 0 */
} cscd_patch;

/* Patches in the order of their first triangles.
 *
 * Which components are inside out is found at each moment, and exactly (docs/theory/orientation.md). A closed component is
 * inverted if the volume that it encloses is negative; where it passes through itself, each place counts as often as its
 * surface winds around it. A *cavity* is a component that lies in another one of its object without crossing it, is turned the other
 * way round than the innermost such one, and that one is no cavity; but of two that cross the one that encloses less is none. A
 * cavity is turned around if the shell around it is; each other component if it is inverted. So a cavity stays a cavity, and a second body a second body, also in an object that is inverted as
 * a whole. With CSCD_ORIENTATION_BY_PART, and with part_bodies, a component can only be a cavity of one that has the part of its first
 * triangle (or, of none, triangles of none), too. A component without volume is as given.
 *
 * The lists belong to the detector and live until its next call. */
typedef struct cscd_patches {
    const cscd_patch *items;
    size_t count;
    const cscd_winding *windings;
    size_t winding_count;
    const uint32_t
        *vertex_patches; /* per vertex; UINT32_MAX: it has no triangle, or curves end at it, so that its
                                       * triangles may be in several patches */
    const uint32_t *triangle_patches; /* per triangle; UINT32_MAX: a curve cuts it */
    const uint32_t
        *corner_patches; /* per corner of each triangle, triangle by triangle: the patch on the side of the
                                       * edge that begins at the corner */
    const bool *
        turned; /* per component: it is inside out, and taken as turned around; NULL: none is, or AS_GIVEN was
                         * asked for */
} cscd_patches;

/* What two bodies bury of each other, or one of itself. A body contains a point where its number is 1 or more. A
 * triangle that curves cut counts with its parts, so areas and volumes are those of the overlap, up to rounding. They are
 * those of the limit of the infinitely small motion, so where surfaces lie on each other either of two areas may be
 * counted. It never grows. */
typedef struct cscd_overlap {
    uint32_t a, b; /* bodies; a <= b */
    double area_a; /* of the surface of a that b contains; with a = b, that a itself contains */
    double area_b; /* the reverse; with a = b, of a's surface that is inverted */

    /* Of what both contain; with a = b, of what a contains twice or more. Only closed components count, and what a body
     * contains twice counts once. If its object is not looked at with itself (rules, obstacles), nobody knows where
     * that is, and it counts twice, as its number says. NaN: a curve between closed components is left out, wholly or in
     * part, because its pairs of triangles are (ignored, ignore, waiting, seams whose vertices are apart). Triangles
     * that are not active (cscd_detector_set_active) are not looked at with each other: where they cross, the volume
     * is wrong, and nothing tells of it. */
    double volume;
} cscd_overlap;

/* The overlaps that are not 0, or whose volume is not known, sorted by (a, b). n bodies, each in the next, have n (n - 1) / 2
 * of them, and as many windings. The list belongs to the detector and lives until its next call. */
typedef struct cscd_overlaps {
    const cscd_overlap *items;
    size_t count;
} cscd_overlaps;

#ifdef __cplusplus
}
#endif

#endif
