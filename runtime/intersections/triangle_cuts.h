/* What curves cut out of each triangle: from the pieces of all curves to the lines in one triangle's plane. */
#pragma once

#include "runtime/intersections/curves.h"
#include "runtime/intersections/cut_triangle.h"
#include "runtime/intersections/patches.h"
#include "src/core/memory_budget.h"

/* What has been found at one moment. */
typedef struct surface_cuts {
    const named_surface *surface;
    const curve_joiner *curves;
    const patch_finder *patches;
    memory_budget *budget; /* of whatever is found further; NULL: there is no limit */
} surface_cuts;

/* A triangle that curves cut, in the projection along an axis. */
typedef struct loaded_cut {
    uint32_t triangle;
    int x, y;       /* its coordinates; slabs follow each other along x, which is where few lines overlap */
    double turn;    /* 1 or -1: y counts with this sign, so that the triangle turns counter-clockwise */
    double stretch; /* an area over that of its projection */
    cut_triangle cut;
    const uint32_t *slot_bodies; /* slot 0 is the triangle's own */
    const uint32_t *line_pieces; /* per line, by its number: the piece found */
} loaded_cut;

/* The memory of all calls, and the pieces sorted by their triangles. */
typedef struct triangle_cuts {
    cscd_context *context;
    curve_key *keys, *spare_keys; /* number: a triangle; end: 2 piece, plus 1 if the triangle is its b */
    size_t key_count, key_capacity;
    cut_line *lines;
    cut_border *borders, *spare_borders; /* spare ones are for whoever loads */
    int32_t *corner_numbers;
    uint32_t *slot_bodies, *line_pieces;
    size_t cut_capacity; /* of these six; of corner_numbers three times as much */
    cut_memory memory;
} triangle_cuts;

void triangle_cuts_free(triangle_cuts *c);

/* Sorts the pieces that were found. False: no memory, here and below, or what is needed for the triangles does not fit the
 * budget. */
bool triangle_cuts_sort(triangle_cuts *c, const surface_cuts *found);

/* The keys of a triangle: from *first to before the returned one. */
size_t triangle_cuts_of(const triangle_cuts *c, uint32_t triangle, size_t *first);

/* Sets the projection of a triangle with this normal, and its corners. exchanged: x for y. */
void loaded_cut_project(const named_surface *s, const double normal[3], bool exchanged, loaded_cut *out);

/* A point in that projection. */
void loaded_cut_point(const loaded_cut *cut, const double x[3], double out[2]);

/* From that projection back to the plane of the triangle, which has an area. */
typedef struct cut_lift {
    const loaded_cut *cut;
    double normal[3], corner[3];
} cut_lift;

cut_lift cut_lift_of(const named_surface *s, const loaded_cut *cut);

/* The two triangles of a part. */
void cut_lift_part(const cut_lift *lift, const cut_part *part, double a[3][3], double b[3][3]);

/* Sorts the borders as cut_triangle.h asks; spare has room for as many. */
void loaded_cut_sort_borders(loaded_cut *cut, cut_border *spare);

/* Loads the triangle of these keys, which lives until the next one is loaded. A triangle without area has stretch 0, and
 * nothing else of it is set. */
bool triangle_cuts_load(triangle_cuts *c, const surface_cuts *found, size_t first, size_t end,
                        loaded_cut *out);
