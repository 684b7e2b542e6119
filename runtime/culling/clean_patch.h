/* Which of the free triangles are clean: have one winding number in common on their outer sides. */
#pragma once

#include "runtime/culling/start_state.h"

/* Free triangles become clean where they are connected, over edges and through free triangles, to clean ones.
 * Where less than half of a component is clean then, and its largest patch of other free triangles is larger,
 * that becomes the clean one instead. Of a component without crossing and unknown triangles all are. Leaves
 * the numbers per component up to date. Takes linear time. */
void clean_patches_find(start_states *s);
