/* The patches into which intersection curves cut a surface, and how often bodies wind around them. */
#pragma once

#include "runtime/bvh/object_set.h"
#include "runtime/intersections/winding.h"
#include "src/core/memory_budget.h"

#include <cscd/patches.h>

/* The numbers that one thread has found. */
typedef struct winding_lane {
    _Alignas(CACHE_LINE_SIZE) winding_tally tally;
    uint32_t *spare; /* for sorting what the tally has touched */
    cscd_winding *items;
    size_t count, capacity;
    bool out_of_memory;
} winding_lane;

/* What the last call has found, and the memory of all calls. Nodes are connected to patches: the vertices, and the ends of
 * edges, whose numbers come behind those of the vertices. A vertex at which curves end is none; its edges' ends are. */
typedef struct patch_finder {
    const cscd_mesh *mesh;
    const object_set *objects;    /* one for each object, or NULL: there are no rules */
    const surface_bodies *bodies; /* of the surface found last */
    uint32_t lane_count;

    bool *cut_edges;      /* per edge: a curve cuts it */
    bool *split_vertices; /* per vertex: curves end at it */
    bool *
        crossed_components; /* per component: a curve cuts one of its edges, or ends at one of its vertices */
    uint8_t
        *triangle_cuts; /* per triangle: bit i: a curve ends at corner i; CUT_TRIANGLE: a curve lies in it */
    uint32_t *parents;  /* per node */
    uint32_t *node_patches;    /* the same, of roots */
    uint32_t *component_patch; /* per component that is not crossed */
    uint32_t *vertex_patches, *triangle_patches, *corner_patches;
    cscd_patch *patches;
    size_t patch_count, patch_capacity;
    cscd_winding *windings;
    size_t winding_count, winding_capacity;
    winding_lane *lanes;
    uint32_t tally_capacity; /* of each lane: bodies */
    memory_budget *budget;   /* of the call; NULL: there is no limit */
} patch_finder;

/* On failure, which is OUT_OF_MEMORY without a sentence, *out holds nothing. */
cscd_status patch_finder_create(const cscd_mesh *mesh, uint32_t lane_count, patch_finder *out);
void patch_finder_free(patch_finder *p);

/* Finds the patches between the pieces of all curves. The bounds of the trees are those of the surface's positions. */
cscd_status patch_finder_run(patch_finder *p, const named_surface *s, const bvh *f, const curve_piece *pieces,
                             size_t piece_count, cscd_patches *out);

/* The node that an edge has at its vertex: the same number for what no curve parts. */
uint32_t patch_node(const patch_finder *p, uint32_t edge, uint32_t vertex);

/* Are two bodies, or a body and itself, looked at with each other? Their objects say. */
bool patch_bodies_look(const patch_finder *p, uint32_t a, uint32_t b);
