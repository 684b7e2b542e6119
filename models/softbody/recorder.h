/* Runs a scene frame by frame: the soft body moves, cscd finds where it runs into itself, the body responds.
 */
#pragma once

#include "models/softbody/scene.h"
#include "models/softbody/simulation.h"

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
    double detect_ms; /* spent in cscd by recorder_advance, all calls so far */
} recorder;

/* At the first frame. context: NULL, for one of its own, or one that outlives it. recorder_close takes it
 * back; on false there is nothing to close, and *error says why. */
bool recorder_open(const soft_scene *s, cscd_context *context, recorder *out, io_error *error);
void recorder_close(recorder *r);

/* On to the next frame. */
bool recorder_advance(recorder *r, io_error *error);

/* Of the body and the balls: kinetic, potential and elastic. */
double recorder_energy(const recorder *r);
