/* Moves detector points with their regions. */
#include "preprocess/regions/region_motion.h"

#include "src/mesh/surface.h"

#include <string.h>

static void add_way(const region_scene *s, const double *frame, uint32_t t, region_way *way) {
    const double area = surface_area(s->mesh, s->positions, t);
    for (uint32_t corner = 0; corner < 3; corner++) {
        const double *before = surface_corner(s->mesh, s->positions, t, corner),
                     *after = surface_corner(s->mesh, frame, t, corner);
        for (int k = 0; k < 3; k++) way->way[k] += area * (after[k] - before[k]) / 3.0;
    }
    way->area += area;
}

void region_points_move(const region_scene *scene, const double *frame, region_way *ways, double (*out)[3]) {
    memset(ways, 0, scene->region_count * sizeof *ways);
    for (uint32_t i = 0; i < scene->count; i++) {
        const uint32_t t = region_scene_triangle(scene, i);
        add_way(scene, frame, t, &ways[scene->of_triangle[t] - scene->first]);
    }
    for (uint32_t r = 0; r < scene->region_count; r++)
        for (int k = 0; k < 3; k++)
            out[r][k] = scene->points[r][k] + ways[r].way[k] / (ways[r].area > 0.0 ? ways[r].area : 1.0);
}
