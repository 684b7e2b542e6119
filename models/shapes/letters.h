/* Letters as thick as their strokes, with round edges: T, U, V, W. */
#pragma once

#include "models/shapes/body.h"

/* Each adds exactly triangle_count triangles; false, and nothing added, where that cannot be. Sizes and
 * places: catalogue.h. */
bool add_letter_t(body *b, uint32_t triangle_count);
bool add_letter_u(body *b, uint32_t triangle_count);
bool add_letter_v(body *b, uint32_t triangle_count);
bool add_letter_w(body *b, uint32_t triangle_count);
