/* Intersections at one moment: which triangles cross, along which curves, what is buried in what and how
 * deep, and sums by parts. cscd_detector_find_intersections finds all of it. Volumes and lengths also come with
 * their gradients. Lists belong to the detector and live until its next call. */
#ifndef CSCD_SURFACE_API_H
#define CSCD_SURFACE_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ==== Curves ================================================================================================ */

/* Intersection curves: where the surfaces of a mesh pass through each other at one moment.
 *
 * All vertices are moved by infinitely small amounts (Simulation of Simplicity, Edelsbrunner and Muecke
 * 1990), so each two surfaces cross or are apart, on degenerate meshes too. This is decided exactly; points
 * are the limits as the amounts go to 0. Vertices that seams unite are one vertex only while they are at one
 * place. A triangle has no curve if two of its corners are one vertex. docs/theory/curves.md is the theory of
 * curves, patches, overlaps, depths and cut-offs. */

/* The end of a curve. */
typedef enum cscd_curve_end {
    CSCD_CURVE_END_NONE,     /* the curve is closed */
    CSCD_CURVE_END_VERTEX,   /* a vertex of both triangles */
    CSCD_CURVE_END_BORDER,   /* an edge of one triangle only */
    CSCD_CURVE_END_JUNCTION, /* an edge of three triangles or more */
    CSCD_CURVE_END_LEFT_OUT, /* the curve would go on in a pair that is left out */
    CSCD_CURVE_END_MAX_ENUM = 0x7fffffff
} cscd_curve_end;

/* A point of a curve, where an edge (e0, e1) passes through a triangle: (1-s) e0 + s e1, which is (1-u-v) p0
 * + u p1 + v p2. At a vertex that ends the curve, edge is UINT32_MAX, triangle is the vertex, and s, u, v are
 * 0. Each number is rounded once from its exact value. */
typedef struct cscd_curve_point {
    uint32_t edge, triangle;
    double s, u, v;
    double x[3];
} cscd_curve_point;

/* A straight piece of a curve, in triangle a of the first sheet and triangle b of the second. */
typedef struct cscd_curve_piece {
    uint32_t a, b;
} cscd_curve_piece;

/* A curve along which two sheets of surface pass through each other. Its trace on the first sheet runs
 * through the triangles a of its pieces, its trace on the second sheet through the triangles b. Where both
 * sheets are consistently oriented, the curve runs along the cross product of the normals of a and b. */
typedef struct cscd_curve {
    size_t first_point, point_count; /* an open curve has one more point than pieces */
    size_t first_piece, piece_count;
    cscd_curve_end start, end; /* NONE if closed; the last piece then leads to the first point */
    uint32_t components[2];    /* of the two sheets */
    uint32_t objects[2];
    bool closed;

    /* Closed, and after one turn the sheets have changed places, as on a surface without orientation. */
    bool swapped;

    /* The surfaces only touch along it, and nothing that it bounds has a depth. Known only with depths. */
    bool touching;

    uint8_t reserved[5]; /* 0 */
    double length;       /* of its pieces, up to rounding */
} cscd_curve;

/* Curves in the order of their least pairs (a, b). */
typedef struct cscd_curves {
    const cscd_curve *items;
    size_t count;
    const cscd_curve_point *points;
    size_t point_count;
    const cscd_curve_piece *pieces;
    size_t piece_count;

    /* For each listed intersection the curve with a piece in it, or UINT32_MAX. */
    const uint32_t *pair_curves;
    size_t pair_count;
} cscd_curves;

/* ==== Patches and overlaps ================================================================================== */

/* The number of times that a body winds around a patch, exactly: the sum over its closed components. The
 * number is 0 outside and in cavities, 1 within the body, and 2 within two of its components or limbs. It is
 * below 0 within what is inside out and not taken as turned around.
 *
 * The *bodies* are the objects. With the option part_bodies, two components of an object are in one body if a
 * part has triangles of both, or if other components join them so. A component of no part is then a body of
 * its own, as is each component of a mesh that has one object and no labels. A cavity (cscd_patches) belongs
 * to the body of its shell. */
