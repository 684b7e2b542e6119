/* Areas, normals and lengths on the mesh, for any coordinates that positions may hold. */
#pragma once

#include "src/core/vec3.h"
#include "src/mesh/mesh.h"

/* The length of v. Its squares could overflow, so they are formed of v over its largest coordinate. */
static inline double surface_norm(const double v[3]) {
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (largest == 0.0) return 0.0;
    double x = v[0] / largest, y = v[1] / largest, z = v[2] / largest;
    return largest * sqrt(x * x + y * y + z * z);
}

static inline const double *surface_corner(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                                           uint32_t corner) {
    return positions + (size_t)mesh->triangles[triangle][corner] * 3;
}

/* The outward normal, as long as twice the area. */
static inline void surface_normal(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                                  double out[3]) {
    const double *a = surface_corner(mesh, positions, triangle, 0);
    const double *b = surface_corner(mesh, positions, triangle, 1);
    const double *c = surface_corner(mesh, positions, triangle, 2);
    double u[3], v[3];
    vec3_subtract(b, a, u);
    vec3_subtract(c, a, v);
    vec3_cross(u, v, out);
}

static inline double surface_area(const cscd_mesh *mesh, const double *positions, uint32_t triangle) {
    double normal[3];
    surface_normal(mesh, positions, triangle, normal);
    return 0.5 * surface_norm(normal);
}

static inline double surface_edge_length(const cscd_mesh *mesh, const double *positions, uint32_t edge) {
    const double *a = positions + (size_t)mesh->edges[edge][0] * 3;
    const double *b = positions + (size_t)mesh->edges[edge][1] * 3;
    return surface_norm((double[3]){b[0] - a[0], b[1] - a[1], b[2] - a[2]});
}
