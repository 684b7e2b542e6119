/* Which closed components are inside out at one moment: docs/theory/orientation.md. */
#pragma once

#include "runtime/intersections/winding.h"
#include "src/mesh/bodies.h"
#include "src/mesh/volume_sign.h"

#include <cscd/intersections.h>

/* Two components, or a component and a part, as a number: the first is in the upper half. */
typedef struct component_keys {
    uint64_t *items, *spare;
    size_t count, capacity;
} component_keys;

/* The memory of all calls. Arrays without a remark are per component. */
typedef struct orientation_finder {
    const cscd_mesh *mesh;
    volume_estimate *volumes;
    int8_t *signs;         /* of the volume; 0 of open components, and where a closed one encloses nothing */
    bool *turned;          /* the component is taken as turned around */
    uint32_t *objects;     /* of the component */
    uint32_t *samples;     /* a triangle whose corners have different names; UINT32_MAX: none */
    uint32_t *around;      /* the component that it lies in, the innermost one; itself: in none */
    component_box *boxes;  /* where there are several */
    uint8_t *roles;        /* body or cavity */
    surface_bodies bodies; /* of the surface, with cavities joined with what is around them */
    winding_tally tally;   /* of components */
    uint8_t *orientations; /* per object: which signs its components have */
    uint32_t *triangles, *offsets; /* those of each component, made when first needed */
    uint32_t *holders;             /* made with them: room for those that one lies in */
    bool *touching;                /* per triangle: it is in a pair with another component */
    component_keys
        crossings; /* pairs of components of mixed objects that pass through each other, both ways round */
    component_keys parts; /* of components of mixed objects */
} orientation_finder;

/* False: no memory, and *out holds nothing. */
bool orientation_finder_create(const cscd_mesh *mesh, orientation_finder *out);
void orientation_finder_free(orientation_finder *o);

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
