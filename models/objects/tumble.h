/* Eight soft bodies that fall into a tray and tumble together. */
#pragma once

#include "models/shapes/body.h"
#include "models/softbody/simulation.h"
#include "tool/io/io_error.h"

enum { TUMBLE_BODIES = 8, TUMBLE_FRAMES = 150 };

extern const char tumble_name[], tumble_text[];

typedef struct tumble {
    body shape;    /* as the bodies begin, in single precision */
    double *frame; /* its vertices now, in single precision */
    obstacles around;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    soft_body soft; /* all bodies in one lattice of separate pieces */
    self_contacts contacts;
    double *start; /* the vertices where the detector's interval starts */
} tumble;

/* Opens the scene at its first frame, with a context that outlives it. When it returns false, there is
 * nothing to close and *error says why. */
bool tumble_open(cscd_context *context, tumble *out, io_error *error);
void tumble_close(tumble *t);

/* Advances by one frame. */
bool tumble_advance(tumble *t, io_error *error);
