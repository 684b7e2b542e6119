/* Intersecting surfaces at one moment: which triangles intersect, along which curves, and what follows from the curves.
 *
 * The static check finds pairs of triangles. Curves are joined from these pairs; they cut the surface into patches, whose
 * winding numbers tell what bodies bury. From curves and patches follow overlaps, copies of solids, cut-offs and sums by
 * pair of parts. Theory: docs/theory/static-check.md, docs/theory/curves.md and docs/theory/orientation.md. */
#pragma once

#include "runtime/bvh/bvh.h"
#include "src/core/memory.h"
#include "src/mesh/parts.h"

#include <cscd/surface.h>

/* ---- pairs of triangles -------------------------------------------------------------------------------- */

/* Two triangles a < b that intersect, or are duplicates of each other. */
typedef struct found_pair {
    uint32_t a, b;
} found_pair;

/* The facts about a pair, for callers that ask for kinds. */
typedef struct pair_note {
    uint8_t kind;   /* a cscd_intersection_kind */
    uint8_t shared; /* corners of the one whose names the other has */
    /* The check without kinds does not find this duplicate, since features that share a vertex do not intersect. */
    bool unlisted;
} pair_note;

/* The place of a thread in its share of the vertices: the next pair is that of two triangles of a star. */
typedef struct star_cursor {
    uint32_t vertex, end, first, second;
} star_cursor;

/* The findings of one thread. */
typedef struct intersection_worker {
    _Alignas(CACHE_LINE_SIZE) found_pair *items;
    pair_note *notes; /* one for each item where kinds are asked for */
    size_t count, capacity, note_capacity;
    size_t settled; /* the first ones, which stay: they do not count for the limit */
    star_cursor stars;
    uint32_t zero_area_triangles, first_zero_area; /* UINT32_MAX: none */
    bool out_of_memory;
} intersection_worker;

/* Copies a pair of a worker whose notes are kept to another place in it. */
static inline void intersection_worker_move(intersection_worker *worker, size_t from, size_t to) {
    worker->items[to] = worker->items[from];
    worker->notes[to] = worker->notes[from];
}

/* The triangles around each vertex at one moment, and what is known of them. */
typedef struct vertex_stars {
    const cscd_mesh *mesh;
    /* Per vertex: each edge at it belongs to two triangles, which run through it in opposite directions. This does not
     * depend on the moment. */
    bool *closed;
    /* Per vertex: no two triangles at it intersect, nor are they duplicates; or nobody asks whether they do. */
    bool *clear;
    uint8_t *normals, *rises; /* per triangle */
} vertex_stars;

/* The outcome of the last check, and the memory of all checks. */
typedef struct static_check {
    const cscd_mesh *mesh;
    bool *unproven; /* per triangle: it is compared with the others */
    bool *crossing; /* per unproven triangle: it intersects another one of its component, or has no area */
    intersection_worker
        *workers; /* one per worker of the traversal; they include the pairs that the caller ignores */
    uint32_t worker_count;
    vertex_stars stars;
    bool kinds; /* the check asks for them: workers have notes, and duplicates */

    /* When a worker has this many pairs behind its settled ones, the triangles of all pairs are marked as crossing, and then
     * the calling thread empties the workers. SIZE_MAX: there is no limit. */
    size_t limit;
    void (*spill)(void *data); /* NULL: the pairs are dropped */
    void *spill_data;

    /* The rules for objects, and the object of each component. They are read where trees mix objects; elsewhere the
     * traversal has applied them already. NULL: there are none. */
    const object_set *objects;
    const uint32_t *component_objects;

    /* The components without a surface at the moment, whose triangles intersect nothing. The caller sets them together with
     * those of the traversal. NULL: all are compared. */
    const bool *collapsed;
} static_check;

/* On failure *out holds nothing. */
cscd_status static_check_create(const cscd_mesh *mesh, uint32_t worker_count, static_check *out);
void static_check_destroy(static_check *c);

