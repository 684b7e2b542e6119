/* Pairs that only touch, or lie in one plane. No curve leads through them, so no lens says how to part them: they part along a
 * normal. */
#include "runtime/ccd/ccd.h"
#include "runtime/untangle/lenses.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* Which points belong to a flush pair, in edge lengths. */
static const double flush_distance = 1e-3;

/* Along which normal a pair parts: vertices of triangle `first` go by `sign` times the normal of triangle `of`, others the other way. */
typedef struct parting {
    uint32_t first, second, of;
    double sign;
} parting;

static bool is_closed(const cscd_mesh *mesh, uint32_t component) {
    return mesh->components[component].closed_manifold;
}

/* Of two components, one is the reference: the closed one, else the first. It goes inwards, and the other one outwards. Within a
 * component each goes to the outside of the other. */
static parting choose_parting(const cscd_mesh *mesh, const cscd_intersection *pair, bool second) {
    const uint32_t mine = second ? pair->b : pair->a, other = second ? pair->a : pair->b;
    const uint32_t of_mine = pair->components[second ? 1 : 0], of_other = pair->components[second ? 0 : 1];
    if (of_mine == of_other) return (parting){mine, other, other, 1.0};
    const bool closed_mine = is_closed(mesh, of_mine), closed_other = is_closed(mesh, of_other);
    const bool reference = closed_mine != closed_other ? closed_mine : of_mine < of_other;
    return (parting){mine, other, reference ? mine : other, reference ? -1.0 : 1.0};
}

static bool shares_vertex(const lens_finder *f, const uint32_t *corners, uint32_t v) {
    const uint32_t *names = f->w->graph.names;
    return names[corners[0]] == names[v] || names[corners[1]] == names[v] || names[corners[2]] == names[v];
}

/* Adds the corners of the first triangle that lie on the second one. */
static bool add_corners(lens_finder *f, const double *x, const parting *way) {
    const uint32_t *corners = f->w->mesh->triangles[way->second];
    const double near = flush_distance * f->w->graph.edge_length;
    double normal[3];
    lens_normal(f, x, way->of, normal);
    for (int k = 0; k < 3; k++) {
        const uint32_t v = f->w->mesh->triangles[way->first][k];
        double u, w;
        if (shares_vertex(f, corners, v)) continue;
        const double squared =
            closest_point_triangle(x + 3 * (size_t)v, x + 3 * (size_t)corners[0], x + 3 * (size_t)corners[1],
                                   x + 3 * (size_t)corners[2], &u, &w);
        if (squared > near * near) continue;
        lens_point point = {.vertices = {v, v, corners[0], corners[1], corners[2]},
                            .weights = {1.0, 0.0, u + w - 1.0, -u, -w},
                            .along_normal = true,
                            .reason = CSCD_LENS_FLUSH,
                            .group = UINT32_MAX,
                            .edge = UINT32_MAX,
                            .triangle = way->second};
        for (int i = 0; i < 3; i++) point.direction[i] = way->sign * normal[i];
        if (!lens_finder_add_point(f, &point)) return false;
    }
    return true;
}

bool flush_pairs_add(lens_finder *f, const cscd_intersections *found, const double *x) {
    for (size_t i = 0; i < found->count; i++) {
        if (found->curves->pair_curves[i] != UINT32_MAX) continue;
        for (int second = 0; second < 2; second++) {
            const parting way = choose_parting(f->w->mesh, &found->items[i], second == 1);
            if (!add_corners(f, x, &way)) return false;
        }
    }
    return true;
}
