/* Intersections by kind: which pairs of triangles cross at one moment, which lie on each other in a plane, which only
 * touch. Part of cscd/cscd.h, which says what holds for every function.
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
#ifndef CSCD_INTERSECTIONS_API_H
#define CSCD_INTERSECTIONS_API_H

#include <cscd/cut_offs.h>
#include <cscd/depths.h>
#include <cscd/parts.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How two triangles intersect. A pair has exactly one kind. Later versions may add values. */
typedef enum cscd_intersection_kind {
    CSCD_INTERSECTION_CROSSING,  /* they cross */
    CSCD_INTERSECTION_COPLANAR,  /* they share area in one plane, and no vertex */
    CSCD_INTERSECTION_FOLDED,    /* they share area in one plane, and one or two vertices */
    CSCD_INTERSECTION_DUPLICATE, /* they share all three vertices, and have an area */
    CSCD_INTERSECTION_TOUCHING,  /* they meet otherwise, or one has no area */
    CSCD_INTERSECTION_KIND_MAX_ENUM = 0x7fffffff
} cscd_intersection_kind;

/* The names are "crossing", "coplanar", "folded", "duplicate" and "touching"; static storage, never NULL. */
CSCD_API const char *cscd_intersection_kind_name(cscd_intersection_kind kind);

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
 * the rule that cscd/patches.h gives. It matters for patches, overlaps and depths. Later versions may add values. */
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
    bool curves;   /* where surfaces pass through each other: cscd/curves.h */
    bool patches;  /* what curves cut them into, and what these are buried in: cscd/patches.h */
    bool overlaps; /* areas and volumes of what objects bury: cscd/patches.h */
    bool depths;   /* how deep: cscd/depths.h */

    /* What is found summed up by pair of parts: cscd/parts.h. Needs the answer LIST, of any pairs; INVALID_ARGUMENT with
     * another one. false by default. */
    bool parts;

    /* false by default, too. */
    bool
        cut_offs; /* what curves cut off of open surfaces: cscd/cut_offs.h. Needs patches, which are then given, too */
    bool part_bodies; /* parts, and components of no part, are bodies: cscd/patches.h */
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

/* The names are "pairs", "curves", "patches", "overlaps", "cut-offs", "depths" and "parts"; static storage,
 * never NULL. */
CSCD_API const char *cscd_left_out_name(cscd_left_out answer);

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
