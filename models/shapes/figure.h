/* Bodies that are the zero set of a function: a person, two rings that grew together, an ellipsoid. */
#pragma once

#include "models/shapes/body.h"

/* Each function adds exactly triangle_count triangles, or returns false and adds nothing when that is
 * impossible. catalogue.h has sizes and places. */
bool add_figure(body *b, uint32_t triangle_count);
bool add_genus2(body *b, uint32_t triangle_count);
bool add_ellipsoid(body *b, uint32_t triangle_count);
