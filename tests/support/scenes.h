/* Meshes and random intervals that all tests share. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { SCENE_VERTICES_MAX = 1200, SCENE_TRIANGLES_MAX = 2000 };

/* A mesh and its positions at both ends of an interval. */
typedef struct scene {
    uint32_t vertex_count, triangle_count;
    double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    uint32_t triangles[SCENE_TRIANGLES_MAX * 3];
} scene;

/* Each family yields intervals with contacts as well as without. */
typedef enum scene_family {
    SCENE_NOISY_SPHERE,   /* a sphere with changing waves */
    SCENE_BENT_CAPSULE,   /* bends until it touches itself */
    SCENE_SQUASHED_TORUS, /* is pressed flat */
    SCENE_FOLDED_SHEET,   /* open; rolls up */
    SCENE_TWO_SPHERES,    /* fly at or past each other */
    SCENE_NESTED_SPHERES, /* the inner one grows, moves, and may start outside */
    SCENE_LINKED_TORI,    /* are pulled apart */
    SCENE_SPIKE,          /* one vertex is pulled, at times through the far wall */
    SCENE_BOW_TIE,        /* two cones that share their tip bend towards each other */
    SCENE_SOUP,           /* random triangles, any topology */
    SCENE_GRID,           /* small integer coordinates: touching, coplanar and coincident features */
    SCENE_FAR_AWAY,       /* a bent capsule far from the origin, flying */
    SCENE_FAMILY_COUNT
} scene_family;

const char *scene_family_name(scene_family family);

/* Makes a scene; the same seed gives the same scene. jitter: brings the scene into generic position by
 * moving vertices by up to a few per cent of an edge (SCENE_GRID has none). */
void scene_make(scene_family family, uint64_t seed, scene *out);

/* These building blocks replace the mesh of the scene by one shape or add a shape to it. They set x0, and
 * x1 = x0. */
void scene_clear(scene *s);
void scene_add_sphere(scene *s, const double centre[3], double radius, int rings, int segments);
void scene_add_torus(scene *s, const double centre[3], double major, double minor, int rings, int segments,
                     bool standing);
void scene_add_capsule(scene *s, double length, double radius, int rings, int segments);
void scene_add_sheet(scene *s, double width, double height, int columns, int rows);