/* Compares the triangles that are marked as unproven with one another, each with those of its own component. The
 * volumes of the trees must contain the triangles at positions, so they belong to that moment or to an interval that
 * contains it. CANCELLED, here and below: not all pairs have been compared. */
cscd_status static_check_unproven(static_check *c, traversal *t, bvh *hierarchy, const double *positions);

/* Compares all triangles whose objects are looked at with one another, and marks all triangles as unproven. */
cscd_status static_check_all(static_check *c, traversal *t, bvh *hierarchy, const double *positions);

/* The same, with the kind of each pair, and with duplicates, which mark nothing. names: per vertex; vertices of one name
 * count as one. NULL: each is its own. */
cscd_status static_check_kinds(static_check *c, traversal *t, bvh *hierarchy, const double *positions,
                               const uint32_t *names);

/* The pairs that count, and the number of them that is enough. */
typedef struct pair_quest {
    size_t enough; /* 1 or more */
    bool any;      /* it does not matter which ones are found */
    void *data;
    bool (*counts)(void *data, found_pair pair, pair_note note); /* called on any thread */
    bool (*stays)(void *data, found_pair pair); /* called afterwards, on the calling thread; NULL: all stay */
} pair_quest;

/* As static_check_kinds, but ends once it has found enough pairs that count and stay. Then the workers have these alone,
 * and of each number the same ones for any worker count: the traversal's tasks are in a fixed order, as are the pairs of a
 * task. No triangle is marked. */
cscd_status first_pairs_find(static_check *c, traversal *t, bvh *hierarchy, const double *positions,
                             const uint32_t *names, const pair_quest *quest);

/* ---- the surface --------------------------------------------------------------------------------------- */

/* The box around a component at one moment. */
typedef struct component_box {
    double low[3], high[3];
} component_box;

/* The surface at one moment, with the vertices that count as one and the components that count as turned
 * around. */
typedef struct named_surface {
    const cscd_mesh *mesh;
    const double *positions; /* packed */
    /* Per vertex: the smallest vertex that it is one with, at the same place; NULL: each is its own. */
    const uint32_t *names;
    /* Per component: its normals point inwards, so that the side they point away from is outside; NULL: none do. */
    const bool *turned;
    const surface_bodies *bodies; /* NULL: the objects are the bodies */
    /* Per component: it has no surface, so it contains nothing and is in nothing; NULL: all have one. */
    const bool *collapsed;
    const component_box *boxes; /* per component; NULL: not known */
} named_surface;

/* 1 where the normal of a triangle points outwards, -1 where its component is turned around. */
static inline int surface_sense(const named_surface *s, uint32_t triangle) {
    return s->turned != NULL && s->turned[s->mesh->triangle_components[triangle]] ? -1 : 1;
}

static inline uint32_t surface_body(const named_surface *s, uint32_t triangle) {
    return body_of_triangle(s->bodies, s->mesh, triangle);
}

static inline uint32_t surface_name(const named_surface *s, uint32_t vertex) {
    return s->names != NULL ? s->names[vertex] : vertex;
}

/* A vertex that is not where the vertex of its name is. */
typedef struct parted_vertex {
    double x[3];
    uint32_t name, vertex;
} parted_vertex;

/* The memory of all calls; begins with nothing but the context set. */
typedef struct placed_names {
    cscd_context *context;
    uint32_t *names; /* per vertex, of the last call */
    parted_vertex *parted, *spare;
    size_t parted_capacity;
} placed_names;

void placed_names_free(placed_names *p);

/* *out: per vertex the smallest one of its seam that is at its place; NULL if there are no seams. It lives until the next
 * call, which is about the same mesh. names: per vertex the smallest one of its seam, or NULL. False: no memory. */
bool placed_names_find(placed_names *p, const cscd_mesh *mesh, const double *positions, const uint32_t *names,
                       const uint32_t **out);

