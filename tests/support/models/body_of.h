/* The bodies of models/shapes, for tests. */
#pragma once

#include "models/shapes/catalogue.h"

/* Makes a body with exactly that many triangles, or its default number when that is 0; the caller frees
 * it. The test fails when it cannot be made. */
body body_of(body_kind kind, uint32_t triangle_count);
