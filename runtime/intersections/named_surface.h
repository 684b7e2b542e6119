/* The surface at one moment, as the files of this room share it: pieces of curves, winding numbers, and cut
 * triangles. */
#pragma once

#include "runtime/intersections/intersections.h"
#include "src/mesh/predicates.h"

static inline symbolic_point surface_point(const named_surface *s, uint32_t vertex) {
    return (symbolic_point){s->positions + (size_t)vertex * 3, surface_name(s, vertex)};
}

/* ---- pieces of curves ---------------------------------------------------------------------------------- */

/* Finds the piece of two different triangles, if there is one: docs/theory/curves.md. */
bool curve_piece_of_pair(const named_surface *s, uint32_t a, uint32_t b, curve_piece *out);

/* Whether a piercing that is not at a vertex happens, and is an end of pieces. */
bool surface_piercing_happens(const named_surface *s, surface_piercing piercing);

/* The point where an edge passes through a triangle, in the limit of a symbolic perturbation that goes to 0. */
typedef struct piercing_point {
    double s;    /* the point is (1-s) e0 + s e1 on the edge (e0, e1) */
    double u, v; /* and (1-u-v) p0 + u p1 + v p2 on the triangle */
    double x[3];
} piercing_point;

/* The piercing happens. Each number is rounded once, to nearest, from its exact value. An end at a vertex has the parameters 0. */
void piercing_point_find(const named_surface *s, surface_piercing piercing, piercing_point *out);

/* The same, by integers alone. */
void piercing_point_find_exactly(const named_surface *s, surface_piercing piercing, piercing_point *out);

/* The same without integers, where rounding is certain. p: the edge's points, then the triangle's, of a piercing that happens.
 * False: a determinant may be 0, or a result lies too near to the middle between two doubles; nothing is known then. */
bool rounded_point_find(const double *const p[5], piercing_point *out);

/* ---- winding numbers ----------------------------------------------------------------------------------- */

static inline bool component_box_has_point(const component_box *box, const double x[3]) {
    for (int k = 0; k < 3; k++) {
        if (x[k] < box->low[k] || x[k] > box->high[k]) return false;
    }
    return true;
}

/* A point infinitely near to a corner of a triangle: from the corner along one of its edges, then, infinitely less, into the
 * triangle and, infinitely less, off it to its outer side: that of its normal, unless its component is turned around. */
typedef struct corner_side {
    uint32_t triangle;
    uint8_t corner; /* 0 to 2 */
    bool next;      /* the edge leads to the next corner, else to the one before */
} corner_side;

void winding_tally_clear(winding_tally *tally);

/* Whether the triangle has two corners of one name. Then nothing is to its sides. */
bool winding_is_collapsed(const named_surface *s, uint32_t triangle);

/* Adds the winding numbers of all bodies at the point, none at a collapsed triangle: of a body the sum over its closed manifold
 * components. A body winds once around what its surfaces, with normals outwards, enclose. Those of components that are turned
 * around count as turned. The bounds of the trees are those of the surface's positions. Theory: docs/theory/curves.md, lemma 5. */
void winding_find(const named_surface *s, const bvh *hierarchy, corner_side at, winding_tally *tally);

/* The same of each component, in a tally that has room for all components. */
void winding_find_by_component(const named_surface *s, const bvh *hierarchy, corner_side at,
                               winding_tally *tally);

/* ---- patches ------------------------------------------------------------------------------------------- */

/* The node that an edge has at its vertex: the same number for what no curve parts. */
uint32_t patch_node(const patch_finder *p, uint32_t edge, uint32_t vertex);

/* Whether two bodies, or a body and itself, are looked at with each other. Their objects say. */
bool patch_bodies_look(const patch_finder *p, uint32_t a, uint32_t b);

/* Returns how often a body contains a place with this winding number. A body that is compared with itself
 * contains everything just once. For another body it is unknown where it buries itself, so its numbers count
 * as they are. */
double patch_times_within(const patch_finder *p, uint32_t body, int32_t number);

/* ---- gaps of overlaps ------------------------------------------------------------------------------------- */

/* The key of two bodies: the smaller one in the upper half. */
static inline uint64_t key_of_bodies(uint32_t a, uint32_t b) {
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

/* The body of one of the two sheets of a curve. */
static inline uint32_t curve_body(const named_surface *s, const cscd_curve *c, int k) {
    return s->bodies != NULL && s->bodies->components != NULL ? s->bodies->components[c->components[k]]
                                                              : c->objects[k];
}

/* The overlaps that have no volume, because a curve that bounds them is left out, wholly or in part: found by
 * the pairs of triangles that are left out although they carry a piece, and by curves that end where one is
 * missing. Begins with nothing but the context set. */
typedef struct overlap_gaps {
    cscd_context *context;
    uint64_t *bodies, *spare; /* keys of bodies, ascending */
    size_t count, capacity;
} overlap_gaps;

void overlap_gaps_free(overlap_gaps *g);

/* Finds the pairs of bodies of which a piece of a curve between closed components is left out. False: no memory. */
bool overlap_gaps_find(overlap_gaps *g, const surface_cuts *found, const left_out_pairs *left_out);

/* Whether a curve is left out of the two bodies a <= b, or of one of them with itself. */
bool overlap_gaps_have(const overlap_gaps *g, uint32_t a, uint32_t b);

/* ---- copies of solids ---------------------------------------------------------------------------------- */

/* Whether two bodies are copies of one solid. */
bool same_solids_have(const same_solids *s, uint32_t a, uint32_t b);

/* ---- cut triangles ------------------------------------------------------------------------------------- */

/* A call begins, with room for this number of lines and slots in each of its triangles. False: that does not
 * fit the budget. */
bool cut_memory_begin(cut_memory *m, memory_budget *budget, size_t lines, size_t slots);

/* Makes room; false: no memory. */
bool cut_memory_reserve(cscd_context *context, cut_memory *m, size_t lines, size_t slots);
void cut_memory_free(cscd_context *context, cut_memory *m);

/* Sets the projection of a triangle with this normal, and its corners. exchanged: x for y. */
void loaded_cut_project(const named_surface *s, const double normal[3], bool exchanged, loaded_cut *out);

/* A point in that projection. */
void loaded_cut_point(const loaded_cut *cut, const double x[3], double out[2]);

/* Sorts the borders as cut_triangle asks; spare has room for as many. */
void loaded_cut_sort_borders(loaded_cut *cut, cut_border *spare);
