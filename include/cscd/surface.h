/* What crosses what at one moment, along which curves, what is buried in what, and how deep; and the same summed up by parts.
 * Everything is asked by cscd_detector_find_intersections. */
#ifndef CSCD_SURFACE_API_H
#define CSCD_SURFACE_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Curves ================================================================================================ */

/* Intersection curves: where the surfaces of a mesh pass through each other at one moment.
 *
 * A pair of triangles says what these two have in common; whether surfaces pass through each other is said by curves.
 * They are the curves of surfaces whose vertices are moved by infinitely small amounts, by one rule for the whole mesh
 * (Simulation of Simplicity, Edelsbrunner and Muecke 1990), so that nothing only touches: each two surfaces cross or are
 * apart. All is decided exactly, and points are those to which the curves go as the amounts go to 0. Vertices that seams
 * unite are one as long as they are at one place; where they are apart, they are two, for curves, patches, overlaps and
 * depths alike, and the surfaces go where their triangles go. Theory: docs/theory/curves.md.
 *
 * Degenerate meshes have curves, too. Of the moved surface every triangle has an area, no two triangles lie in one plane, and
 * different vertices are at different places; so triangles without area, duplicates and vertices at equal positions need no
 * rule of their own. Where an edge has three triangles or more, or one, curves end (cscd_curve_end). A triangle of
 * which seams unite two corners at one place is a line, and has no curve. */

/* What is at the end of a curve. Later versions may add values. */
typedef enum cscd_curve_end {
    CSCD_CURVE_END_NONE,     /* it is closed */
    CSCD_CURVE_END_VERTEX,   /* a vertex that both triangles have: there the vertex's star crosses itself */
    CSCD_CURVE_END_BORDER,   /* an edge of one triangle only, the border of an open surface */
    CSCD_CURVE_END_JUNCTION, /* an edge of three triangles or more */
    CSCD_CURVE_END_LEFT_OUT, /* it would go on in a pair that is left out */
    CSCD_CURVE_END_MAX_ENUM = 0x7fffffff
} cscd_curve_end;

/* A point of a curve, where an edge passes through a triangle: (1-s) e0 + s e1 on the edge (e0, e1), and (1-u-v) p0 + u p1 +
 * v p2 on the triangle. Where the curve ends at a vertex, edge is UINT32_MAX, triangle is the vertex, and s, u, v are 0. Each
 * number is rounded once from its exact value. It never grows. */
typedef struct cscd_curve_point {
    uint32_t edge, triangle;
    double s, u, v;
    double x[3];
} cscd_curve_point;

/* A piece of a curve, from one of its points to the next, straight. It lies in two triangles: a is on the first side of
 * the curve, b on the second one. It never grows. */
typedef struct cscd_curve_piece {
    uint32_t a, b;
} cscd_curve_piece;

/* A curve is where two sheets of surface pass through each other. The triangles a of its pieces are its trace on the first
 * sheet, those b on the second one; from piece to piece the triangle of one sheet changes, over the edge of the point in
 * between. Where both sheets are consistently oriented, it runs in the direction of the normal of a times (cross product)
 * that of b: on sheet a the inside of b is to its left, seen from outside. It never grows. */
typedef struct cscd_curve {
    size_t first_point, point_count; /* in the list of all points; an open one has one more than pieces */
    size_t first_piece, piece_count; /* in the list of all pieces */
    cscd_curve_end start, end;       /* NONE for a closed one, whose last piece leads to its first point */
    uint32_t components[2];          /* of the two sheets */
    uint32_t objects[2];
    bool closed;
    bool
        swapped; /* closed, and after one turn the sheets have changed places, which needs a surface that has no
                          * orientation */
    bool touching; /* only where depths were asked for: the surfaces touch along it, and no more. No pair of
                          * triangles crosses, and nothing that it bounds has a depth */
    uint8_t reserved[5]; /* 0 */
    double length;       /* of its pieces, up to rounding */
} cscd_curve;