/* ---- curves -------------------------------------------------------------------------------------------- */

enum { NO_EDGE = UINT32_MAX };

/* An edge passes through a triangle that has none of its vertices. Or, with NO_EDGE, the surface passes through itself
 * at a vertex, whose number then stands in place of the triangle. */
typedef struct surface_piercing {
    uint32_t edge, triangle;
} surface_piercing;

/* The piece of a curve that lies in two triangles. It leads from ends[0] to ends[1], in the direction of the normal of a
 * times (cross product) the normal of b: unless components are turned around, the inside of b is to the left of it on a,
 * seen from outside, and the inside of a to the right of it on b. At most one end is at a vertex, which then is that of a. */
typedef struct curve_piece {
    uint32_t a, b;
    surface_piercing ends[2];
} curve_piece;

/* Something that belongs to a piece, with a number by which it is sorted. */
typedef struct curve_key {
    uint64_t number;
    uint64_t end; /* 2 piece + 0 or 1 */
} curve_key;

/* The findings of the last call, and the memory of all calls; begins with only the context set. */
typedef struct curve_joiner {
    cscd_context *context;
    size_t pair_capacity, piece_capacity;

    /* Per pair. */
    curve_piece *found;    /* the first piece_count ones are the pieces in the order of the pairs */
    uint32_t *pair_pieces; /* its piece, or UINT32_MAX */
    uint32_t *pair_curves;

    /* Per piece, or per end of one. */
    curve_key *keys, *spare_keys;
    uint32_t *links;
    uint32_t *piece_curves;
    uint32_t *end_points; /* per end of a piece: its point */
    cscd_curve *curves;
    cscd_curve_piece *pieces;
    cscd_curve_point *points;
    surface_piercing *piercings; /* of the points */
    size_t pair_count, curve_count, point_count, piece_count;
} curve_joiner;

void curve_joiner_free(curve_joiner *j);

/* The number of bytes that a call with this many pairs takes at most. */
size_t curve_joiner_size(size_t pair_count);

/* Finds the curves of a list of pairs a < b, sorted by (a, b): all pairs of triangles that intersect or touch, except those
 * that are left out. *out lives until the next call. OUT_OF_MEMORY has no sentence, nor CANCELLED. */
cscd_status curve_joiner_run(curve_joiner *j, const named_surface *s, const cscd_intersection *pairs,
                             size_t pair_count, cscd_curves *out);

/* Marks the curves of the last call along which surfaces only touch. pairs: those of that call. */
void touching_curves_mark(curve_joiner *j, const named_surface *s, const cscd_intersection *pairs,
                          const cscd_patches *patches, const cscd_depths *depths);

/* ---- orientations -------------------------------------------------------------------------------------- */

/* Finds which closed components are inside out, and keeps the memory of all calls. */
typedef struct orientation_finder orientation_finder;

/* NULL: no memory. */
orientation_finder *orientation_finder_create(const cscd_mesh *mesh);

/* NULL is allowed. */
void orientation_finder_destroy(orientation_finder *o);

typedef struct orientation_request {
    const uint32_t
        *labels;       /* of triangles: shells of one label belong together; NULL: those of an object do */
    bool by_component; /* each component is a body, or a cavity of one, whatever the surface says */
    bool as_given;     /* nothing is turned around; cavities still belong to what is around them */
    const cscd_intersection *pairs; /* all pairs of the surface that were found */
    size_t pair_count;
} orientation_request;

/* Finds which components are turned around, where none was before, which bodies there are, and the boxes, and gives them to
 * the surface. The bounds of the trees are those of its positions. False: no memory. */
bool orientation_finder_run(orientation_finder *o, named_surface *s, const bvh *hierarchy,
                            const orientation_request *request);

/* ---- patches ------------------------------------------------------------------------------------------- */

