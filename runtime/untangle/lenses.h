/* Which side of each curve is wrong, and where on the other sheet each wrong point belongs. */
#pragma once

#include "runtime/untangle/triangle_set.h"
#include "runtime/untangle/untangle.h"

/* A point of a surface that is to come to a place of another sheet. */
typedef struct lens_point {
    uint32_t vertices[5]; /* of a vertex, twice, or of an edge; then of the triangle with the place */
    double weights
        [5]; /* the vector from the place to the point is their sum: the first two add up to 1, the others to -1 */
    double direction[3]; /* a unit vector, in which the point goes */
    double thickness;    /* how far */
    bool along_normal;   /* the direction is a normal, and no way to the place */
    cscd_lens_reason reason;
    uint32_t group; /* its patch; of an edge its curve; UINT32_MAX for pairs that no curve leads through */
    uint32_t edge;  /* UINT32_MAX: of a vertex */
    uint32_t triangle;
} lens_point;

/* A number of a patch: of a vertex, a curve or another patch. Sorted by patch, then by number. */
typedef struct patch_entry {
    uint64_t key; /* the patch in the upper half */
} patch_entry;

static inline uint32_t entry_patch(patch_entry e) {
    return (uint32_t)(e.key >> 32);
}

static inline uint32_t entry_number(patch_entry e) {
    return (uint32_t)e.key;
}

/* The lists of entries: wrong vertices by patch, curves by patch, patches by patch; curves that bound points. */
enum { OF_VERTICES, OF_CURVES, OF_PARTNERS, DECIDED, LISTS };

/* What is found at one moment; begins with the work, and nothing else set. */
typedef struct lens_finder {
    untangle_work *w;
    uint32_t *
        patches; /* per vertex: connected by edges that no curve crosses; the number is a vertex's at first */
    bool *wrong; /* per vertex */
    uint8_t *reasons; /* per vertex that is wrong: a cscd_lens_reason */
    bool *folded;     /* per vertex: its patch is half of one */
    int8_t *sides;    /* per vertex: 1 in a body, -1 where a body winds around it less than 0 times, else 0 */
    const bool *turned;  /* per component: it is taken as turned around; NULL: none */
    uint32_t *crossings; /* per edge: how many curve points it has */
    uint32_t *stamps;    /* per triangle */
    uint32_t *queue;     /* per vertex or triangle */
    double *areas;       /* per vertex: of the patch with this number */
    uint32_t *colours;   /* per vertex: of the patch with this number */
    uint32_t *distances; /* per vertex: to a trace */
    uint32_t stamp;
    uint32_t next_patch;
    triangle_set set;
    patch_entry *entries[LISTS]; /* wrong vertices, curves and partners of patches, sorted */
    size_t entry_counts[LISTS], entry_capacities[LISTS];
    uint32_t *triangles;
    size_t triangle_count, triangle_capacity;
    lens_point *points;
    size_t point_count, point_capacity;
    double thickness; /* of the thickest */
    size_t wrong_count;
    size_t undecided; /* curves that bound no point */
} lens_finder;

bool lens_finder_make(lens_finder *f, untangle_work *w);
void lens_finder_free(lens_finder *f);

/* How points are found. */
typedef struct lens_rules {
    uint32_t rings; /* by which the other sheet is widened along curves */
    bool
        along_axis; /* points go along the axis of their patch, where it has one, rather than to the nearest place */
} lens_rules;

/* Finds the points; the surface is at x, and `found` has its curves and patches. */
cscd_status lenses_find(lens_finder *f, const cscd_intersections *found, const double *x,
                        const lens_rules *rules);

/* ---- steps ------------------------------------------------------------------------------------------------ */

/* Halves the wrong patches that both traces of a curve bound, as those of skin that is folded through itself: patches at the first
 * trace, and new ones at the second. */
void lens_folds_halve(lens_finder *f, const cscd_curves *curves);

/* Lists for each wrong patch its vertices, and its curves, twice the number plus the sheet. False: no memory. */
bool lens_patches_list(lens_finder *f, const cscd_curves *curves);

/* Chooses the triangles in which the points of a patch look for their places: along its curves, those of the other sheets, and the
 * wrong patches there; but none with a corner in the patch. False: no memory. */
bool lens_triangles_choose(lens_finder *f, const cscd_curves *curves, uint32_t patch, uint32_t rings);

/* Adds the points of a patch, whose vertices are entries from `first` on before `end`. False: no memory. */
bool lens_points_add(lens_finder *f, const cscd_curves *curves, const double *x, const lens_rules *rules,
                     size_t first, size_t end);

/* Adds the points of edges that pass through another sheet and back. False: no memory. */
bool lens_edges_add(lens_finder *f, const cscd_curves *curves, const double *x);

/* Adds the points of pairs that no curve leads through. False: no memory. */
bool flush_pairs_add(lens_finder *f, const cscd_intersections *found, const double *x);

/* ---- what they share --------------------------------------------------------------------------------------- */

/* The triangle of a piece on one of the two sheets. */
static inline uint32_t curve_piece_triangle(const cscd_curves *curves, size_t piece, int sheet) {
    return sheet == 0 ? curves->pieces[piece].a : curves->pieces[piece].b;
}

/* The vector area of a patch, which depends on its border alone, as a unit vector, if it is large enough to mean something.
 * *closed: its last triangle is of a closed component. */
bool lens_vector_area(const lens_finder *f, const double *x, uint32_t patch, bool *closed, double out[3]);

/* The outward unit normal of a triangle; 0 if it has no area. */
void lens_normal(const lens_finder *f, const double *x, uint32_t triangle, double out[3]);

/* Writes the place, and the way there from a point at `from`. The way out of a closed component leads along its normals, and from
 * where it is inside out against them; side is that of the point. */
void lens_take_place(const lens_finder *f, const double *x, const double *from, const set_place *place,
                     int side, lens_point *out);

/* ---- lists of a finder --------------------------------------------------------------------------------- */

/* Adds to one of its lists of entries. False: no memory. */
bool lens_finder_add(lens_finder *f, int list, uint32_t patch, uint32_t number);

/* Sorts a list. False: no memory. */
bool lens_finder_sort(lens_finder *f, int list);

/* Keeps one of entries in a sorted list that are the same. */
void lens_finder_unify(lens_finder *f, int list);

/* The first entry of a patch in a sorted list. */
size_t lens_finder_first(const lens_finder *f, int list, uint32_t patch);

/* Adds a point; false: no memory. */
bool lens_finder_add_point(lens_finder *f, const lens_point *point);

/* Lists triangles, each once: begins, adds one, and adds those around all that are there. False: no memory. */
void lens_triangles_begin(lens_finder *f);
bool lens_triangles_add(lens_finder *f, uint32_t triangle);
bool lens_triangles_widen(lens_finder *f, uint32_t rings);
