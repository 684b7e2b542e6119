/* Random scenes of triangles, wires, points and half-spaces, with random rules, and what happens in them: every pair of
 * features by itself, without a tree and without the rules of the library. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/random.h"

enum { LOOSE_OBJECTS_MAX = 8, LOOSE_VERTICES_MAX = 256, LOOSE_LIST_MAX = 60000 };

/* How a scene is made. */
typedef struct loose_recipe {
    bool triangles, wires, points, half_spaces;
    bool grid;      /* coordinates are multiples of 1/16, so that many features touch exactly */
    bool rules;     /* categories, masks, self, obstacle_pairs */
    bool thickness; /* of objects, some 0; else there may be a min_separation */
    bool matrix;    /* in place of thicknesses */
    bool obstacles;
    double min_separation;
    double motion; /* how far vertices move at the most */
} loose_recipe;

typedef struct loose_scene {
    loose_recipe recipe;
    uint32_t object_count, vertex_count;
    cscd_object_desc objects[LOOSE_OBJECTS_MAX];
    uint32_t indices[LOOSE_OBJECTS_MAX][256]; /* of triangles or wires */
    double x0[LOOSE_VERTICES_MAX * 3], x1[LOOSE_VERTICES_MAX * 3];
    cscd_object_rule rules[LOOSE_OBJECTS_MAX];
    double matrix[LOOSE_OBJECTS_MAX * LOOSE_OBJECTS_MAX];
    cscd_context *context;
    cscd_mesh *mesh;
} loose_scene;

/* Makes a scene and its mesh. */
void loose_scene_make(loose_scene *s, const loose_recipe *recipe, random_stream *random, uint32_t threads,
                      cscd_simd simd);
void loose_scene_free(loose_scene *s);

/* New positions at both ends. */
void loose_scene_move(loose_scene *s, random_stream *random);

/* The options of a detector for the scene, whose arrays are those of the scene. */
cscd_detector_options loose_scene_options(const loose_scene *s);

/* A detector of the scene's mesh, in its context; a failure fails the test. */
cscd_detector *loose_scene_detector(const loose_scene *s, const cscd_detector_options *options);

/* How far two objects have to stay apart, as the header says. */
double loose_scene_distance(const loose_scene *s, uint32_t a, uint32_t b);

/* A pair of features that the header says are looked at. */
typedef struct loose_pair {
    cscd_contact_kind kind;
    uint32_t a, b;
    double distance; /* that it has to keep */
} loose_pair;

/* Lists all pairs of features, sorted by (kind, a, b). at_zero: also points against points and wires that have no distance
 * to keep. Returns how many there are. */
size_t loose_scene_pairs(const loose_scene *s, bool at_zero, loose_pair *out);

/* Do the features touch, or come within the distance, between two positions? toi by the single pairs of the API; of a
 * half-space by its own arithmetic, which is right to 2^-90 of what it adds. */
bool loose_pair_meets(const loose_scene *s, const loose_pair *pair, const double *x0, const double *x1,
                      double distance, double *toi);

/* The distance of the features; of a half-space the height. */
double loose_pair_apart(const loose_scene *s, const loose_pair *pair, const double *x);
