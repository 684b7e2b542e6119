/* A recording of a few frames for programs that replay recordings: a dumbbell whose balls are bent into each other. */
#pragma once

#include "models/shapes/catalogue.h"
#include "tests/support/temp_file.h"

enum { TINY_FRAMES = 6 };

/* Places the dumbbell's vertices as in this frame, as floats, which the file has. */
void tiny_recording_place(const body *shape, int frame, double *out);

/* Writes tiny.obj and tiny.pc2. The caller frees the shape. */
body tiny_recording_write(temp_folder *folder);
