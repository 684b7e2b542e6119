/* The obstacles as a mesh for pictures. */
#pragma once

#include "models/shapes/body.h"
#include "models/softbody/obstacles.h"
#include "tool/io/io_error.h"

/* Makes ground and stairs, then the balls in their order at their present places; body_free releases it. */
bool scenery_make(const obstacles *o, body *out, io_error *error);

/* Moves the balls of a scenery to their present places. */
bool scenery_follow(const obstacles *o, body *scenery, io_error *error);