/* Numbers of bodies, or of components. Those that are not 0 belong to touched bodies, each of them listed once. */
typedef struct winding_tally {
    int32_t *numbers;  /* per body */
    bool *is_touched;  /* per body */
    uint32_t *touched; /* room for all bodies */
    uint32_t count;
} winding_tally;

/* The numbers that one thread has found. */
typedef struct winding_worker {
    _Alignas(CACHE_LINE_SIZE) winding_tally tally;
    uint32_t *spare; /* for sorting what the tally has touched */
    cscd_winding *items;
    size_t count, capacity;
    bool out_of_memory;
} winding_worker;

/* The findings of the last call, and the memory of all calls. Nodes are connected to patches. The nodes are
 * the vertices, and the ends of edges, whose numbers come behind those of the vertices. A vertex at which
 * curves end is none; the ends of its edges are. */
typedef struct patch_finder {
    const cscd_mesh *mesh;
    const object_set *objects;    /* one for each object, or NULL: there are no rules */
    const surface_bodies *bodies; /* of the surface found last */
    uint32_t worker_count;

    bool *cut_edges;      /* per edge: a curve cuts it */
    bool *split_vertices; /* per vertex: curves end at it */
    bool *
        crossed_components; /* per component: a curve cuts one of its edges, or ends at one of its vertices */
    uint8_t
        *triangle_cuts; /* per triangle: bit i: a curve ends at corner i; CUT_TRIANGLE: a curve lies in it */
    uint32_t *parents;  /* per node */
    uint32_t *node_patches;    /* per node, of roots */
    uint32_t *component_patch; /* per component that is not crossed */
    uint32_t *vertex_patches, *triangle_patches, *corner_patches;
    cscd_patch *patches;
    size_t patch_count, patch_capacity;
    cscd_winding *windings;
    size_t winding_count, winding_capacity;
    winding_worker *workers;
    uint32_t tally_capacity; /* of each worker: bodies */
    memory_budget *budget;   /* of the call; NULL: there is no limit */
} patch_finder;

/* On failure, which is OUT_OF_MEMORY without a sentence, *out holds nothing. */
cscd_status patch_finder_create(const cscd_mesh *mesh, uint32_t worker_count, patch_finder *out);
void patch_finder_free(patch_finder *p);

/* Finds the patches between the pieces of all curves. The bounds of the trees are those of the surface's positions. */
cscd_status patch_finder_run(patch_finder *p, const named_surface *s, const bvh *hierarchy,
                             const curve_piece *pieces, size_t piece_count, cscd_patches *out);

/* ---- what curves cut out of triangles ------------------------------------------------------------------ */

/* The findings at one moment. */
typedef struct surface_cuts {
    const named_surface *surface;
    const curve_joiner *curves;
    const patch_finder *patches;
    memory_budget *budget; /* of whatever is found further; NULL: there is no limit */
} surface_cuts;

/* A straight cut, or piece of a curve, in the plane of the triangle. Bodies are numbered by slots. */
typedef struct cut_line {
    double from[2], to[2];
    uint32_t slot;
    uint32_t number;  /* the caller's, who finds the line by it when lines have been sorted */
    int rise;         /* the body's number to the left of the line less that to the right */
    double low, high; /* set by cut_triangle_divide: the lesser and the greater of from[0] and to[0] */
} cut_line;

/* A curve passes through the border of the triangle. */
typedef struct cut_border {
    uint32_t edge; /* 0 to 2; edge i leads from corner i to the next one */
    double s;      /* how far along */
    uint32_t slot;
    int jump; /* what the body's number increases by, going along the edge */
} cut_border;

/* A part of the triangle on which all numbers are the same, between two lines along y: at x[i] it reaches from low[i] to
 * high[i]. */
typedef struct cut_part {
    double x[2], low[2], high[2];
    const int32_t *numbers; /* per slot */
    const uint32_t *listed; /* the slots whose numbers are not 0, in any order */
    uint32_t listed_count;
} cut_part;

