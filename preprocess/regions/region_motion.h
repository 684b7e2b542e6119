/* What regions see while the mesh deforms: their detector points move with the centroids of their surfaces, as in a detector. */
#pragma once

#include "src/mesh/mesh.h"

/* Some regions, numbered from first on, and all their triangles. */
typedef struct region_scene {
    const cscd_mesh *mesh;
    const double *positions; /* at rest */
    const uint32_t *list;    /* of triangles; NULL: all of the mesh */
    uint32_t count;
    const uint32_t *of_triangle; /* the region of each triangle of the mesh */
    uint32_t first, region_count;
    const double (*points)[3]; /* region_count detector points at rest */
} region_scene;

/* How a region's point has moved: way is the sum of its triangles' ways, weighted by their areas at rest. */
typedef struct region_way {
    double way[3], area;
} region_way;

/* Finds where the points are in a frame; ways: room for region_count. */
void region_points_move(const region_scene *scene, const double *frame, region_way *ways, double (*out)[3]);

/* The triangle number i of the list. */
static inline uint32_t region_scene_triangle(const region_scene *scene, uint32_t i) {
    return scene->list != NULL ? scene->list[i] : i;
}
