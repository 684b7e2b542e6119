/* Detector points: places them, finds what they see, and moves them with their regions, as a detector does. */
#include "preprocess/regions/tiles.h"

#include "src/mesh/surface.h"

#include <string.h>

/* Sums over a region, weighted by area and with equal weights. */
typedef struct region_sums {
    double weighted[3], plain[3], area, count;
} region_sums;

static void add_triangle(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                         region_sums *sums) {
    double area = surface_area(mesh, positions, triangle);
    for (int k = 0; k < 3; k++) {
        double centre = 0.0;
        for (uint32_t corner = 0; corner < 3; corner++)
            centre += surface_corner(mesh, positions, triangle, corner)[k] / 3.0;
        sums->weighted[k] += area * centre;
        sums->plain[k] += centre;
    }
    sums->area += area;
    sums->count += 1.0;
}

cscd_status detector_points_from_regions(const cscd_mesh *mesh, const double *positions,
                                         const uint32_t *region_of_triangle, uint32_t region_count,
                                         double *points) {
    region_sums *sums = context_allocate(mesh->context, region_count, sizeof *sums);
    if (sums == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        add_triangle(mesh, positions, t, &sums[region_of_triangle[t]]);
    for (uint32_t r = 0; r < region_count; r++) {
        for (uint32_t k = 0; k < 3; k++)
            points[r * 3 + k] =
                sums[r].area > 0.0 ? sums[r].weighted[k] / sums[r].area : sums[r].plain[k] / sums[r].count;
    }
    context_free(mesh->context, sums);
    return CSCD_OK;
}

double orientation_value(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                         const double point[3]) {
    const double *p0 = surface_corner(mesh, positions, triangle, 0);
    double normal[3];
    surface_normal(mesh, positions, triangle, normal);
    double sum = 0.0;
    for (int k = 0; k < 3; k++) sum += (p0[k] - point[k]) * normal[k];
    return sum;
}

cscd_status visible_shares(const cscd_mesh *mesh, const double *positions, const uint32_t *region_of_triangle,
                           uint32_t region_count, const double *points, double *shares) {
    double *areas = context_allocate(mesh->context, region_count, sizeof *areas);
    if (areas == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t r = 0; r < region_count; r++) shares[r] = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t r = region_of_triangle[t];
        double area = surface_area(mesh, positions, t);
        areas[r] += area;
        if (orientation_value(mesh, positions, t, points + (size_t)r * 3) > 0.0) shares[r] += area;
    }
    for (uint32_t r = 0; r < region_count; r++) shares[r] = areas[r] > 0.0 ? shares[r] / areas[r] : 0.0;
    context_free(mesh->context, areas);
    return CSCD_OK;
}

/* ---- points that move ---------------------------------------------------------------------------------- */

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