/* Curves in the order of their least pairs (a, b). The lists belong to the detector and live until its next call. */
typedef struct cscd_curves {
    const cscd_curve *items;
    size_t count;
    const cscd_curve_point *points;
    size_t point_count;
    const cscd_curve_piece *pieces;
    size_t piece_count;
    const uint32_t
        *pair_curves; /* per pair of the list of intersections: the curve that has a piece in it, or
                                  * UINT32_MAX */
    size_t pair_count;
} cscd_curves;

/* ==== Patches and overlaps ================================================================================== */

/* Patches: the parts into which intersection curves cut the surface of a mesh, and what they are buried in. Theory: docs/theory/curves.md. */

/* A *body* is what winding numbers count as one. The objects are the bodies; with the option part_bodies an object may have
 * several. By labels of parts (cscd/surface.h) two components are in one body if a part has triangles of both, or if other
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

/* ==== What curves cut off =================================================================================== */

/* What curves cut off of open surfaces.
 *
 * An open surface, as cloth, has no inside, so nothing can be buried in it. But where a curve divides it, the smaller part
 * is most likely the one that has come through, which a solver draws back (global intersection analysis: D. Baraff,
 * A. Witkin, M. Kass, Untangling Cloth, ACM Transactions on Graphics 22, 2003). Theory: docs/theory/curves.md, Lemma 11. */

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

/* ==== Depths ================================================================================================ */

/* Depths: how deep what is buried lies below the surface of the body that contains it. Theory: docs/theory/curves.md. */

/* A point of the mesh that a body (cscd/surface.h) contains, and the nearest point of that body's outer surface, which is
 * all of its closed components but what the body contains itself. So the surface under the intruder counts: a ball that
 * is sunk 0.1 into a slab has depth 0.1. Where a point is buried in its own body, the nearest point may lie on the point's
 * own limb. The depth is not how far the bodies have to move until they are apart, which may be much more.
 *
 * A depth is above 0 exactly where the point lies within the body, not on its surface: where surfaces lie on each other it
 * is 0, however the infinitely small motion of the curves goes. It never grows. */
typedef struct cscd_depth {
    uint32_t vertex; /* UINT32_MAX: the point is on an edge or a face */
    uint32_t edge;   /* UINT32_MAX: the point is a vertex or on a face */
    uint32_t face;   /* a triangle that has the point; of a vertex or an edge its first */
    uint32_t
        patch; /* of the point; UINT32_MAX: of an edge, of a vertex at which curves end, or of a face none of
                        * whose corners the body contains */
    uint32_t body;     /* which contains the point */
    uint32_t triangle; /* of that body: has the nearest point; of several the first */
    double s;          /* on the edge (e0, e1) the point is (1-s) e0 + s e1 */
    double depth;      /* up to rounding */

    /* Of a face: no point of the surface that the item stands for (see cscd_depths) is deeper. Never below the depth, and
     * above it by at most 1 %, or a billionth of the largest coordinate. Else the depth. */
    double bound;
    double x[3]; /* the point */

    /* A unit vector: x + depth * direction is the nearest point. Where the depth is 0, the normal there, which is 0 of a
     * triangle without area. */
    double direction[3];
} cscd_depth;

/* The deepest point of a patch in one body. It never grows. */
typedef struct cscd_patch_depth {
    uint32_t patch, body;
    size_t deepest; /* in the list of all depths: one of a face */
} cscd_patch_depth;

/* Three lists, one behind the other:
 *   vertices  all that a body contains, sorted by (vertex, body), each once for each of these bodies
 *   edges     sorted by (edge, body), the deepest points of edges that a body contains between two of its curves, so that
 *             none of the edge's vertices tells of it. These are the deepest to a millionth of the edge
 *   faces     the deepest points of the surface itself, wherever on it they are: one for each patch, body that contains it
 *             and part (cscd/surface.h) that has triangles of it, sorted by (patch, body, part); then, sorted by (face,
 *             body), one for each triangle of which a body contains something, but none of its corners. So no point of the
 *             surface is deeper than the greatest bound of these
 * The lists belong to the detector and live until its next call. */