typedef struct cscd_winding {
    uint32_t body;
    int32_t number; /* not 0 */
} cscd_winding;

/* A part of a component's surface that is connected over edges which no curve cuts. A patch is buried in each
 * other body whose number there is 1 or more: that body contains it. Open components contain nothing. Where a
 * pair is left out although a curve runs through it, no patch ends there, and the numbers are those at the
 * example. */
typedef struct cscd_patch {
    uint32_t component, object, body;
    uint32_t triangle, corner;             /* an example: a corner of a triangle in the patch */
    uint32_t vertex_count, triangle_count; /* those wholly in it */

    /* Its range of `windings`, ascending by body. Other numbers are 0, or of objects that its object is not
     * looked at with. */
    uint32_t first_winding, winding_count;

    /* The number of its own body just outside. From 1 on it is buried in its own body; below 0 it is
     * inverted. */
    int32_t own;
} cscd_patch;

/* Patches in the order of their first triangles.
 *
 * A closed component is inverted if its volume is negative, which is decided exactly at each moment. A
 * *cavity* lies in a shell, another component of its object, without crossing it, and is turned the other way
 * round. A cavity is turned around if its shell is, each other component if it is inverted. With
 * CSCD_ORIENTATION_BY_PART or part_bodies, the shell also has the part of the cavity's first triangle.
 * docs/theory/orientation.md has the whole rule. */
typedef struct cscd_patches {
    const cscd_patch *items;
    size_t count;
    const cscd_winding *windings;
    size_t winding_count;

    /* The patch of each vertex; UINT32_MAX if it has no triangle, or if curves end at it. */
    const uint32_t *vertex_patches;

    const uint32_t *triangle_patches; /* of each triangle; UINT32_MAX if a curve cuts it */

    /* The patch of each corner, triangle by triangle, at the edge that begins there. */
    const uint32_t *corner_patches;

    /* Whether each component is taken as turned around. NULL if none is, and with AS_GIVEN. */
    const bool *turned;
} cscd_patches;

/* The surface that two bodies bury of each other, or one of itself, up to rounding. Where surfaces lie on
 * each other, either of the two areas may count. */
typedef struct cscd_overlap {
    uint32_t a, b; /* bodies; a <= b */
    double area_a; /* of the surface of a within b; with a = b, of a within itself */
    double area_b; /* of the surface of b within a; with a = b, the inverted surface of a */

    /* The volume that both contain; with a = b, that a contains twice or more. Only closed components count.
     * What one body contains twice counts once, but twice if its object is not looked at with itself. NaN if
     * pairs on a curve between closed components are left out (ignored, waiting, seams whose vertices are
     * apart). The volume is wrong, without notice, where inactive triangles (cscd_detector_set_active)
     * cross. */
    double volume;
} cscd_overlap;

/* The overlaps that are not 0, or whose volume is unknown, sorted by (a, b). */
typedef struct cscd_overlaps {
    const cscd_overlap *items;
    size_t count;
} cscd_overlaps;

/* ==== What curves cut off =================================================================================== */

/* Where a curve divides an open surface, the smaller part has most likely come through, and a solver draws it
 * back (D. Baraff, A. Witkin, M. Kass, Untangling Cloth, ACM Transactions on Graphics 22, 2003). */

/* A trace of a curve. */
typedef enum cscd_curve_trace {
    CSCD_TRACE_FIRST,  /* on the first sheet */
    CSCD_TRACE_SECOND, /* on the second sheet */
    CSCD_TRACE_BOTH,   /* both as one: they join where the curve ends at vertices, or it is swapped */
    CSCD_TRACE_MAX_ENUM = 0x7fffffff
} cscd_curve_trace;

