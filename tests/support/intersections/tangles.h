/* Bodies of which nearly all triangles cross each other. */
#pragma once

#include "tests/support/intersections/body_rig.h"

/* A ball whose vertices are in another order, and a small one beside its middle. */
void tangle_add_shuffled(body_rig *r, int rings, int segments);

/* Open triangles, so that there are cut-offs, and no depths. */
void tangle_add_soup(body_rig *r, uint32_t triangles);
