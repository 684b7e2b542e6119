/* The regions of bodies: charge says where to cut, visibility says whether. */
#pragma once

#include "preprocess/regions/tiles.h"

/* Regions so far: of each triangle, and their detector points. */
typedef struct body_regions {
    uint32_t *of_triangle; /* room for each triangle of the mesh */
    uint32_t count, capacity;
    double (*points)[3];
} body_regions;

/* Room for each triangle of the mesh. */
typedef struct body_room {
    uint32_t *tile_of, *scratch;
    bool *marked;
} body_room;

/* Adds the regions of a component, whose triangles are listed, ascending. Each of them is connected. */
cscd_status body_regions_add(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                             uint32_t count, const body_room *room);

/* Adds a component as one region. */
cscd_status body_regions_add_whole(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                                   uint32_t count);