/* A trace that divides an open component in two. It is closed, or runs from border to border. */
typedef struct cscd_cut_off {
    size_t curve;
    cscd_curve_trace trace;
    uint32_t component, object; /* that it divides */
    uint32_t reserved;          /* 0 */
    double area;                /* of the smaller part, which is cut off */
    double rest;                /* of the other part, not less, up to rounding */

    /* Its range in `patches`; empty if the smaller part lies within triangles. */
    size_t first_patch, patch_count;
} cscd_cut_off;

/* Sorted by (curve, trace). Components are those of the mesh as created: a trace over a seam divides nothing,
 * and a seam alone joins nothing. */
typedef struct cscd_cut_offs {
    const cscd_cut_off *items;
    size_t count;
    const uint32_t *patches; /* of the smaller parts, ascending in each range */
    size_t patch_count;
} cscd_cut_offs;

/* ==== Depths ================================================================================================ */

/* A point of the mesh that a body contains, and the nearest point of that body's outer surface: its closed
 * components except what the body contains itself. The bodies may have to move much farther to be apart. The
 * depth is above 0 exactly where the point lies within the body, not on its surface. */
typedef struct cscd_depth {
    uint32_t vertex; /* UINT32_MAX: the point is on an edge or face */
    uint32_t edge;   /* UINT32_MAX: the point is a vertex or on a face */
    uint32_t face;   /* a triangle with the point; the first one of a vertex or edge */

    /* The patch of the point; UINT32_MAX for an edge, a vertex at which curves end, and a face without a
     * corner in the body. */
    uint32_t patch;

    uint32_t body;     /* contains the point */
    uint32_t triangle; /* of that body: the first with the nearest point */
    double s;          /* on the edge (e0, e1) the point is (1-s) e0 + s e1 */
    double depth;      /* up to rounding */

    /* No point of the surface that a face stands for (cscd_depths) is deeper. The bound is at least the
     * depth, and at most 1 %, or a billionth of the largest coordinate, above it, unless depth_limit ends the
     * search. For vertices and edges it is the depth. */
    double bound;
    double x[3]; /* the point */

    /* A unit vector: x + depth * direction is the nearest point. At depth 0 it is the normal, or 0 if there
     * is none. */
    double direction[3];
} cscd_depth;

/* The deepest point of a patch in one body. */
typedef struct cscd_patch_depth {
    uint32_t patch, body;
    size_t deepest; /* its index in the list of depths; one of a face */
} cscd_patch_depth;

/* Three lists, one behind the other:
 *   vertices  all that a body contains, once for each such body, sorted by (vertex, body)
 *   edges     the deepest points of edges that a body contains between two of its curves, to a millionth of
 *             the edge, sorted by (edge, body)
 *   faces     the deepest points of the surface: one for each patch, body that contains it and part that has
 *             triangles of it, sorted by these; then one for each triangle that a body contains in part, but
 *             no corner of it, sorted by (face, body)
 * No point of the surface is deeper than the greatest bound of the faces. */
typedef struct cscd_depths {
    const cscd_depth *items;
    size_t count;                    /* of all three */
    size_t vertex_count, edge_count; /* of the first two lists */
    const cscd_patch_depth *patches; /* sorted by (patch, body) */
    size_t patch_count;
} cscd_depths;

/* ==== Parts ================================================================================================= */

/* Sets which part each triangle is in, by one label for each, from the next call on. A label is below
 * part_count, which is 1 or more, or UINT32_MAX for none. NULL and 0, as at first: the objects are the parts.
 * Parts do not change which pairs and curves are found; with part_bodies they change the bodies
 * (cscd_winding). INVALID_ARGUMENT: a label is too large.
 *
 * A vertex or an edge is in the part of its first triangle. Without a triangle (wires, points, half-spaces)
 * it is in the part of its object if objects are the parts, else in none. Sums have what is in no part as the
 * part UINT32_MAX, which comes last. After cscd_detector_change_mesh each triangle has the label of its
 * origin, or none. A clone has the labels of its original. */
CSCD_API cscd_status cscd_detector_set_parts(cscd_detector *detector, const uint32_t *labels,
                                             uint32_t part_count);