typedef struct cscd_depths {
    const cscd_depth *items;
    size_t count;                    /* of all three */
    size_t vertex_count, edge_count; /* so many of them are of vertices, and of edges */
    const cscd_patch_depth *patches; /* sorted by (patch, body) */
    size_t patch_count;
} cscd_depths;

/* ==== Parts ================================================================================================= */

/* Parts: labels of triangles, as of the limbs of one skin, and what intersections and contacts have to do with each pair of
 * parts. */

/* Says which part each triangle is in, by one label for each, from the next call on. A label is below part_count, which is 1
 * or more, or UINT32_MAX: that triangle is in no part. NULL and 0: the objects are the parts, as at first. Parts do not
 * change which pairs and curves are found, only how they are summed up. With the option part_bodies they also say what the bodies
 * are (cscd/surface.h), in which patches, overlaps and depths are measured: a ball in a slab, each a part or both of none, is then
 * as deep in one object as in two. INVALID_ARGUMENT: the sentence names the triangle whose label is too
 * large.
 *
 * A vertex or an edge is in the part of the first of its triangles, so that each contact counts once. Without a triangle
 * (wires, points, half-spaces) it is in the part of its object where objects are the parts, and else in none. What is in no
 * part is summed up as the part UINT32_MAX, which comes last.
 *
 * After cscd_detector_change_mesh each triangle has the label of its origin; one without an origin is in no part. A clone
 * has the labels of its original. */
CSCD_API cscd_status cscd_detector_set_parts(cscd_detector *detector, const uint32_t *labels,
                                             uint32_t part_count);

/* Says what belongs together, where that is not the parts: labels as for cscd_detector_set_parts, which the bodies of part_bodies and
 * CSCD_ORIENTATION_BY_PART go by then. So the materials of one skin can be the parts, and a ball in a slab of the same material is a body
 * of its own. NULL and 0: the parts say so, as at first. */
CSCD_API cscd_status cscd_detector_set_bodies(cscd_detector *detector, const uint32_t *labels,
                                              uint32_t label_count);

/* Writes for each triangle its body with the option part_bodies (cscd/surface.h), and returns how many bodies there are. Those of an
 * object follow each other, in the order of the objects; an object without triangles has one. A component that may be a cavity
 * has a body here, which it leaves at each moment at which it is one. labels may be NULL. */
CSCD_API uint32_t cscd_detector_body_labels(const cscd_detector *detector, uint32_t *labels);

/* ---- intersections ------------------------------------------------------------------------------------- */

/* What the answers of one cscd_detector_find_intersections say of two parts, or of one with itself. Curves and depths are
 * known only if the options ask for them; else there are none. It never grows. */
typedef struct cscd_part_pair {
    uint32_t a, b; /* parts; a <= b */

    /* So many pairs of triangles of the list; so many triangles of a, and of b, are in one of them, and their share of all
     * triangles of a, and of b. With a = b both numbers are the same. */
    size_t crossing, coplanar, folded, duplicate, touching;
    size_t faces[2];
    double shares[2];

    /* So many curves have pieces in these pairs, and so many of them are marked as touching. A curve may run through several
     * pairs of parts; the length is that of the pieces here, up to rounding. */
    size_t curves, touching_curves;
    double length;

    /* The deepest of the points of one part whose nearest points are on the other one, and the first of several: its place
     * in the list of depths, and its depth; SIZE_MAX and 0: there is none. No point of the parts is deeper than the bound.
     * Between limbs of one body the nearest triangle says which part it is; so the two need not intersect, and depth and
     * bound are those of the points in the list. */
    size_t deepest;
    double depth, bound;

    /* Known only with depths: the two are copies of one solid, whose surfaces lie on each other, so that nothing of one is
     * within the other and the depth is 0, and yet they contain the same. Where depth is above 0 or this is true, the interiors
     * of the two meet, whether or not two triangles cross. */
    bool same_solid;

    /* Known only with depths, and of a part with itself: something of it lies within another body than its own, as one thing of
     * a material in another one. False: what it buries of itself, or has nearest, is of one body. */
    bool in_other_body;
    uint8_t reserved[6];
} cscd_part_pair;

