/* Soft bodies between obstacles: a lattice of elastic cubes that carries a surface, its contacts, scenes, recordings. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"
#include "models/shapes/catalogue.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- the lattice around a surface ---------------------------------------------------------------------- */

typedef struct lattice {
    uint32_t node_count, cell_count, vertex_count;
    double *rest;               /* node_count * 3 */
    uint32_t (*cells)[8];       /* corners: the bits of 0 to 7 are x, y, z */
    uint32_t *parities;         /* per cell, 0 or 1, as on a chessboard */
    uint32_t *vertex_cells;     /* the cell that each vertex of the surface lies in */
    double (*vertex_shares)[8]; /* trilinear weights of that cell's corners, sum 1 */
    double spacing;
} lattice;

/* Makes the lattice of the cells, `spacing` wide, that the surface touches or encloses. Parts of the
 * surface that are nearer than spacing to each other share cells, and so stick together. lattice_free
 * releases it. */
lattice lattice_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                     uint32_t triangle_count, double spacing);
void lattice_free(lattice *l);

/* Computes the vertices of the surface, vertex_count * 3, from any places of the nodes. */
void lattice_place_vertices(const lattice *l, const double *nodes, double *positions);
void lattice_place_vertex(const lattice *l, const double *nodes, uint32_t vertex, double position[3]);

/* ---- elasticity ---------------------------------------------------------------------------------------- */

typedef struct material {
    double density;        /* mass per volume */
    double young, poisson; /* stiffness (force per area); from above 0 to 0.49, how well volume is kept */
    double damping;        /* share of a cell's motion that is not rigid and is lost per second (1/s) */
} material;

typedef struct tetrahedron {
    uint32_t nodes[4];
    double to_rest[3][3]; /* inverse of the matrix whose columns are the rest edges from nodes[0] */
    double volume;
    double shear, bulk; /* Lame's mu and lambda */
} tetrahedron;

/* Makes five tetrahedra for each cell, 5 * cell_count, to be freed. The body has the mass of its cells,
 * which cover more than the inside of the surface. */
tetrahedron *tetrahedra_make(const lattice *l, const material *m);

/* Does one iteration of XPBD over all tetrahedra, in order (Macklin and Mueller, "A constraint-based
 * formulation of stable neo-Hookean materials", 2021, equations 9 and 10). inverse_masses: per node; step:
 * in seconds. */
void tetrahedra_solve(const tetrahedron *tetrahedra, uint32_t count, const double *inverse_masses,
                      double step, double *nodes);

/* Returns the energy above that of the rest shape. */
double tetrahedra_energy(const tetrahedron *tetrahedra, uint32_t count, const double *nodes);

/* ---- soft bodies --------------------------------------------------------------------------------------- */

typedef struct soft_body {
    lattice frame;
    tetrahedron *tetrahedra;
    double *masses, *inverse_masses; /* per node */
    double *nodes, *previous, *velocities;
    double *vertices;          /* of the surface, vertex_count * 3 */
    double *vertex_mobilities; /* inverse masses of the surface's vertices, as points of the lattice */
    double damping;
} soft_body;

/* Makes a body at rest as given; spacing is the width of the lattice's cells. */
soft_body soft_body_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, double spacing, const material *m);
void soft_body_free(soft_body *b);

/* Computes the matrix of a rotation about an axis of any length; an axis of length 0 gives the identity. The matrix is rounded to
 * single precision, because sines and cosines of different libraries differ in their last bits. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]);

/* Turns the body and then moves it, before the first step. */
void soft_body_place(soft_body *b, double turn[3][3], const double offset[3]);
void soft_body_throw(soft_body *b, const double velocity[3], const double spin[3]);

/* Moves a vertex of the surface together with the lattice around it. nodes: those of the body, or the
 * previous ones; moving both leaves the velocity unchanged. */
void soft_body_push(const soft_body *b, double *nodes, uint32_t vertex, const double change[3]);

/* Returns the kinetic, potential (of height z) and elastic energy. */
double soft_body_energy(const soft_body *b, double gravity);

/* ---- obstacles ----------------------------------------------------------------------------------------- */

enum { BALLS_MAX = 8 };

/* A rigid ball that the body and the ground push. It slides, it does not spin. */
typedef struct ball {
    double centre[3], previous[3], velocity[3];
    double radius, mass;
} ball;

/* The ground lies at z = 0 below everything. Stairs descend along +x: step i of step_count covers the x
 * from start + i * tread to start + (i + 1) * tread, with its top at (step_count - i) * riser; before the
 * first step the top is level. A tray is a square of ground about the origin between walls of any height. */
typedef struct obstacles {
    uint32_t step_count, ball_count;
    double start, tread, riser;
    double tray;     /* half its width; 0: there is none */
    double friction; /* Coulomb's coefficient */
    double gravity;  /* acceleration downwards */
    ball balls[BALLS_MAX];
} obstacles;

/* Returns the height of ground or stairs at a place. */
double obstacles_height(const obstacles *o, double x);

