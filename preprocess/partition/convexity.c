/* Finds the convex components. */
#include "preprocess/partition/convexity.h"
#include "src/mesh/surface.h"

static const double tolerance = 1e-6;

/* The largest distance of a vertex from the first one of its component. */
typedef struct extent {
    const double *first;
    double size;
} extent;

static void find_extents(const cscd_mesh *mesh, const double *positions, extent *extents) {
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        extent *e = &extents[mesh->triangle_components[t]];
        if (e->first == NULL) e->first = surface_corner(mesh, positions, t, 0);
        for (uint32_t corner = 0; corner < 3; corner++) {
            const double *p = surface_corner(mesh, positions, t, corner);
            double d[3] = {p[0] - e->first[0], p[1] - e->first[1], p[2] - e->first[2]};
            e->size = fmax(e->size, surface_norm(d));
        }
    }
}

/* How far the corners of a triangle, which shares two of them with `plane`, lie outside the plane of that
 * triangle. */
static double distance_outside(const cscd_mesh *mesh, const double *positions, uint32_t triangle,
                               uint32_t plane) {
    double normal[3], farthest = 0.0;
    surface_normal(mesh, positions, plane, normal);
    double norm = surface_norm(normal);
    if (norm == 0.0) return 0.0;
    const double *origin = surface_corner(mesh, positions, plane, 0);
    for (uint32_t corner = 0; corner < 3; corner++) {
        const double *p = surface_corner(mesh, positions, triangle, corner);
        if (triangle_contains(mesh->triangles[plane], mesh->triangles[triangle][corner])) continue;
        double distance = 0.0;
        for (int k = 0; k < 3; k++) distance += (p[k] - origin[k]) * (normal[k] / norm);
        farthest = fmax(farthest, distance);
    }
    return farthest;
}

cscd_status find_convex_components(const cscd_mesh *mesh, const double *positions, bool *convex) {
    extent *extents = context_allocate(mesh->context, mesh->component_count, sizeof *extents);
    if (extents == NULL) return context_out_of_memory(mesh->context);
    find_extents(mesh, positions, extents);
    for (uint32_t c = 0; c < mesh->component_count; c++)
        convex[c] = mesh->components[c].closed_manifold && mesh->components[c].euler_characteristic == 2;
    for (uint32_t edge = 0; edge < mesh->edge_count; edge++) {
        const uint32_t *star = mesh->edge_stars + mesh->edge_star_offsets[edge];
        uint32_t c = mesh->triangle_components[star[0]];
        if (!convex[c]) continue;
        double allowed = tolerance * extents[c].size;
        convex[c] = distance_outside(mesh, positions, star[0], star[1]) <= allowed &&
                    distance_outside(mesh, positions, star[1], star[0]) <= allowed;
    }
    context_free(mesh->context, extents);
    return CSCD_OK;
}
