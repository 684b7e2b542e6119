/* Some bodies, one object each, what a detector finds where they intersect, distances from them, and sums by pair of
 * parts. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

enum { BODIES_MAX = 4 };

/* Where a body is in the scene; its triangles' vertices are numbered from 0. */
typedef struct body_part {
    uint32_t first_vertex, vertex_count, first_triangle, triangle_count;
    uint32_t triangles[SCENE_TRIANGLES_MAX * 3];
} body_part;

typedef struct body_rig {
    scene all;
    body_part bodies[BODIES_MAX];
    uint32_t body_count;
    cscd_orientation orientation;
    bool part_bodies;
    counting_allocator *counter; /* of the context, for as long as it lives; NULL: the system's allocator */
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_intersections found;
} body_rig;

/* Begins without a body. */
void body_rig_begin(body_rig *r);

/* What was added to rig->all since the last call, or the beginning, is a body. */
void body_rig_end_body(body_rig *r);

/* Adds an axis-aligned box to what will be a body. */
void body_rig_add_box(body_rig *r, const double low[3], const double size[3]);

/* A body that is such a box. */
void body_rig_box(body_rig *r, const double low[3], const double size[3]);

/* Adds a sheet, open and flat, of so many cells along two edges from a corner; with a hole, the cell in the middle is left
 * out. */
void body_rig_add_sheet(body_rig *r, const double corner[3], const double along[3], const double up[3],
                        uint32_t columns, uint32_t rows, bool hole);

/* A long body that bends into a ring and swallows its tail; without a change before, it lies about the origin. */
void body_rig_add_snake(body_rig *r);

/* Exchanges two corners of these triangles of the scene, and so of the bodies that have them. */
void body_rig_turn(body_rig *r, uint32_t first, uint32_t count);

/* Creates the detector, with options or the default ones, in a context of so many threads. */
void body_rig_create(body_rig *r, const cscd_detector_options *options, uint32_t thread_count);

/* Finds everything. try: whatever the status is. */
void body_rig_find(body_rig *r);
cscd_status body_rig_try(body_rig *r);

/* Frees what the rig has created; what it creates anew is freed before. The second is for after each test, and frees all rigs. */
void body_rig_free(body_rig *r);
int body_rigs_free(void **state);

/* Creates a detector with the default options in a context of two threads, and finds everything. */
void body_rig_find_all(body_rig *r);

/* The overlap of two objects, 0 if they have none. */
cscd_overlap body_rig_overlap(const body_rig *r, uint32_t a, uint32_t b);

/* Coordinate k becomes coordinate k + axis, mirrored at will, so many times as large; triangles stay outwards. */
void body_rig_place(body_rig *r, int axis, bool mirrored, double scale);

/* Was the component found inside out? */
bool body_rig_is_turned(const body_rig *r, uint32_t component);

/* ---- distances and winding numbers --------------------------------------------------------------------- */

double body_distance(const body_rig *r, uint32_t body, const double x[3]);

/* The winding number around a generic point. */
int body_number(const body_rig *r, uint32_t body, const double x[3]);

/* ---- tangles ------------------------------------------------------------------------------------------- */

/* Nearly all triangles of these bodies cross each other. */

/* A ball whose vertices are in another order, and a small one beside its middle. */
void tangle_add_shuffled(body_rig *r, int rings, int segments);

/* Open triangles, so that there are cut-offs, and no depths. */
void tangle_add_soup(body_rig *r, uint32_t triangles);

/* ---- labels and sums by pair of parts ------------------------------------------------------------------ */

/* A label for each triangle of a scene. */
typedef struct labelling {
    uint32_t items[SCENE_TRIANGLES_MAX];
    uint32_t count; /* of parts */
} labelling;

/* Those that a detector goes by unless it is given others. */
void labelling_of_objects(labelling *l, const body_rig *r);

/* So many parts by chance; some triangles are in none. */
void labelling_draw(labelling *l, const body_rig *r, uint32_t count, uint64_t seed);
void labelling_set(const labelling *l, const body_rig *r);

/* Compares all sums of what was found, and returns how many pairs of parts there are. */
size_t labelling_compare(const labelling *l, const body_rig *r);

/* Three objects that go through each other and one through itself, and what is found of them with parts; find: with depths. */
void labelled_scene_open(body_rig *r, const cscd_detector_options *options, uint32_t thread_count);
cscd_status labelled_scene_try(body_rig *r, cscd_intersection_options options);
void labelled_scene_find(body_rig *r);