/* Sets the labels that part_bodies and CSCD_ORIENTATION_BY_PART use instead of the parts; the rules are those
 * of cscd_detector_set_parts. So parts can be materials, and yet a ball in a slab of the same material is a
 * body of its own. NULL and 0, as at first: the parts are used. */
CSCD_API cscd_status cscd_detector_set_bodies(cscd_detector *detector, const uint32_t *labels,
                                              uint32_t label_count);

/* Writes for each triangle its body with the option part_bodies, and returns the number of bodies. The bodies
 * are in the order of their objects; an object without triangles has one. A component that may be a cavity
 * has a body of its own here. labels may be NULL. */
CSCD_API uint32_t cscd_detector_body_labels(const cscd_detector *detector, uint32_t *labels);

/* ---- intersections ------------------------------------------------------------------------------------- */

/* The findings of cscd_detector_find_intersections about two parts, or of one with itself. Curves and depths
 * count if the options ask for them. */
typedef struct cscd_part_pair {
    uint32_t a, b; /* parts; a <= b */

    /* The number of pairs of each kind, the number of triangles of a and of b in them, and their shares of
     * all triangles of a and of b. With a = b both numbers are the same. */
    size_t crossing, coplanar, folded, duplicate, touching;
    size_t faces[2];
    double shares[2];

    /* The number of curves with pieces in these pairs, the number of touching ones, and the length of the
     * pieces here. */
    size_t curves, touching_curves;
    double length;

    /* The deepest point of one part whose nearest point is on the other: its index in the list of depths, of
     * several the first, and its depth; SIZE_MAX and 0 if there is none. No point of the two is deeper than
     * the bound. Between limbs of one body the parts need not intersect, and both numbers are those of listed
     * points. */
    size_t deepest;
    double depth, bound;

    /* The two are copies of one solid, so the depth is 0 although they contain the same. Interiors meet where
     * depth is above 0 or this is true. Known only with depths. */
    bool same_solid;

    /* For a part with itself: something of it lies within another body than its own. Known only with
     * depths. */
    bool in_other_body;
    uint8_t reserved[6];
} cscd_part_pair;

/* All pairs of parts with a pair of triangles, piece of a curve or depth, sorted by (a, b). Each of these
 * counts in one pair of parts. */
typedef struct cscd_part_pairs {
    const cscd_part_pair *items;
    size_t count;

    /* The number of triangles in listed pairs, and their share of all triangles, 0 if there are none. */
    size_t faces;
    double share;
} cscd_part_pairs;

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* The contacts of two parts, or of one with itself. */
typedef struct cscd_contact_part_pair {
    uint32_t a, b;   /* parts; a <= b */
    size_t count;    /* of contacts */
    size_t earliest; /* the first with the least toi, an index in the given list */
    double toi;      /* its time */
} cscd_contact_part_pair;

/* All pairs of parts with a contact, sorted by (a, b). The list lives until the detector's next call. */
typedef struct cscd_contact_part_pairs {
    const cscd_contact_part_pair *items;
    size_t count;
} cscd_contact_part_pairs;

/* Sums up contacts by pair of parts. The contacts are a list of a step or a line search, or any selection
 * from it, in any order. Lists that earlier calls gave out stay. INVALID_ARGUMENT: a contact is not of this
 * mesh. An example, how the upper sheet meets both halves of the lower one, which prints "0 and 2: 35
 * contacts; 1 and 2: 37 contacts":
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

/* Intersections by kind, decided exactly. Two triangles that have an area *cross* if they meet without their
 * edges, and not in one plane. They *share area* if they meet so in one plane. All others that meet touch.
 * Neighbours are a pair only if they meet away from what both have. A collapsed component intersects nothing
 * (cscd_detector_collapsed).
 *
 * *Shared vertices*, 0 to 3, are those that both triangles have by index or by seams. Vertices that are
 * merely at one place are not shared. Where seams unite vertices that are apart, the kind goes by where the
 * corners are, and a duplicate needs each two of them at one place. docs/theory/static-check.md has the
 * proofs, and a drawing of each kind. */

