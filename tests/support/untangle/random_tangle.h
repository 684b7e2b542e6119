/* Random small tangles with all that a call of cscd_detector_untangle may be told, and which of their pairs count. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/random.h"
#include "tests/support/untangle/whole_oracle.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum random_tangle_class {
    TANGLE_BODIES, /* balls in each other, some turned inside out in places */
    TANGLE_SHEETS, /* open sheets that cross */
    TANGLE_FOLDS, /* a sheet that is rolled through itself, or a ball whose pole is pushed out on the other side */
    TANGLE_RODS,  /* rods through a body */
    TANGLE_BOXES, /* flush, stacked, in each other, on few planes */
    TANGLE_SOUPS, /* any triangles, of no area and twice as well */
    TANGLE_PLACES, /* all vertices of one of the above, or of one of its objects, on one point, line or plane */
    TANGLE_MIXTURES,
    TANGLE_CLASSES
} random_tangle_class;

const char *random_tangle_name(random_tangle_class of);

enum { TANGLE_OBJECTS = 4, TANGLE_VERTICES = 420, TANGLE_TRIANGLES = 720, TANGLE_PAIRS = 24 };

typedef struct random_tangle {
    random_tangle_class of;
    uint32_t object_count, vertex_count, triangle_count;
    cscd_object_desc objects[TANGLE_OBJECTS];
    uint32_t first_vertex[TANGLE_OBJECTS + 1], first_triangle[TANGLE_OBJECTS + 1];
    uint32_t own[TANGLE_TRIANGLES][3], triangles[TANGLE_TRIANGLES][3]; /* as in the object, as in the mesh */
    uint32_t wires[16][2];
    double normal[3];
    double x[TANGLE_VERTICES * 3];
    bool is_float[TANGLE_OBJECTS]; /* how positions are stored */
    double size;                   /* of the objects, about */

    /* Of the detector. */
    cscd_method method;
    double min_separation;
    cscd_object_rule rules[TANGLE_OBJECTS];
    bool has_rules, ignores;
    uint32_t seams[TANGLE_PAIRS][2], names[TANGLE_VERTICES];
    uint32_t ignored[TANGLE_PAIRS][2];
    size_t seam_count, ignored_count;
    uint32_t active[TANGLE_VERTICES], active_count; /* 0: all vertices are active */
    bool is_active[TANGLE_VERTICES];

    /* Of the call. */
    double weights[TANGLE_VERTICES];
    bool has_weights, in_place;
    uint32_t max_rounds, max_steps;
    double spread;
} random_tangle;

/* The same seed gives the same tangle. */
void random_tangle_make(uint64_t seed, random_tangle *out);

/* Makes what it is called with; NULL: the library refuses it, and the context says why. */
cscd_mesh *random_tangle_mesh(const random_tangle *t, cscd_context *context);
cscd_detector *random_tangle_detector(const random_tangle *t, const cscd_mesh *mesh, cscd_context *context);

/* Moves the positions: those of a frame after, in which vertices of seams are where each other are. */
void random_tangle_move(random_tangle *t, random_stream *random);

/* May the vertex not move? Of obstacles, without triangles, inactive, or of infinite weight. */
bool random_tangle_pinned(const random_tangle *t, uint32_t vertex);

/* Is it, or a vertex that a seam unites with it, pinned? */
bool random_tangle_held(const random_tangle *t, uint32_t vertex);

/* The rules of cscd/detector.h and cscd/live.h, in other words: how many pairs count. */
size_t random_tangle_pairs(const random_tangle *t, whole_oracle *oracle, const double *x);

/* Is some vertex nearer to a triangle, or an edge to an edge, than the two have to keep, by more than a rounding, and without a doubt that
 * the pair counts? */
bool random_tangle_too_near(const random_tangle *t, const double *x);
