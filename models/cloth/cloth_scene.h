/* The scenes of the cloth simulator: fabrics, garments and obstacles, and which garment falls how, onto what. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/io.h"

/* ---- fabric: springs along edges and stiff hinges across them, by XPBD --------------------------------- */

typedef struct fabric_material {
    double density; /* mass per area */
    double stretch; /* force per length of a spring; springs across cells resist shear */
    double bending; /* force times length: resistance to curvature */
    double damping; /* seconds: stretching and bending motion dies away as with Rayleigh's coefficient */
    double drag;    /* share of the velocity that the air takes per second (1/s) */
} fabric_material;

typedef struct fabric_spring {
    uint32_t vertices[2];
    double rest, compliance;
} fabric_spring;

/* Two triangles at an edge. The weighted sum of the four vertices is 0 when they are flat and grows with
 * the angle (Bergou et al., "A quadratic bending model for inextensible surfaces", 2006). */
typedef struct fabric_hinge {
    uint32_t vertices[4]; /* the two of the edge, then the two opposite */
    double weights[4];
    double rest; /* length of that sum at rest */
    double compliance;
} fabric_hinge;

typedef struct fabric {
    uint32_t vertex_count, spring_count, hinge_count;
    fabric_spring *springs; /* one for each edge, by (smaller, larger vertex) */
    fabric_hinge *hinges;   /* one for each edge of two triangles, in the same order */
    double *inverse_masses; /* per vertex; 0 holds it in place */
    double damping, drag;
} fabric;

/* Makes a fabric whose rest shape is the body. Every vertex belongs to a triangle, and every edge to at
 * most two. */
fabric fabric_make(const body *rest, const fabric_material *m);
void fabric_free(fabric *f);

/* Solves all springs and hinges once, always in the same order: alternating the order would never come to
 * rest, since each order ends in a slightly different place. previous: positions at the start of the small
 * step; step: in seconds. */
void fabric_solve(const fabric *f, double step, const double *previous, double *positions);

/* Returns the kinetic energy plus the energy of springs and hinges. */
double fabric_energy(const fabric *f, const double *positions, const double *velocities);

/* ---- garments and obstacles as meshes: sheets, tubes, boxes and balls ---------------------------------- */

/* Each function adds one component. Positions are exact in single precision, as in files. */

/* Adds an open square in the plane z = 0 about the origin, with side * side vertices; side is at least 2.
 * Its edges run along and across, and along the two diagonals from cell to cell in turn. */
void garment_add_sheet(body *b, uint32_t side, double width);

/* Adds two open panels of columns * rows vertices, to be sewn together at the sides and at the upper edge.
 * They stand on z = 0 in the plane y = 0 and bulge by `depth` to both sides at the open lower edge. */
void garment_add_bag(body *b, uint32_t columns, uint32_t rows, double width, double height, double depth);

/* Returns the seams of a bag that is the whole body: *pair_count pairs of vertices with equal positions,
 * to be freed. */
uint32_t *garment_bag_seams(uint32_t columns, uint32_t rows, uint32_t *pair_count);

/* Adds a closed tube with flat ends and rounded rims, which stands on z = 0 about the z axis. It has
 * exactly triangle_count even triangles; the count is even and some hundred at least. */
void garment_add_tube(body *b, uint32_t triangle_count, double radius, double height);

/* Adds a flat box about the z axis with its top at z = 0: `reach` wide to each side, and a tenth of it
 * high. */
void garment_add_box(body *b, double reach);

/* Adds a ball about the origin of about triangle_count triangles. */
bool garment_add_ball(body *b, uint32_t triangle_count, double radius, io_error *error);

/* ---- scenes -------------------------------------------------------------------------------------------- */

typedef enum cloth_cut { CLOTH_SHEET, CLOTH_TUBE, CLOTH_BAG } cloth_cut;

typedef enum cloth_obstacle_kind { CLOTH_BOX, CLOTH_BALL } cloth_obstacle_kind;

/* An obstacle with a given motion: from `begin` to `begin + seconds` it rises and turns about the vertical
 * axis through its centre; before and after that it rests. */
typedef struct cloth_obstacle {
    cloth_obstacle_kind kind;
    double size;      /* radius of a ball, or half the width of a box */
    double centre[3]; /* the centre of a ball, or of a box's top */
    double begin, seconds, rise;
    double turn; /* tangent of half the angle */
} cloth_obstacle;

enum { CLOTH_OBSTACLES_MAX = 2 };

/* Lengths in metres, masses in kilograms, times in seconds. */
typedef struct cloth_scene {
    const char *name, *text;
    cloth_cut cut;
    double width, height; /* side of a sheet; diameter and height of a tube; both of a bag */
    double depth;         /* how far a bag bulges to each side */
    uint32_t resolution;  /* default: vertices along a side (odd for a bag) or around a tube */
    double place[3];      /* middle of a sheet, or middle of the lower end of another garment */
    double turn, lean;    /* tangents of half the angles: about the vertical, then about the x axis */
    fabric_material stuff;
    double friction, gravity;
    uint32_t obstacle_count;
    cloth_obstacle obstacles[CLOTH_OBSTACLES_MAX];
    uint32_t frame_count;
    double frame_seconds;
    uint32_t small_steps; /* per frame */
} cloth_scene;

extern const cloth_scene cloth_scenes[];
extern const uint32_t cloth_scene_count;

/* Returns NULL when no scene has this name. */
const cloth_scene *cloth_scene_find(const char *name);

enum { CLOTH_RESOLUTION_MIN = 12, CLOTH_RESOLUTION_MAX = 500 };

/* Returns the mean distance of neighbouring vertices. */
double cloth_scene_spacing(const cloth_scene *s, uint32_t resolution);

/* Makes the garment in its first shape, which is also its shape at rest. */
body cloth_scene_garment(const cloth_scene *s, uint32_t resolution);

/* Returns *pair_count pairs of vertices that are sewn together, to be freed; NULL when there are none. */
uint32_t *cloth_scene_seams(const cloth_scene *s, uint32_t resolution, uint32_t *pair_count);

/* Makes the mesh of an obstacle about its centre; cloth_obstacle_place moves it. */
bool cloth_obstacle_make(const cloth_obstacle *o, body *out, io_error *error);
void cloth_obstacle_place(const cloth_obstacle *o, const body *shape, double time, double *positions);