/* The way in which two triangles intersect. A pair has exactly one kind. */
typedef enum cscd_intersection_kind {
    CSCD_INTERSECTION_CROSSING,  /* they cross */
    CSCD_INTERSECTION_COPLANAR,  /* they share area in one plane, and no vertex */
    CSCD_INTERSECTION_FOLDED,    /* they share area in one plane, and one or two vertices */
    CSCD_INTERSECTION_DUPLICATE, /* they share all three vertices, and have an area */
    CSCD_INTERSECTION_TOUCHING,  /* they meet otherwise, or one has no area */
    CSCD_INTERSECTION_KIND_MAX_ENUM = 0x7fffffff
} cscd_intersection_kind;

/* Returns the name of a kind. */
static inline const char *cscd_intersection_kind_name(cscd_intersection_kind kind) {
    return cscd_name(CSCD_INTERSECTION_KINDS, kind);
}

/* Returns the set that has one kind. Sets are joined by |. */
static inline uint64_t cscd_intersection_set(cscd_intersection_kind kind) {
    return UINT64_C(1) << kind;
}

/* The answer that the caller asks for. */
typedef enum cscd_intersection_answer {
    CSCD_ANSWER_LIST,  /* the pairs */
    CSCD_ANSWER_COUNT, /* the number of each kind, whatever longest_list is */
    CSCD_ANSWER_ANY,   /* whether there is one; the search ends at the first */
    CSCD_ANSWER_MAX_ENUM = 0x7fffffff
} cscd_intersection_answer;

/* The closed components that are taken as turned around (cscd_patches), for patches, overlaps and depths. */
typedef enum cscd_orientation {
    CSCD_ORIENTATION_BY_OBJECT, /* cavities are found within an object */
    CSCD_ORIENTATION_BY_PART,   /* cavities are found within an object and a part (cscd_patches) */
    CSCD_ORIENTATION_AS_GIVEN,  /* no component; what is inside out contains nothing */
    CSCD_ORIENTATION_MAX_ENUM = 0x7fffffff
} cscd_orientation;

/* Options of cscd_detector_find_intersections. */
typedef struct cscd_intersection_options {
    uint32_t struct_size;            /* set by cscd_intersection_defaults */
    cscd_intersection_answer answer; /* LIST by default */

    /* Ends the search at this many pairs that count; 0, the default: never. Which pairs these are depends on
     * the positions that the detector has seen, not on the number of threads. */
    size_t stop_after;

    uint64_t kinds; /* those that count; UINT64_MAX, all, by default */

    /* Further answers, false by default. INVALID_ARGUMENT without the answer LIST, with fewer kinds and with
     * stop_after. Patches, overlaps and depths bring curves; overlaps and depths bring patches. */
    bool curves;   /* where surfaces pass through each other */
    bool patches;  /* what curves cut them into, and what buries these */
    bool overlaps; /* areas and volumes of what bodies bury */
    bool depths;   /* how deep it lies */

    /* Sums by pair of parts; false by default. INVALID_ARGUMENT without the answer LIST. */
    bool parts;

    bool cut_offs;    /* what curves cut off of open surfaces; as depths, it brings patches */
    bool part_bodies; /* parts are bodies (cscd_winding); false by default */
    uint8_t reserved[4];
    cscd_orientation orientation; /* BY_OBJECT by default */

    /* For a gate, 0 or more: the search for each deepest point of faces ends when its depth is above this, or
     * its bound is not. INFINITY, the default: it ends at 1 %. */
    double depth_limit;

    /* The most bytes for what is found besides the pairs; 0, the default: a quarter of the memory that was
     * free at the detector's first such call. What does not fit is left out (cscd_left_out), the same for any
     * number of threads; the rest is as without a limit. If the pairs alone, up to 64 bytes each, exceed the
     * limit, as with vertices in the wrong order, the call fails with LIST_TOO_LONG. */
    size_t max_memory;

    /* The most work that depths may take, in comparisons of a point with a part of a triangle; 0, the
     * default: 2^28, some ten seconds. The work is estimated beforehand, and depths that would take more are
     * left out. */
    uint64_t max_work;
} cscd_intersection_options;

