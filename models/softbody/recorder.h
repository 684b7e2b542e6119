/* Runs a scene frame by frame: the soft body moves, cscd finds its contacts with itself, the body
 * responds. */
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