/* The shortest way out of an obstacle for a point inside it. */
typedef struct obstacle_hit {
    double normal[3], depth;
    ball *pushed; /* NULL: ground, stairs or walls */
} obstacle_hit;

/* Whether the point is inside ground, stairs or walls, or inside ball `which`; if not, *out is unchanged. */
bool obstacles_hit_terrain(const obstacles *o, const double point[3], obstacle_hit *out);
bool obstacles_hit_ball(obstacles *o, uint32_t which, const double point[3], obstacle_hit *out);

/* Move the balls: obstacles_begin moves them freely, then bodies may push them, then obstacles_end keeps
 * them off the terrain and each other and computes their new velocities. step: in seconds. */
void obstacles_begin(obstacles *o, double step);
void obstacles_end(obstacles *o, double step);

/* Returns the kinetic and potential energy of the balls. */
double obstacles_energy(const obstacles *o);

/* Makes ground and stairs, then the balls in their order at their present places; body_free releases it. */
bool scenery_make(const obstacles *o, body *out, io_error *error);

/* Moves the balls of a scenery to their present places. */
bool scenery_follow(const obstacles *o, body *scenery, io_error *error);

/* ---- contacts of a body with itself -------------------------------------------------------------------- */

/* A pair in contact, a on the outside of b. VF: vertex and triangle; EE: two edges. */
typedef struct held_pair {
    cscd_contact_kind kind;
    uint32_t a, b;
} held_pair;

typedef struct self_contacts {
    const cscd_mesh *mesh;
    double *rest;     /* the vertices at rest */
    held_pair *pairs; /* sorted by (kind, a, b) after self_contacts_add, without repetitions */
    size_t count, capacity;
    double near;     /* pairs that are nearer at rest are left to the lattice */
    double gap;      /* pairs are pushed apart to this distance */
    double depth;    /* deeper pairs are given up */
    double healing;  /* how far pairs are pushed apart in one small step */
    double friction; /* Coulomb's coefficient */
} self_contacts;

/* Makes a response without pairs; its limits follow from near. The mesh is closed and manifold; `rest` has
 * its vertices at rest. */
self_contacts self_contacts_make(const cscd_mesh *mesh, const double *rest, double near);
void self_contacts_free(self_contacts *s);

/* Adds the contacts of a detector step whose sides run into each other, not apart, and come from parts of
 * the body that were apart at rest. */
void self_contacts_add(self_contacts *s, const cscd_contacts *found, const double *start, const double *end);

/* Solves all pairs once, in order: pushes them apart, follows vertices that slide from triangle to
 * triangle, and drops pairs that have parted. */
void self_contacts_solve(self_contacts *s, soft_body *soft);

/* ---- simulation ---------------------------------------------------------------------------------------- */

/* Advances by `seconds` in `step_count` small steps; the vertices of the surface follow. contacts: those found
 * before, or NULL. */
void simulation_advance(soft_body *b, obstacles *o, self_contacts *contacts, double seconds,
                        uint32_t step_count);

/* ---- scenes -------------------------------------------------------------------------------------------- */

/* Lengths are in the unit of the bodies, times in seconds. */
typedef struct soft_scene {
    const char *name, *text;
    body_kind kind;
    double spacing; /* of the lattice */
    material stuff;
    double axis[3], degrees; /* how the body is turned at the start, */
    double height;           /* height of its lowest point above the ground, and */
    double velocity[3];      /* how it moves; its centre is above x = y = 0 */
    obstacles around;
    uint32_t frame_count;
    double frame_seconds;
    uint32_t checks, steps; /* detector steps in a frame; small steps in each of these */
} soft_scene;

extern const soft_scene soft_scenes[];
extern const uint32_t soft_scene_count;

/* Returns NULL when no scene has this name. */
const soft_scene *soft_scene_find(const char *name);

/* Places a body, which is at rest as in catalogue.h, at the start of the scene. */
soft_body soft_scene_begin(const soft_scene *s, const body *shape);

/* ---- recordings ---------------------------------------------------------------------------------------- */

typedef struct recorder {
    const soft_scene *scene;
    body shape;    /* as the body begins, in single precision: the model that the frames belong to */
    double *frame; /* its vertices now, in single precision */
    obstacles around;
    cscd_context *context;
    bool own_context; /* destroyed with the recorder */
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
    soft_body soft;
    self_contacts contacts;
    double *start;    /* the vertices where the detector's interval starts */
    double detect_ms; /* time that recorder_advance has spent in cscd so far */
} recorder;

/* Opens a scene at its first frame. context outlives the recorder; when it is NULL, the recorder has one
 * of its own. recorder_close releases it; when this returns false, there is nothing to close and *error
 * says why. */
bool recorder_open(const soft_scene *s, cscd_context *context, recorder *out, io_error *error);
void recorder_close(recorder *r);

/* Advances by one frame. */
bool recorder_advance(recorder *r, io_error *error);

/* Returns the energy of the body and the balls: kinetic, potential and elastic. */
double recorder_energy(const recorder *r);
