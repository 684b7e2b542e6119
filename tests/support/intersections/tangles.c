/* Bodies of which nearly all triangles cross each other. */
#include "tests/support/intersections/tangles.h"

#include "tests/support/random.h"

/* Puts the vertices of a body in another order, as a file does that was exported from another mesh. */
static void shuffle_vertices(scene *s, uint32_t first, uint32_t count, uint64_t seed) {
    random_stream random = stream_start(seed);
    for (uint32_t i = count; i > 1; i--) {
        double *a = &s->x0[(size_t)(first + i - 1) * 3],
               *b = &s->x0[(size_t)(first + stream_below(&random, i)) * 3];
        for (int k = 0; k < 3; k++) {
            double x = a[k];
            a[k] = b[k];
            b[k] = x;
        }
    }
}

void tangle_add_shuffled(body_rig *r, int rings, int segments) {
    static const double origin[3] = {0, 0, 0}, beside[3] = {0.5, 0.25, 0.125};
    body_rig_begin(r);
    scene_add_sphere(&r->all, origin, 1.0, rings, segments);
    shuffle_vertices(&r->all, 0, r->all.vertex_count, 1);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, beside, 0.75, 4, 6);
    body_rig_end_body(r);
}

void tangle_add_soup(body_rig *r, uint32_t triangles) {
    random_stream random = stream_start(2);
    body_rig_begin(r);
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        for (int k = 0; k < 3; k++) r->all.x0[3 * i + (uint32_t)k] = stream_between(&random, 0.0, 1.0);
        r->all.triangles[i] = i;
    }
    r->all.vertex_count = 3 * triangles;
    r->all.triangle_count = triangles;
    body_rig_end_body(r);
}
