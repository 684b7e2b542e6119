/* Areas, normals and lengths on the mesh, for any coordinates that positions may hold. */
#pragma once

#include "src/mesh/mesh.h"

#include <math.h>

/* Squares of lengths would overflow; the largest part is taken out. */
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

/* Twice the area long, outwards. */
static inline void surface_normal(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                                  double out[3]) {
    const double *a = surface_corner(mesh, positions, triangle, 0);
    const double *b = surface_corner(mesh, positions, triangle, 1);
    const double *c = surface_corner(mesh, positions, triangle, 2);
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
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