/* All pairs of parts that have at least one pair of triangles, piece of a curve or depth, sorted by (a, b). Pairs, lengths
 * and depths each count for one of them. The list belongs to the detector and lives until its next call. */
typedef struct cscd_part_pairs {
    const cscd_part_pair *items;
    size_t count;

    /* So many triangles are in a pair of the list, and their share of all triangles; 0 in a mesh without any. With the kind
     * CROSSING alone it is what is published as the share of self-intersecting faces. */
    size_t faces;
    double share;
} cscd_part_pairs;

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* The contacts of two parts, or of one with itself. It never grows. */
typedef struct cscd_contact_part_pair {
    uint32_t a, b;   /* parts; a <= b */
    size_t count;    /* of contacts */
    size_t earliest; /* the place in the given list of the one with the least toi; of several, the first */
    double toi;      /* its time */
} cscd_contact_part_pair;

/* All pairs of parts that have a contact, sorted by (a, b). The list belongs to the detector and lives until its next
 * call. */
typedef struct cscd_contact_part_pairs {
    const cscd_contact_part_pair *items;
    size_t count;
} cscd_contact_part_pairs;

/* Sums up contacts by pair of parts: a list of a step or of a line search, or any selection from it, in any order. Lists
 * that earlier calls gave out stay. INVALID_ARGUMENT: a contact is not of this mesh. An example, how the upper sheet
 * meets both halves of the lower one, which prints "0 and 2: 35 contacts; 1 and 2: 37 contacts":
 *
 *     uint32_t labels[36];
 *     cscd_contact_part_pairs sums;
 *     for (uint32_t t = 0; t < 36; t++) labels[t] = t / 9 < 2 ? t / 9 : 2;
 *     cscd_status status = cscd_detector_set_parts(detector, labels, 3);
 *     if (status == CSCD_OK)
 *         status = cscd_detector_contact_parts(detector, contacts.items, contacts.count, &sums);
 *     for (size_t i = 0; status == CSCD_OK && i < sums.count; i++)
 *         printf("%s%u and %u: %d contacts", i > 0 ? "; " : "", (unsigned)sums.items[i].a,
 *                (unsigned)sums.items[i].b, (int)sums.items[i].count);
 *     cscd_detector_set_parts(detector, NULL, 0);
 */
CSCD_API cscd_status cscd_detector_contact_parts(cscd_detector *detector, const cscd_contact *contacts,
                                                 size_t contact_count, cscd_contact_part_pairs *out);

/* ==== Intersections ========================================================================================= */

/* Intersections by kind: which pairs of triangles cross at one moment, which lie on each other in a plane, which only
 * touch.
 *
 * Every answer is that of exact arithmetic on the given coordinates. A triangle without its three edges is *open*. Two
 * triangles that both have an area
 *   cross           if the open triangles meet, and not in one plane: then they have a segment in common;
 *   share area      if the open triangles meet in one plane;
 *   touch           if they meet otherwise.
 * A triangle without area, whose corners lie on one line or at one place, can only touch. Where all triangles of a component
 * have no area, it is collapsed and intersects nothing (cscd_detector_collapsed). Edges and vertices that both
 * triangles have do not count as meeting: neighbours are a pair only if they meet elsewhere, too. *Shared vertices* are
 * those that both have by index, or as vertices that seams unite, wherever these are; 0 to 3. Vertices that are
 * merely at one place are not shared. What that means for neighbours:
 *   one shared vertex      they cross if, away from it, each passes through the open other one
 *   two shared vertices    they never cross, since their planes meet in the edge that they share: they are folded onto
 *                          each other, or no pair
 *   three shared vertices  they are a duplicate if they have an area, and else no pair
 * Seams may unite vertices that are apart. The kind then goes by where the corners are; three shared vertices make a
 * duplicate only if each two of them are at one place.
 *
 * Degenerate meshes are not refused. Duplicates are listed each with each; triangles at one edge or vertex, however many,
 * pair by pair; borders count as any edge. Copies of a triangle with vertices of their own, at the same positions,
 * share none, and so are coplanar. docs/theory/static-check.md has the proofs, and a drawing of each kind. */

