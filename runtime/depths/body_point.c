/* Whether a point lies on the surface of a body, exactly. */
#include "runtime/depths/body_point.h"

#include "src/core/vec3.h"
#include "src/mesh/predicates.h"
#include "src/mesh/surface.h"

typedef struct body_point_search {
    const named_surface *surface;
    uint32_t body;
    const double *x;
    bool found;
} body_point_search;

/* In every projection the point turns the same way about all sides, or lies on them. */
static bool lies_in_projections(const double *x, const double *const corners[3]) {
    bool flat = true;
    for (int k = 0; k < 3; k++) {
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        bool left = false, right = false;
        for (int i = 0; i < 3; i++) {
            const double *a = corners[i], *b = corners[(i + 1) % 3];
            int turn = orient2d(a[u], a[v], b[u], b[v], x[u], x[v]);
            left |= turn > 0;
            right |= turn < 0;
        }
        if (left && right) return false;
        flat &= !left && !right;
    }
    return !flat || vec3_squared_distance(x, corners[0]) == 0.0;
}

static void look_for_point(void *data, uint32_t triangle) {
    body_point_search *s = data;
    const named_surface *surface = s->surface;
    if (s->found || surface_body(surface, triangle) != s->body) return;
    const double *corners[3];
    for (uint32_t i = 0; i < 3; i++)
        corners[i] = surface_corner(surface->mesh, surface->positions, triangle, i);
    s->found = orient3d(corners[0], corners[1], corners[2], s->x) == 0 && lies_in_projections(s->x, corners);
}

bool body_has_point(const named_surface *s, const bvh *f, uint32_t body, const double x[3]) {
    body_point_search search = {s, body, x, false};
    const query_box box = {{x[0], x[1], x[2]}, {x[0], x[1], x[2]}};
    bvh_visit_box(f, &box, true, look_for_point, &search);
    return search.found;
}