/* The answers that a call may leave out for max_memory or max_work. */
typedef enum cscd_left_out {
    CSCD_LEFT_OUT_PAIRS, /* not in a list, but counted */
    CSCD_LEFT_OUT_CURVES,
    CSCD_LEFT_OUT_PATCHES,
    CSCD_LEFT_OUT_OVERLAPS,
    CSCD_LEFT_OUT_CUT_OFFS,
    CSCD_LEFT_OUT_DEPTHS, /* then `touching` of curves is unknown */
    CSCD_LEFT_OUT_PARTS,
    CSCD_LEFT_OUT_MAX_ENUM = 0x7fffffff
} cscd_left_out;

/* Returns the default options. */
CSCD_API void cscd_intersection_defaults_sized(cscd_intersection_options *out, size_t size);
static inline cscd_intersection_options cscd_intersection_defaults(void) {
    cscd_intersection_options options;
    cscd_intersection_defaults_sized(&options, sizeof options);
    return options;
}

/* Two triangles a < b that intersect. */
typedef struct cscd_intersection {
    uint32_t a, b;
    cscd_intersection_kind kind;
    uint32_t shared;                    /* the number of shared vertices */
    uint32_t components[2], objects[2]; /* those of a, then those of b */
} cscd_intersection;

/* The pairs of the kinds that count, sorted by (a, b). The list lives until the detector's next call. */
typedef struct cscd_intersections {
    const cscd_intersection *items;                         /* NULL, unless the answer is LIST */
    size_t count;                                           /* for ANY 1 or 0: yes or no */
    size_t crossing, coplanar, folded, duplicate, touching; /* the number of each kind; for ANY all 0 */
    uint32_t zero_area_triangles;                           /* triangles with all corners on one line */
    uint32_t first_zero_area; /* the first of them; UINT32_MAX if there is none */
    uint32_t collapsed;       /* the number of collapsed components: see cscd_detector_collapsed */
    bool stopped;             /* the search has ended early, so there may be more pairs */
    uint8_t reserved[3];

    /* The answers that the options ask for, else NULL; each lives as long as the list. */
    const cscd_curves *curves;
    const cscd_patches *patches;
    const cscd_overlaps *overlaps;
    const cscd_depths *depths;
    const cscd_cut_offs *cut_offs;
    const cscd_part_pairs *parts;

    const uint32_t *collapsed_components; /* `collapsed` of them, ascending; NULL if there are none */

    /* The answers that did not fit max_memory or max_work and are NULL: (uint64_t)1 << CSCD_LEFT_OUT_CURVES
     * and so on, joined by |. */
    uint64_t left_out;

    /* The max_memory with which the first of these would have gone on; it may then need more. 0 if work was
     * the limit. */
    size_t wanted_memory;

    /* An estimate of the max_work that depths need; 0 if memory was the limit. */
    uint64_t wanted_work;
} cscd_intersections;

/* Lists exactly the triangle pairs that intersect or touch at the given positions, and how
 * (docs/theory/static-check.md); of points, wires and half-spaces it says nothing. options may be NULL. Pairs
 * are left out as docs/solver/guarantees.md says, but a duplicate with the same three indices never waits.
 * Unless the answer is ANY or stop_after is set, a step that starts here need not check the positions again.
 * Of the timings only check_ms changes; counters stay. docs/solver/surfaces.md has a program.
 *
 * INVALID_ARGUMENT: no kind counts, or an option is out of its range. LIST_TOO_LONG: the list would be longer
 * than longest_list, or than fits max_memory; *out then counts all pairs, whatever stop_after is, and has no
 * lists. CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_detector_find_intersections(cscd_detector *detector, const cscd_view *positions,
                                                      const cscd_intersection_options *options,
                                                      cscd_intersections *out);

/* Calls cscd_detector_find_intersections with the default options. */
static inline cscd_status cscd_detector_check(cscd_detector *detector, const cscd_view *positions,
                                              cscd_intersections *out) {
    return cscd_detector_find_intersections(detector, positions, NULL, out);
}

