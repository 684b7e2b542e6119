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

/* What is found at one moment; begins with the work, and nothing else set. */
typedef struct lens_finder {
    untangle_work *w;
    uint32_t *
        patches; /* per vertex: connected by edges that no curve crosses; the number is a vertex's at first */
    bool *wrong; /* per vertex */
    int8_t *sides; /* per vertex: 1 in a body, -1 where a body winds around it less than 0 times, else 0 */
    uint32_t *crossings; /* per edge: how many curve points it has */
    uint32_t *stamps;    /* per triangle */
    uint32_t *queue;     /* per vertex or triangle */
    double *areas;       /* per vertex: of the patch with this number */
    uint32_t *colours;   /* per vertex: of the patch with this number */
    uint32_t *distances; /* per vertex: to a trace */
    uint32_t stamp;
    uint32_t next_patch;
    triangle_set set;
    patch_entry *entries[3]; /* wrong vertices, curves and partners of patches, sorted */
    size_t entry_counts[3], entry_capacities[3];
    uint32_t *triangles;
    size_t triangle_count, triangle_capacity;
    lens_point *points;
    size_t point_count, point_capacity;
    double thickness; /* of the thickest */
    size_t wrong_count;
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

/* Adds the points of pairs that no curve leads through. False: no memory. */
bool flush_pairs_add(lens_finder *f, const cscd_intersections *found, const double *x);

/* Adds a point; false: no memory. */
bool lens_finder_add_point(lens_finder *f, const lens_point *point);

/* The unit normal of a triangle; 0 if it has no area. */
void lens_normal(const lens_finder *f, const double *x, uint32_t triangle, double out[3]);

/* ---- lists of a finder --------------------------------------------------------------------------------- */

/* Adds to one of its lists of entries. False: no memory. */
bool lens_finder_add(lens_finder *f, int list, uint32_t patch, uint32_t number);

/* Sorts a list. False: no memory. */
bool lens_finder_sort(lens_finder *f, int list);

/* The first entry of a patch in a sorted list. */
size_t lens_finder_first(const lens_finder *f, int list, uint32_t patch);