/* How two triangles intersect. A pair has exactly one kind. Later versions may add values. */
typedef enum cscd_intersection_kind {
    CSCD_INTERSECTION_CROSSING,  /* they cross */
    CSCD_INTERSECTION_COPLANAR,  /* they share area in one plane, and no vertex */
    CSCD_INTERSECTION_FOLDED,    /* they share area in one plane, and one or two vertices */
    CSCD_INTERSECTION_DUPLICATE, /* they share all three vertices, and have an area */
    CSCD_INTERSECTION_TOUCHING,  /* they meet otherwise, or one has no area */
    CSCD_INTERSECTION_KIND_MAX_ENUM = 0x7fffffff
} cscd_intersection_kind;

/* Its name. */
static inline const char *cscd_intersection_kind_name(cscd_intersection_kind kind) {
    return cscd_name(CSCD_INTERSECTION_KINDS, kind);
}

/* A set that has one kind. Sets are joined by |. */
static inline uint64_t cscd_intersection_set(cscd_intersection_kind kind) {
    return UINT64_C(1) << kind;
}

/* What is asked. Later versions may add values. */
typedef enum cscd_intersection_answer {
    CSCD_ANSWER_LIST,  /* the pairs */
    CSCD_ANSWER_COUNT, /* how many there are, of each kind; nothing is kept, so longest_list does not matter */
    CSCD_ANSWER_ANY,   /* is there one? The search ends at the first that it meets */
    CSCD_ANSWER_MAX_ENUM = 0x7fffffff
} cscd_intersection_answer;

/* Which side of a closed component is its outside: what is inside out is found at each moment, and taken as turned around, by
 * the rule that cscd/surface.h gives. It matters for patches, overlaps and depths. Later versions may add values. */
typedef enum cscd_orientation {
    CSCD_ORIENTATION_BY_OBJECT, /* components that lie in others of their object are shells of these */
    CSCD_ORIENTATION_BY_PART, /* so are those of one part (cscd_detector_set_parts); other parts are bodies of their own */
    CSCD_ORIENTATION_AS_GIVEN, /* nothing is turned around: what is inside out contains nothing */
    CSCD_ORIENTATION_MAX_ENUM = 0x7fffffff
} cscd_orientation;

