/* A solver by incremental potential contact on the public API: each time step of implicit Euler is a minimisation that never
 * leaves the configurations without contact. It is an example for authors of solvers. */
#pragma once

#include "models/ipc/newton_system.h"

/* ---- scenes -------------------------------------------------------------------------------------------- */

typedef struct ipc_barrier_options {
    double reach;     /* pairs nearer than this repel */
    double stiffness; /* kappa: the factor of the barrier (CSCD_ENERGY_BARRIER) */
} ipc_barrier_options;

/* A closed body at rest, where it begins. An obstacle moves along `travel` and back in travel_seconds,
 * again and again, at an even speed except near its turning points. */
typedef struct ipc_object {
    body shape;
    bool obstacle;
    double travel[3];
} ipc_object;

enum { IPC_OBJECTS_MAX = 8 };

/* Lengths are in the unit of the models, about a metre; times in seconds; z is up. */
typedef struct ipc_scene {
    const char *name, *text;
    uint32_t triangle_count; /* about this number in all objects together, by default */
    uint32_t (*make)(uint32_t triangle_count,
                     ipc_object objects[IPC_OBJECTS_MAX]); /* returns the number of objects */
    ipc_stuff stuff;
    double gravity;
    ipc_barrier_options barrier;
    double min_separation; /* no pair comes nearer */
    double travel_seconds;
    double step_seconds;         /* one time step */
    uint32_t steps, frame_count; /* steps of each frame; frames */
} ipc_scene;

extern const ipc_scene ipc_scenes[];
extern const uint32_t ipc_scene_count;

/* Returns NULL when no scene has this name. */
const ipc_scene *ipc_scene_find(const char *name);

/* Returns the share of its travel that an obstacle has made. */
double ipc_scene_travelled(const ipc_scene *s, double seconds);

/* ---- the solver ---------------------------------------------------------------------------------------- */

/* Totals over all time steps so far. */
typedef struct ipc_statistics {
    uint32_t steps;      /* time steps */
    uint32_t newton;     /* Newton iterations; each searches one line */
    uint32_t trials;     /* points on lines at which the energy was evaluated */
    uint32_t cut;        /* lines that contact made shorter than the Newton step */
    uint32_t unfinished; /* time steps that ended at the bound on iterations, or because no step led down */
    uint64_t conjugate_gradients; /* iterations */
    uint64_t candidates;          /* of all lines */
    uint64_t near;                /* pairs nearer than the reach, summed over all evaluated points */
    uint32_t driven;              /* Newton iterations in which obstacles moved */
    double least_distance;        /* least distance of any pair at any point; INFINITY: no pair was near */
    double begin_ms, certify_ms, near_ms; /* in cscd_line_begin, _max_step, _near; */
    double detect_ms;                     /* the three together */
    double total_ms;                      /* all of ipc_solver_advance */
} ipc_statistics;

typedef struct ipc_solver {
    const ipc_scene *scene;
    body shape; /* all objects as one mesh, as they begin, in single precision */
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_line_search *line;
    cscd_energy *barrier;
    double time;
    double *positions, *velocities; /* now; obstacles have velocity 0. The pointers change with steps */
    double *travels;                /* per vertex, 0 for bodies */
    double *inertia;                /* per vertex: mass / (time step)^2; 0 for obstacles */
    ipc_springs springs;
    ipc_system system;

    /* The time step in progress: */
    double *before, *predicted; /* start of the step; its end without inner forces */
    double *gradient, *direction;
    double *end, *trial;                /* end of the line; the verified point on it */
    cscd_proximities near;              /* at `positions`, until the next line begins; then at `trial` */
    cscd_energy_sum contacts, of_trial; /* the barrier at `positions`, and at `trial` */
    double *hessian;                    /* of the barrier, in the places of its pattern */
    size_t hessian_capacity;            /* in blocks */
    double energy;                      /* the minimised energy at `positions` */
    double to_travel;                   /* share of the obstacles' travel at the end of the step */
    bool arrived;                       /* obstacles are at the end of their way */
    ipc_statistics statistics;
} ipc_solver;

/* Makes a solver with about triangle_count triangles in all, or the scene's own number when it is 0. The
 * detector uses the context's threads. ipc_solver_free releases it; when the status is not CSCD_OK, there
 * is nothing to free. */
cscd_status ipc_solver_make(const ipc_scene *scene, uint32_t triangle_count, cscd_context *context,
                            ipc_solver *out);
void ipc_solver_free(ipc_solver *p);

/* Begins at other positions, at rest; springs keep their lengths. No step leads out of triangles that cross, so such
 * a start is refused: *clean is false, and nothing has changed. cscd_detector_untangle finds one near it. */
cscd_status ipc_solver_start(ipc_solver *p, const double *positions, bool *clean);

/* Takes one time step: begin, iterate until it is done, end. */
cscd_status ipc_solver_advance(ipc_solver *p);

void ipc_solver_begin_step(ipc_solver *p);
/* Takes one Newton iteration: a direction, and a step along it. While obstacles move, they are part of the
 * direction and the step is the longest without contact; otherwise the energy falls. */
cscd_status ipc_solver_iterate(ipc_solver *p, bool *done);
void ipc_solver_end_step(ipc_solver *p);

/* Finds the barrier's energy at any positions with their near pairs, and its derivatives. */
cscd_status ipc_solver_barrier(const ipc_solver *p, const double *positions, const cscd_proximities *near,
                               const cscd_energy_targets *targets, cscd_energy_sum *out);

/* Returns what a time step minimises, at any positions with their contacts: inertia, springs and barrier. */
double ipc_solver_energy(const ipc_solver *p, const double *positions, const cscd_energy_sum *contacts);
