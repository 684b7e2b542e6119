/* Which pairs wait after a mesh has torn, told by brute force over all pairs of features. */
#pragma once

#include "src/mesh/mesh.h"

void torn_model_begin(void);

/* made: a change that the detector has followed. labels: of the seams of each old vertex, UINT32_MAX: none. */
void torn_model_change(const cscd_mesh_change *made, const uint32_t *labels);

/* What a detector that leaves out nothing that waits reports of a step at rest, and of a check, where a motion starts. */
void torn_model_settle(const cscd_contacts *at_rest, const cscd_intersections *crossing);

bool torn_model_waits(cscd_contact_kind kind, uint32_t a, uint32_t b);

/* How many pairs of features wait. */
size_t torn_model_count(void);