static inline double cut_part_area(const cut_part *p) {
    return 0.5 * (p->x[1] - p->x[0]) * ((p->high[0] - p->low[0]) + (p->high[1] - p->low[1]));
}

/* Corners turn counter-clockwise. Slot 0 is the triangle's own body, whose number holds on the side of the normal. */
typedef struct cut_triangle {
    double corners[3][2];
    cut_line *lines;
    cut_border *borders; /* sorted by edge and s */
    int32_t
        *corner_numbers; /* per corner and slot: at the corner, on the side of the edge that begins there */
    size_t line_count, border_count;
    uint32_t slot_count;
} cut_triangle;

/* Numbers of slots, most of which are 0. */
typedef struct slot_numbers {
    int32_t *numbers;
    uint32_t *listed; /* the slots whose numbers are not 0 */
    uint32_t *places; /* per slot that is listed: its place in the list */
    uint32_t count;
} slot_numbers;

/* Memory for triangles with up to this many lines and slots. */
typedef struct cut_memory {
    size_t line_capacity, slot_capacity;
    cut_line *spare_lines;
    uint32_t *active;              /* lines, in the order of a cross-section */
    double *breaks, *spare_breaks; /* where lines begin and end */
    double *crossings;             /* of two lines */
    size_t crossing_capacity;
    size_t crossings_taken; /* of the budget */
    memory_budget *budget;  /* of the call; NULL: there is no limit */
    slot_numbers below;     /* at the border below a slab */
    slot_numbers here;      /* in a part */
} cut_memory;

/* Calls take for each part, up to rounding. Lines may be put in another order. False: no memory. */
bool cut_triangle_divide(cscd_context *context, cut_triangle *t, cut_memory *m,
                         void (*take)(void *data, const cut_part *part), void *data);

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

/* The memory of all calls, and the pieces sorted by their triangles; begins with nothing but the context set. */
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

/* Sorts the pieces that were found. False, here and below: there is no memory, or what the triangles need does not fit the
 * budget. */
bool triangle_cuts_sort(triangle_cuts *c, const surface_cuts *found);

/* The keys of a triangle: from *first to before the returned one. */
size_t triangle_cuts_of(const triangle_cuts *c, uint32_t triangle, size_t *first);

/* Loads the triangle of these keys, which lives until the next one is loaded. A triangle without area has stretch 0, and
 * nothing else of it is set. */
bool triangle_cuts_load(triangle_cuts *c, const surface_cuts *found, size_t first, size_t end,
                        loaded_cut *out);

/* From the projection of a cut triangle back to its plane. The triangle has an area. */
typedef struct cut_lift {
    const loaded_cut *cut;
    double normal[3], corner[3];
} cut_lift;

cut_lift cut_lift_of(const named_surface *s, const loaded_cut *cut);

/* Writes the two triangles of a part. */
void cut_lift_part(const cut_lift *lift, const cut_part *part, double a[3][3], double b[3][3]);

/* ---- overlaps ------------------------------------------------------------------------------------------ */

/* Pairs of triangles that were found and then left out; begins with nothing but the context set. */
typedef struct left_out_pairs {
    cscd_context *context;
    uint64_t *pairs; /* a in the upper half, b in the lower one, a < b; in any order */
    size_t count, capacity;
    bool out_of_memory; /* some pairs may be missing */
} left_out_pairs;

void left_out_pairs_free(left_out_pairs *p);
void left_out_pairs_add(left_out_pairs *p, uint32_t a, uint32_t b);

/* Finds the areas and volumes that bodies bury of each other, and keeps the memory of all calls. */
typedef struct overlap_finder overlap_finder;

/* NULL: no memory. */
overlap_finder *overlap_finder_create(cscd_context *context);

/* NULL is allowed. */
void overlap_finder_destroy(overlap_finder *o);

/* Gives back what it keeps from one call to the next. */
void overlap_finder_clear(overlap_finder *o);