/* Options of cscd_detector_find_intersections; start from cscd_intersection_defaults. */
typedef struct cscd_intersection_options {
    uint32_t struct_size;            /* set by cscd_intersection_defaults */
    cscd_intersection_answer answer; /* LIST by default */

    /* Ends the search at so many pairs of the kinds that count; 0, the default: never. The same calls find the same pairs
     * for any number of threads: the first ones in an order that follows from the detector's trees, which depend on
     * the positions that it has seen. The list is sorted as ever. */
    size_t stop_after;

    uint64_t kinds; /* the set of those that count; all, UINT64_MAX, by default */

    /* What is found beside the pairs; false by default. All of these need the list of all pairs: INVALID_ARGUMENT with
     * another answer, with fewer kinds and with stop_after. Patches, overlaps and depths need curves, and overlaps and
     * depths need patches, which are then given, too. */
    bool curves;   /* where surfaces pass through each other: cscd/surface.h */
    bool patches;  /* what curves cut them into, and what these are buried in: cscd/surface.h */
    bool overlaps; /* areas and volumes of what objects bury: cscd/surface.h */
    bool depths;   /* how deep: cscd/surface.h */

    /* What is found summed up by pair of parts: cscd/surface.h. Needs the answer LIST, of any pairs; INVALID_ARGUMENT with
     * another one. false by default. */
    bool parts;

    /* false by default, too. */
    bool
        cut_offs; /* what curves cut off of open surfaces: cscd/surface.h. Needs patches, which are then given, too */
    bool part_bodies; /* parts, and components of no part, are bodies: cscd/surface.h */
    uint8_t reserved[4];
    cscd_orientation orientation; /* BY_OBJECT by default */

    /* For a gate: the deepest points of faces are looked for until each of their depths is above this, or its bound is not.
     * 0 or more; INFINITY by default: 1 % is enough. */
    double depth_limit;
    /* The most bytes that the call may take for what it finds, beside the pairs; 0, the default: a quarter of the memory that was
     * free at the first call of this detector. What does not fit is left out, see cscd_left_out. That is decided by how
     * long lists are, so for one number it is the same for any number of threads, and what is given is what would be given
     * without any limit. The pairs themselves take up to 64 bytes each beside it; if they alone are more than that, the call
     * fails with LIST_TOO_LONG. Vertices in the wrong order, as those of a file that was not exported from the same mesh, make
     * millions of pairs of a few thousand triangles, and what belongs to them would fill any machine. */
    size_t max_memory;
    /* The most work that depths may take, in comparisons of a point with a part of a triangle; 0, the default: 2^28, which are some ten
     * seconds. It is estimated before it is done, by how many parts curves cut triangles into: a few hundred triangles that all
     * cross each other, as with vertices in the wrong order, have millions. Depths that would take more are left out. */
    uint64_t max_work;
} cscd_intersection_options;

/* What a call may leave out because it does not fit max_memory, or max_work. Later versions may add values. */
typedef enum cscd_left_out {
    CSCD_LEFT_OUT_PAIRS, /* not in a list, but counted */
    CSCD_LEFT_OUT_CURVES,
    CSCD_LEFT_OUT_PATCHES,
    CSCD_LEFT_OUT_OVERLAPS,
    CSCD_LEFT_OUT_CUT_OFFS,
    CSCD_LEFT_OUT_DEPTHS, /* then curves do not know whether surfaces only touch along them */
    CSCD_LEFT_OUT_PARTS,
    CSCD_LEFT_OUT_MAX_ENUM = 0x7fffffff
} cscd_left_out;

/* The default options. */
CSCD_API void cscd_intersection_defaults_sized(cscd_intersection_options *out, size_t size);
static inline cscd_intersection_options cscd_intersection_defaults(void) {
    cscd_intersection_options options;
    cscd_intersection_defaults_sized(&options, sizeof options);
    return options;
}

/* Two triangles a < b that intersect. */
typedef struct cscd_intersection_pair {
    uint32_t a, b;
    cscd_intersection_kind kind;
    uint32_t shared;                    /* vertices */
    uint32_t components[2], objects[2]; /* those of a, then those of b */
} cscd_intersection_pair;

/* The pairs of the kinds that count. The list is sorted by (a, b); it belongs to the detector and lives until its next
 * call. */