/* ==== Volumes and lengths with their gradients ============================================================== */

/* Energies for solvers and training loops that start where bodies are in each other. docs/solver/surfaces.md has a
 * program, docs/theory/curves.md the proofs. */

/* The derivatives by the three coordinates of a vertex. */
typedef struct cscd_vertex_gradient {
    uint32_t vertex;
    uint32_t reserved; /* 0 */
    double gradient[3];
} cscd_vertex_gradient;

/* A measure of two bodies (cscd_winding), or of one with itself. */
typedef struct cscd_measure {
    uint32_t a, b; /* a <= b */
    double value;  /* NaN: unknown, and there is no gradient */

    /* Its range of gradients, by ascending vertex. Other vertices have the derivative 0. */
    size_t first_gradient, gradient_count;
} cscd_measure;

/* A measure of all pairs of bodies, sorted by (a, b). Other pairs have the value 0. The lists live until the
 * detector's next call. */
typedef struct cscd_measures {
    const cscd_measure *items;
    size_t count;
    const cscd_vertex_gradient *gradients;
    size_t gradient_count;
    double sum;     /* of the known values */
    size_t unknown; /* the number of those that are unknown */
} cscd_measures;

/* Adds weight times the gradient of all known values to `gradient`, three numbers for each vertex. */
static inline void cscd_measures_add(const cscd_measures *measures, double weight, double *gradient) {
    for (size_t i = 0; i < measures->gradient_count; i++) {
        const cscd_vertex_gradient *from = &measures->gradients[i];
        const size_t first = from->vertex;
        for (size_t k = 0; k < 3; k++) gradient[3 * first + k] += weight * from->gradient[k];
    }
}

/* Finds the volumes that bodies have in common, and their gradients. Of two bodies it is the volume that both
 * contain. Of one with itself it is the integral of (winding number - 1) where that is above 1, so what lies
 * in it three times counts twice. Only closed components count (cscd_overlap): the value is NaN where an open
 * one crosses the other body or has a patch in it, and where pairs on a curve are left out.
 *
 * The gradient at a vertex is the integral of its hat function times the outward normal over the surface that
 * bounds the volume. It is continuous, except where orientations or pairs to leave out change, and where
 * surfaces lie on each other. Of the options, which may be NULL, part_bodies, orientation and max_memory
 * count. INVALID_ARGUMENT: there are inactive triangles, or an option asks for fewer pairs. LIST_TOO_LONG:
 * max_memory, or longest_list. All else is as for cscd_detector_find_intersections. */
CSCD_API cscd_status cscd_detector_overlap_volumes(cscd_detector *detector, const cscd_view *positions,
                                                   const cscd_intersection_options *options,
                                                   cscd_measures *out);

/* Finds the lengths of the intersection curves between bodies, open ones included, and their gradients. Each
 * piece of a curve counts for the bodies of its two triangles; with part_bodies these are those of
 * cscd_detector_body_labels. A length is continuous, and its gradient has kinks where a curve passes over an
 * edge (Volino and Magnenat-Thalmann 2006 move cloth by it). Where an edge lies in the plane of a triangle on
 * the curve there is no derivative: its point counts as going with the edge. Options and statuses are those of
 * cscd_detector_overlap_volumes, but inactive triangles are allowed. */
CSCD_API cscd_status cscd_detector_curve_lengths(cscd_detector *detector, const cscd_view *positions,
                                                 const cscd_intersection_options *options,
                                                 cscd_measures *out);

#ifdef __cplusplus
}
#endif

#endif
