/* Meshes and random intervals that all tests share, sequences of frames, and small meshes without positions. */
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

/* ---- sequences ----------------------------------------------------------------------------------------- */

enum { SEQUENCE_FRAMES_MAX = 64 };

/* Random recordings whose meshes pass into themselves, rest, come out, and pass in again. */
typedef enum sequence_kind {
    SEQUENCE_SCENE, /* a closed scene; its frames lie along and beyond its interval, to and fro */
    SEQUENCE_GRID,  /* small closed shapes with small integer coordinates: everything is degenerate at once */
    SEQUENCE_KIND_COUNT
} sequence_kind;

typedef struct sequence {
    scene shape; /* its triangles and its rest positions x0 */
    uint32_t frame_count;
    double frames[SEQUENCE_FRAMES_MAX][SCENE_VERTICES_MAX * 3];
} sequence;

/* Makes a sequence; the same seed gives the same one. Half of the sequences face inwards. */
void sequence_make(sequence_kind kind, uint64_t seed, uint32_t frame_count, sequence *out);

/* ---- meshes without positions -------------------------------------------------------------------------- */

enum { SHAPE_TRIANGLES_MAX = 256 };

/* A shape grows from {0} triangle by triangle; vertex_count is one more than the largest index. */
typedef struct mesh_shape {
    uint32_t vertex_count, triangle_count;
    uint32_t triangles[SHAPE_TRIANGLES_MAX][3];
} mesh_shape;

void shape_add_triangle(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c);
void shape_add_quad(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d);
void shape_add_tetrahedron(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d);

/* Adds a cube; the bits of its vertices' numbers, 0 to 7, are x, y, z. */
void shape_add_cube(mesh_shape *s);

/* Adds rows x columns quads, whose ends may be joined: a sheet, a cylinder, a torus. */
void shape_add_grid(mesh_shape *s, uint32_t rows, uint32_t columns, bool rows_close, bool columns_close);

/* Adds `count` quads in a ring with half a twist. */
void shape_add_moebius_strip(mesh_shape *s, uint32_t count);