/* *out lives until the next call. OUT_OF_MEMORY has no sentence. */
cscd_status overlap_finder_run(overlap_finder *o, const surface_cuts *found, const left_out_pairs *left_out,
                               cscd_overlaps *out);

/* Bodies that are two copies of one solid: their surfaces lie on each other wherever one could be inside the other, and both
 * contain the same. No curve and no depth tells this, since nothing of one is within the other. Begins with nothing but the
 * context set. */
typedef struct same_solids {
    cscd_context *context;
    const surface_bodies *bodies; /* of the last surface */
    uint64_t *pairs, *spare;      /* bodies a < b, a in the upper half; ascending */
    size_t count, capacity;
} same_solids;

void same_solids_free(same_solids *s);

/* Finds the copies. It runs `overlaps` only where bodies share area and no depth says that one is within the other.
 * OUT_OF_MEMORY has no sentence. */
cscd_status same_solids_find(same_solids *s, const surface_cuts *found, const cscd_intersection *pairs,
                             size_t pair_count, const cscd_depths *depths, overlap_finder *overlaps,
                             const left_out_pairs *left_out);

/* ---- cut-offs ------------------------------------------------------------------------------------------ */

/* Finds what traces of curves cut off of open surfaces, and keeps the memory of all calls. */
typedef struct cut_off_finder cut_off_finder;

/* NULL: no memory. */
cut_off_finder *cut_off_finder_create(cscd_context *context);

/* NULL is allowed. */
void cut_off_finder_destroy(cut_off_finder *f);

/* Gives back what it keeps from one call to the next. */
void cut_off_finder_clear(cut_off_finder *f);

/* Patches have been found. OUT_OF_MEMORY and CANCELLED have no sentence. */
cscd_status cut_off_finder_run(cut_off_finder *f, const surface_cuts *found, cscd_cut_offs *out);

/* ---- measures with gradients --------------------------------------------------------------------------- */

/* Finds the volumes of overlaps, or the lengths of curves, with their gradients, and keeps the memory of all calls. */
typedef struct measure_finder measure_finder;

/* NULL: no memory. */
measure_finder *measure_finder_create(cscd_context *context);

/* NULL is allowed. */
void measure_finder_destroy(measure_finder *m);

/* Gives back what it keeps from one call to the next. */
void measure_finder_clear(measure_finder *m);

/* Patches have been found. Here and below *out lives until the next call of either, and OUT_OF_MEMORY has no sentence. */
cscd_status overlap_volumes_run(measure_finder *m, const surface_cuts *found, const left_out_pairs *left_out,
                                cscd_measures *out);

/* Curves have been found. */
cscd_status curve_lengths_run(measure_finder *m, const surface_cuts *found, cscd_measures *out);

/* ---- sums by pair of parts ----------------------------------------------------------------------------- */

/* A pair of parts, and what belongs to it: a pair of triangles, a piece of a curve, or a depth. */
typedef struct part_key {
    uint64_t parts; /* the smaller one in the upper half */
    uint64_t item;  /* its place in the list; of a piece behind that of its curve in the upper half */
} part_key;

/* The memory of all calls; begins with zeros. */
typedef struct part_summer {
    part_key *keys, *spare_keys;
    size_t key_capacity;
    cscd_part_pair *items;
    size_t item_capacity;
    bool *marks; /* per triangle; all are false between calls. NULL before the first */
} part_summer;

void part_sums_free(cscd_context *context, part_summer *s);

/* Sums up what was found. same: the copies among the bodies; NULL: nobody has asked for them. *out lives until the next call.
 * OUT_OF_MEMORY has no sentence, and may mean that the sums do not fit the budget. */
cscd_status part_sums_run(part_summer *s, const cscd_mesh *mesh, const part_labels *labels,
                          const cscd_intersections *found, const same_solids *same, memory_budget *budget,
                          cscd_part_pairs *out);
