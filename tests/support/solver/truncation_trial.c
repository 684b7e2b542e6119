/* What the tests of truncation share: a detector with a separation, two triangles, and a call in either scalar. */
#include "tests/support/solver/truncation_trial.h"

#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

rig rig_apart(const scene *s, double apart, cscd_method method, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = apart;
    options.method = method_or_none(method);
    options.ours = ours_of_method(options.method);
    return rig_create(s, threads, &options);
}

void scene_two_triangles(scene *s, double apart) {
    static const double corners[3][2] = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
    s->vertex_count = 6;
    s->triangle_count = 2;
    for (uint32_t i = 0; i < 6; i++) {
        s->triangles[i] = i;
        s->x0[3 * i] = corners[i % 3][0];
        s->x0[3 * i + 1] = corners[i % 3][1];
        s->x0[3 * i + 2] = i < 3 ? 0.0 : apart;
    }
    memcpy(s->x1, s->x0, sizeof s->x1);
}

static void narrow_positions(const scene *s, const double *from, float *to) {
    for (size_t i = 0; i < (size_t)s->vertex_count * 3; i++) to[i] = (float)from[i];
}

cscd_truncation truncate_scene(const rig *r, const scene *s, double radius, cscd_scalar scalar, double *end) {
    static float x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    cscd_truncation out;
    uint32_t count = s->vertex_count;
    if (scalar == CSCD_SCALAR_DOUBLE) {
        expect_ok(truncate_packed(r->detector, s->x0, s->x1, radius, end, &out));
        return out;
    }
    narrow_positions(s, s->x0, x0);
    narrow_positions(s, s->x1, x1);
    expect_ok(cscd_detector_truncate(r->detector, CSCD_FLOATS(x0, count), CSCD_FLOATS(x1, count), radius,
                                     CSCD_MUTABLE_FLOATS(x1, count), &out));
    for (size_t i = 0; i < (size_t)count * 3; i++) end[i] = (double)x1[i];
    return out;
}
