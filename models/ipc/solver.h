/* A solver by incremental potential contact on the public API: each time step of implicit Euler is a
 * minimisation that never leaves the configurations free of contact. An example for authors of solvers. */
#pragma once

#include "models/ipc/newton_system.h"
#include "models/ipc/scenes.h"

/* Sums over all time steps so far. */
typedef struct ipc_statistics {
    uint32_t steps;      /* time steps */
    uint32_t newton;     /* Newton iterations: each one line */
    uint32_t trials;     /* points on lines at which the energy was evaluated */
    uint32_t cut;        /* lines that contact limited to less than all of the Newton step */
    uint32_t unfinished; /* time steps that ended at the bound on iterations, or where no step led down */
    uint64_t conjugate_gradients;         /* iterations */
    uint64_t candidates;                  /* of all lines */
    uint64_t near;                        /* pairs nearer than the reach, at all points evaluated */
    uint32_t driven;                      /* Newton iterations in which obstacles moved */
    double least_distance;                /* of any pair at any point reached; INFINITY: none was near */
    double begin_ms, certify_ms, near_ms; /* in cscd_line_begin, _max_step, _near; */
    double detect_ms;                     /* the three together */
    double total_ms;                      /* all of ipc_solver_advance */
} ipc_statistics;

typedef struct ipc_solver {
    const ipc_scene *scene;
    body shape; /* all objects as one mesh, as they begin, in single precision */
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_line *line;
    double time;
    double *positions, *velocities; /* now; of obstacles, velocities are 0. The pointers change with steps */
    double *travels;                /* per vertex, 0 for bodies */
    double *inertia;                /* per vertex: mass / (time step)^2; 0 for obstacles */
    ipc_springs springs;
    ipc_system system;

    /* The time step under way. */
    double *before, *predicted; /* its start; its end without forces from inside */
    double *gradient, *direction;
    double *end, *trial;                   /* of the line; what was verified on it */
    ipc_contacts contacts, trial_contacts; /* at positions; at trial */
    double energy;                         /* of what is minimised, at positions */
    double to_travel;                      /* share of the obstacles' travel at the end of the step */
    bool arrived;                          /* they are there */
    ipc_statistics statistics;
} ipc_solver;

/* About so many triangles in all, 0: the scene's own. The detector uses the context's threads.
 * ipc_solver_free takes it back; on another status than CSCD_OK there is nothing to free. */
cscd_status ipc_solver_make(const ipc_scene *scene, uint32_t triangle_count, cscd_context *context,
                            ipc_solver *out);
void ipc_solver_free(ipc_solver *p);

/* One time step: begin, iterate until it says that it is done, end. */
cscd_status ipc_solver_advance(ipc_solver *p);

void ipc_solver_begin_step(ipc_solver *p);
/* One Newton iteration: a direction, and a step along it. While obstacles are on their way they are part of
 * the direction, and the step is the longest that is free of contact; else the energy falls. */
cscd_status ipc_solver_iterate(ipc_solver *p, bool *done);
void ipc_solver_end_step(ipc_solver *p);

/* What a time step minimises, at any positions with their contacts: inertia, springs, barrier. */
double ipc_solver_energy(const ipc_solver *p, const double *positions, const ipc_contacts *contacts);
