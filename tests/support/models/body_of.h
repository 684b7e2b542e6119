/* The bodies of models/shapes, for tests. */
#pragma once

#include "models/shapes/catalogue.h"

/* Exactly that many triangles, 0: the default; to be freed. The test fails where they cannot be made. */
body body_of(body_kind kind, uint32_t triangle_count);
