/* A hand and an octopus, which are the zero sets of functions. */
#pragma once

#include "models/shapes/body.h"

/* Each function adds exactly triangle_count triangles, or returns false and adds nothing when that is
 * impossible. catalogue.h has sizes and places. */
bool add_hand(body *b, uint32_t triangle_count);
bool add_octopus(body *b, uint32_t triangle_count);
