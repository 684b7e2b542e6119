/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#pragma once

#include "cscd/cscd.h"
#include "models/cloth/cloth_scene.h"

/* ---- contact and friction: the pairs of cscd_detector_find_near as constraints on positions ------------ */

/* Two features that are kept apart along a normal. Normal and weights stay as they were when the pair was
 * found. */
typedef struct apart_pair {
    cscd_stencil stencil;
    double normal[3]; /* from the second to the first */
    double healing;   /* share of the missing distance that one small step adds */
} apart_pair;

typedef struct apart {
    apart_pair *pairs; /* in the order of the detector, those with obstacles last */
    size_t count, capacity;
    double thickness;  /* the distance to be kept */
    double healing[2]; /* of pairs within cloth, and of pairs with an obstacle */
    double friction;   /* Coulomb's coefficient */
} apart;

void apart_free(apart *a);

/* Replaces the pairs by new ones. When the nearest point lies at an end of an edge, the pair of that
 * vertex is kept and the pair of the edges is dropped. */
void apart_take(apart *a, const cscd_mesh *mesh, const cscd_proximities *near);

/* Solves all pairs once, in order. A pair that would come nearer than `thickness` is stopped, and friction
 * slows it down along the surface. A pair that is nearer already is moved apart, and `previous` with it,
 * so that it gains no speed. Vertices with inverse mass 0 stay. */
void apart_solve(const apart *a, const double *inverse_masses, double *previous, double *positions);

/* Sums the vertices of a stencil by their weights. */
void apart_sum(const cscd_stencil *s, const double *positions, double sum[3]);

/* Moves the vertices so that the sum changes by `change`: by weight and inverse mass, so that momentum is
 * kept. */
void apart_push(const cscd_stencil *s, const double *inverse_masses, const double change[3],
                double *positions);

/* ---- motion that is certified to have no contact ------------------------------------------------------- */

/* Totals since the start. */
typedef struct safe_motion_counts {
    uint64_t steps;            /* calls of cscd_detector_step */
    uint64_t contacts;         /* found by these calls */
    uint64_t cut;              /* motions that needed a change */
    uint64_t fallbacks, waits; /* motions that took cscd_detector_max_step; motions without any way on */
    uint64_t tight;            /* motions that began too near for the first separation to leave them a way */
    uint32_t tightest;         /* the smallest separation that was needed; 0 is the first */
} safe_motion_counts;

/* Each separation is a quarter of the one before. */
enum { SAFE_MOTION_SEPARATIONS = 5 };

/* Limits how far the points of a contact may approach along its normal. */
typedef struct safe_motion_stop {
    cscd_stencil stencil;
    double normal[3], allowed;
} safe_motion_stop;

/* A set of vertices that move together; its smallest vertex names it. */
typedef struct safe_motion_zone {
    double motion[3], mass;  /* sums of mass times motion, and of mass */
    double told[3], tellers; /* sum and number of the motions of obstacles in contact with it */
    double share;            /* the share that this round leaves of motions that differ */
} safe_motion_zone;

/* The caller owns mesh, seams and inverse_masses, which has one number per vertex, 0 for vertices with
 * given motions. */
typedef struct safe_motion {
    cscd_detector *detector; /* its separation is that of the last motion */
    const cscd_mesh *mesh;
    double separation; /* the first */
    uint32_t which;    /* of the separations is that of the detector */
    const double *inverse_masses;
    const uint32_t *seams; /* pairs of vertices that move as one */
    uint32_t seam_count;
    uint32_t vertex_count;
    safe_motion_stop *stops; /* of the current motion */
    size_t stop_count, stop_capacity;
    uint32_t *parents;       /* zones of the current motion, as a forest of vertices */
    safe_motion_zone *zones; /* indexed by the vertices that name them */
    double (*told)[4];       /* per vertex: sum and number of the motions of obstacles in contact */
    double *reached;         /* the end of a motion that is shortened as a whole */
    safe_motion_counts counts;
} safe_motion;

cscd_status safe_motion_open(const cscd_mesh *mesh, double separation, const double *inverse_masses,
                             const uint32_t *seams, uint32_t seam_count, safe_motion *out);
void safe_motion_close(safe_motion *s);

/* Changes x1 until the straight motion from x0 to x1 has no contact: features stay farther apart than the
 * separation or, where they were pressed together and begin nearer than that, than the next one, and so
 * on. x0 has no contact. *length is 1, or the share of their way that the obstacles went, down to 0: when
 * no other motion is left, all vertices stop on the way, and the obstacles with them. Vertices that are
 * sewn together have equal positions in x0 and in x1. */
