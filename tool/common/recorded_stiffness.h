/* How stiff the material of a recording is: the property stiffness of the faces of its models. */
#pragma once

#include "tool/common/recording.h"

/* How stiff the material of a recording is, where its model files say so. */
typedef struct recorded_stiffness {
    double *of_triangle; /* of the mesh; NULL: no model says */
    const char *path;    /* of the first model that does */
    double least, greatest;
} recorded_stiffness;

/* Objects whose models do not say are as stiff everywhere. False: a value is not positive and finite, and there is nothing to free. */
bool recorded_stiffness_read(const recording *r, recorded_stiffness *out, io_error *error);
void recorded_stiffness_free(recorded_stiffness *s);