typedef struct cscd_intersection_pairs {
    const cscd_intersection_pair *items;                    /* NULL, unless the answer is LIST */
    size_t count;                                           /* for ANY 1 or 0: yes or no */
    size_t crossing, coplanar, folded, duplicate, touching; /* so many of these; for ANY all 0 */
    size_t waiting; /* so many pairs of triangles wait, and are left out: see cscd_detector_set_seams */
    uint32_t zero_area_triangles; /* how many triangles have all corners on one line */
    uint32_t first_zero_area;     /* the first of them; UINT32_MAX if there is none */
    uint32_t collapsed; /* so many components are, and intersect nothing: see cscd_detector_collapsed */
    bool stopped;       /* the search has ended early, so there may be more pairs */
    uint8_t reserved[3];

    /* What was asked for, else NULL. They belong to the detector and live as long as the list. */
    const cscd_curves *curves;
    const cscd_patches *patches;
    const cscd_overlaps *overlaps;
    const cscd_depths *depths;
    const cscd_cut_offs *cut_offs;
    const cscd_part_pairs *parts;

    const uint32_t *collapsed_components; /* `collapsed` of them, ascending; NULL: there are none */
    /* What was asked for and is NULL all the same, because it does not fit max_memory or max_work: (uint64_t)1 << CSCD_LEFT_OUT_CURVES,
     * and so on, joined by |. 0: nothing. */
    uint64_t left_out;
    size_t
        wanted_memory; /* the max_memory with which the first of these would have gone on; more may be needed then */
    uint64_t
        wanted_work; /* the max_work that all of it would take, by an estimate, and then wanted_memory is 0; 0: work was not
                           * what did not fit */
} cscd_intersection_pairs;

/* Lists the triangle pairs that intersect or touch at the given positions, and how. options may be NULL. The pairs are
 * those of cscd_detector_check and, beside them, duplicates; so nothing that rules, obstacles, `ignored`, `ignore`,
 * seams and waiting pairs leave out is listed, nor pairs of triangles that are not active. Duplicates never come apart,
 * so a duplicate whose triangles have the same three indices does not wait when a change uncovers it. If the search was
 * not to stop early, the call does everything else that cscd_detector_check does: a step that starts here need not check
 * the positions again. Of the timings only check_ms changes; the counters stay those of the last step. INVALID_ARGUMENT:
 * no kind counts, or the answer is unknown. LIST_TOO_LONG: the list would be longer than longest_list, or than fits
 * max_memory; *out then counts all pairs, whatever stop_after is, and what was asked for beside them is left out.
 * CANCELLED: see cscd_progress. An example, the upper sheet laid into the plane of the lower one, which prints "0
 * crossing, 67 coplanar":
 *
 *     cscd_intersection_options options = cscd_intersection_defaults();
 *     cscd_intersection_pairs found;
 *     options.answer = CSCD_ANSWER_COUNT;
 *     for (uint32_t v = SHEET; v < n; v++) x0[3 * v + 2] = 0.0;
 *     cscd_status status = cscd_detector_find_intersections(detector, CSCD_DOUBLES(x0, n), &options, &found);
 *     printf("%d crossing, %d coplanar\n", (int)found.crossing, (int)found.coplanar);
 */
CSCD_API cscd_status cscd_detector_find_intersections(cscd_detector *detector, const cscd_view *positions,
                                                      const cscd_intersection_options *options,
                                                      cscd_intersection_pairs *out);

/* Was the component collapsed in the last check, or at an end of the last step? A component is *collapsed* at positions
 * at which every triangle of it has all corners on one line, exactly: an object that is hidden by a scale of 0, or one
 * whose vertices are all 0. It has no surface there, and its features coincide by thousands, which says nothing.
 *   - At one moment (cscd_detector_check, cscd_detector_find_intersections) it intersects nothing.
 *   - In a step, pairs of features that both belong to components collapsed at x0 or at x1 are not looked at: neither
 *     those within one such component, nor those between two. All others are, as ever. Its guarantee has
 *     CSCD_REASON_COLLAPSED, and what is known of its triangles ends with the step.
 *   - cscd_detector_max_step and line searches look at all pairs, so that they certify nothing that they have not seen.
 * A component all of whose triangles are wires, (a, b, b') with a seam between b and b', is never collapsed, nor is one in
 * which a single triangle has an area. False before the first call, and for a component that is not the mesh's. */
CSCD_API bool cscd_detector_collapsed(const cscd_detector *detector, uint32_t component);

#ifdef __cplusplus
}
#endif

#endif
