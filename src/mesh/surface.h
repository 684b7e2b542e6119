/* Areas, normals, lengths and volumes on the mesh, for any coordinates that positions may hold, and components without an area. */
#pragma once

#include "src/core/vec3.h"
#include "src/mesh/mesh.h"

#include <math.h>

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

/* ---- volumes ----------------------------------------------------------------------------------------------- */

/* Six times the volume of a closed component, and how far rounding may have moved it. */
typedef struct volume_estimate {
    double volume, rounding;
    const double *origin; /* volumes are measured from here; NULL: the component is open, and the rest 0 */
} volume_estimate;

/* Estimates the volume of each component. Positions are packed, and as predicates.h allows them. */
void volume_estimates_find(const cscd_mesh *mesh, const double *positions, volume_estimate *estimates);

/* Tells whether the estimate has the sign of the volume. */
static inline bool volume_estimate_decides(const volume_estimate *e) {
    return fabs(e->volume) > e->rounding;
}

/* The sign (-1, 0, 1) of the volume that these triangles enclose, all those of a closed component: 1 where normals are
 * outwards. Where a component passes through itself, each place counts as often as the surface winds around it. */
int volume_sign_exact(const cscd_mesh *mesh, const double *positions, const uint32_t *triangles,
                      uint32_t count);

/* ---- collapsed components ---------------------------------------------------------------------------------- */

/* Components that have no surface at a moment, because none of their triangles has an area: hidden by a scale of 0, or squashed
 * to a line. */
typedef struct collapsed_components {
    const cscd_mesh *mesh;
    /* Per component one of its triangles, the last that was seen to have an area: as long as it has one, no other is
     * looked at. */
    uint32_t *witnesses;

    uint8_t *seen;  /* per component, while moments are looked at */
    bool *marks;    /* per component: it is collapsed at one of the moments that were added */
    uint32_t count; /* of marks that are set */
    uint32_t *list; /* the marked components, as collapsed_list has written them */
} collapsed_components;

/* On failure *out holds nothing. */
cscd_status collapsed_create(const cscd_mesh *mesh, collapsed_components *out);
void collapsed_free(collapsed_components *c);

/* Forgets all moments. */
void collapsed_begin(collapsed_components *c);

/* Marks the components that are collapsed at the positions, too. A wire of triangles each of which has two vertices of one
 * name is none of them: it never had a surface. names: per vertex; NULL: each has its own. Exact. */
void collapsed_add(collapsed_components *c, const double *positions, const uint32_t *names);

/* The marked components, ascending, `count` of them; NULL: none is marked. They live until marks change. */
const uint32_t *collapsed_list(collapsed_components *c);

/* Per component; NULL: none is marked. */
static inline const bool *collapsed_marks(const collapsed_components *c) {
    return c->count > 0 ? c->marks : NULL;
}
