/* What a body falls onto, as a mesh for pictures. */
#pragma once

#include "models/shapes/body.h"
#include "models/softbody/obstacles.h"
#include "src/io/io_error.h"

/* Ground and stairs, then the balls in their order, where they are now; body_free takes it back. */
bool scenery_make(const obstacles *o, body *out, io_error *error);

/* Moves the balls of a scenery to where they are now. */
bool scenery_follow(const obstacles *o, body *scenery, io_error *error);
