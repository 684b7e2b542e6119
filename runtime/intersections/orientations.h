/* Which closed components are inside out at one moment: docs/theory/orientation.md. */
#pragma once

#include "runtime/intersections/winding.h"
#include "src/mesh/bodies.h"
#include "src/mesh/volume_sign.h"

#include <cscd/intersections.h>

/* The memory of all calls. */
typedef struct orientation_finder orientation_finder;

/* NULL: no memory. */
orientation_finder *orientation_finder_create(const cscd_mesh *mesh);

/* NULL is allowed. */
void orientation_finder_destroy(orientation_finder *o);

typedef struct orientation_request {
    const uint32_t
        *labels;       /* of triangles: shells of one label belong together; NULL: those of an object do */
    bool by_component; /* each component is a body, or a cavity of one, whatever the surface says */
    bool as_given;     /* nothing is turned around; cavities belong to what is around them all the same */
    const cscd_intersection_pair *pairs; /* of the surface: all that were found */
    size_t pair_count;
} orientation_request;

/* Finds what is turned around, of which nothing was before, which bodies there are, and the boxes, and gives them to the surface. The bounds of
 * the trees are those of its positions. False: no memory. */
bool orientation_finder_run(orientation_finder *o, named_surface *s, const bvh *f,
                            const orientation_request *request);
