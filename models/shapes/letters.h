/* Letters as thick as their strokes, with round edges: T, U, V, W. */
#pragma once

#include "models/shapes/body.h"

/* Each function adds exactly triangle_count triangles, or returns false and adds nothing when that is
 * impossible. catalogue.h has sizes and places. */
bool add_letter_t(body *b, uint32_t triangle_count);
bool add_letter_u(body *b, uint32_t triangle_count);
bool add_letter_v(body *b, uint32_t triangle_count);
bool add_letter_w(body *b, uint32_t triangle_count);
