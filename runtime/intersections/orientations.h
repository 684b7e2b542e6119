/* Which closed components are inside out at one moment: docs/theory/orientation.md. */
#pragma once

#include "runtime/intersections/winding.h"
#include "src/mesh/part_labels.h"
#include "src/mesh/volume_sign.h"

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
    uint32_t *samples;     /* the first triangle whose corners have different names; UINT32_MAX: none */
    winding_tally tally;   /* of components */
    uint8_t *orientations; /* per object: which signs its components have */
    uint32_t *triangles, *offsets; /* those of each component, made when first needed */
    component_keys
        crossings; /* pairs of components of mixed objects that pass through each other, both ways round */
    component_keys parts; /* of components of mixed objects */
} orientation_finder;

/* False: no memory, and *out holds nothing. */
bool orientation_finder_create(const cscd_mesh *mesh, orientation_finder *out);
void orientation_finder_free(orientation_finder *o);

/* Finds what is turned around, and gives it to the surface, of which nothing was turned before. The pieces are those of its
 * curves, and the bounds of the trees those of its positions. parts: as cscd_patches says; NULL: objects alone count. False: no
 * memory. */
bool orientation_finder_run(orientation_finder *o, named_surface *s, const bvh *f, const part_labels *parts,
                            const curve_piece *pieces, size_t piece_count);
