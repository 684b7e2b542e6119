/* Parts: labels of triangles, as of the limbs of one skin, and what intersections and contacts have to do with each pair of
 * parts. Part of cscd/cscd.h, which says what holds for every function. */
#ifndef CSCD_PARTS_API_H
#define CSCD_PARTS_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Says which part each triangle is in, by one label for each, from the next call on. A label is below part_count, which is 1
 * or more, or UINT32_MAX: that triangle is in no part. NULL and 0: the objects are the parts, as at first. Parts do not
 * change which pairs and curves are found, only how they are summed up. With the option part_bodies they also say what the bodies
 * are (cscd/patches.h), in which patches, overlaps and depths are measured: a ball in a slab, each a part or both of none, is then
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

/* These write one label for each triangle: its component, or its region of the plan. They return how many parts that makes.
 * So the regions of a plan become the parts of a detector by
 *
 *     cscd_detector_set_parts(detector, labels, cscd_plan_region_labels(plan, labels));
 */
CSCD_API uint32_t cscd_mesh_component_labels(const cscd_mesh *mesh, uint32_t *labels);
CSCD_API uint32_t cscd_plan_region_labels(const cscd_plan *plan, uint32_t *labels);

/* Writes for each triangle its body with the option part_bodies (cscd/patches.h), and returns how many bodies there are. Those of an
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

#ifdef __cplusplus
}
#endif

#endif
