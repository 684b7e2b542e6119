/* Bodies that are the zero set of a function: a person, two rings that grew together, an ellipsoid. */
#pragma once

#include "models/shapes/body.h"

/* Each adds exactly triangle_count triangles; false, and nothing added, where that cannot be. Sizes and
 * places: catalogue.h. */
bool add_figure(body *b, uint32_t triangle_count);
bool add_genus2(body *b, uint32_t triangle_count);
bool add_ellipsoid(body *b, uint32_t triangle_count);