cscd_status safe_motion_find(safe_motion *s, const double *x0, double *x1, double *length);

/* Moves both vertices of each seam to their common centre of mass. */
void safe_motion_sew(const safe_motion *s, double *positions);

/* ---- motion that displacement bounds or planes allow --------------------------------------------------- */

/* The way in which the motion of a frame is kept free of contact. */
typedef enum motion_driver {
    DRIVER_STEPS,  /* safe_motion: continuous detection */
    DRIVER_BOUNDS, /* a ball for each vertex, as in Offset Geometric Contact (Chen et al. 2025) */
    DRIVER_PLANES, /* planes between near pairs, as in Divide and Truncate (Chen et al. 2026) */
    DRIVER_COUNT
} motion_driver;

/* "steps", "bounds" and "planes". */
const char *motion_driver_name(motion_driver driver);

/* The caller owns detector and mesh. */
typedef struct bounded_motion {
    cscd_detector *detector;
    const cscd_mesh *mesh;
    motion_driver driver;              /* not DRIVER_STEPS */
    double shortest_reach;             /* of the search for near pairs; the longest is twice that */
    uint32_t free_count, vertex_count; /* vertices that are not of obstacles come first */
    double *now, *wanted, *reached, *bounds;
    uint32_t most_rounds; /* of one motion: 8 */
    double left_over;     /* total: distances that the first rounds have left, obstacles aside */
    uint64_t rounds;      /* total: searches for near pairs */
} bounded_motion;

void bounded_motion_open(cscd_detector *detector, const cscd_mesh *mesh, motion_driver driver,
                         double shortest_reach, uint32_t free_count, bounded_motion *out);
void bounded_motion_close(bounded_motion *b);

/* Changes x1 to where the vertices come from x0 on the way to it, round by round. There is no contact on the straight
 * lines from round to round, and features that begin farther apart than the detector's min_separation stay so.
 * *length is the share of their way that the obstacles went. */
cscd_status bounded_motion_find(bounded_motion *b, const double *x0, double *x1, double *length);

/* ---- simulation ---------------------------------------------------------------------------------------- */

/* Totals since the start. total_ms is the time in cloth_advance; near_ms and step_ms are the parts of it
 * in cscd. */
typedef struct cloth_statistics {
    uint32_t frames;
    double total_ms, near_ms, step_ms;
    uint64_t near_pairs;          /* found by cscd_detector_find_near */
    uint64_t rounds, most_rounds; /* detector steps, or searches for bounds: all, and of one frame */
    double waited;                /* frames by which the obstacles are late */
    double wanted,
        lost; /* sums of the distances that vertices of the garment wanted to go, and that they are from there */
    safe_motion_counts motion;
} cloth_statistics;

typedef struct cloth_simulation {
    const cloth_scene *scene;
    double spacing;                      /* of the garment's vertices */
    body garment;                        /* as it begins */
    body obstacles[CLOTH_OBSTACLES_MAX]; /* each about its centre */
    cscd_context *context;               /* the caller's */
    cscd_mesh *mesh;                     /* object 0: the garment; then the obstacles */
    uint32_t *seams;                     /* pairs of the garment's vertices, NULL: none */
    uint32_t seam_count;
    fabric cloth;
    double *inverse_masses; /* these arrays have all vertices of the scene; 0: of an obstacle */
    double *positions;      /* now: without contact, and reached without contact */
    double *start;          /* the same at the last frame */
    double *target, *previous, *velocities;
    apart pairs;
    safe_motion safe;
    bounded_motion bounded; /* unless DRIVER_STEPS drives */
    double clock;           /* time of the obstacles; it stands still while they wait */
    cloth_statistics statistics;
} cloth_simulation;

/* Opens a scene; resolution 0 is its own. The context outlives the simulation. When it returns false,
 * there is nothing to close and *error says why. */
bool cloth_open(const cloth_scene *s, uint32_t resolution, motion_driver driver, cscd_context *context,
                cloth_simulation *out, io_error *error);
void cloth_close(cloth_simulation *c);

/* Advances by one frame. On straight lines from `start` to `positions` there is no contact, and nothing
 * comes nearer than cloth_separation. */
bool cloth_advance(cloth_simulation *c, io_error *error);

/* The first is the distance that the solver keeps as long as it can; the second is certified so far, and
 * smaller where cloth was pressed together. */
double cloth_thickness(const cloth_simulation *c);
double cloth_separation(const cloth_simulation *c);
