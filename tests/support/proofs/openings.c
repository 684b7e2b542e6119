/* How rows of proofs find what their calls need. */
#include "tests/support/proofs/openings.h"

#include "cscd/research.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"
#include "tests/support/workload.h"

#include <string.h>

enum { RINGS = PACED(22, 14), SEGMENTS = PACED(22, 14) };

/* ---- scenes --------------------------------------------------------------------------------------------- */

/* A tube bends until it touches itself. */
static void make_tube(proof *p) {
    static sequence tube;
    workload_tube(&tube, 2 * RINGS, SEGMENTS, PROOF_MOMENTS);
    p->shape = tube.shape;
    memcpy(p->x, tube.frames, sizeof p->x);
}

/* Two spheres go through each other. */
static void make_spheres(proof *p) {
    static const double centres[2][3] = {{-1.1, 0.1, 0.0}, {1.1, 0.0, 0.1}};
    scene_clear(&p->shape);
    for (int i = 0; i < 2; i++)
        scene_add_sphere(&p->shape, centres[i], 1.0, p->large ? RINGS : 5, p->large ? SEGMENTS : 8);
    for (uint32_t v = 0; v < p->shape.vertex_count; v++)
        p->shape.x1[3 * v] += v < p->shape.vertex_count / 2 ? 0.3 : -0.3;
}

void make_moments(proof *p) {
    for (int m = 0; m < PROOF_MOMENTS; m++) {
        for (uint32_t i = 0; i < p->shape.vertex_count * 3; i++)
            p->x[m][i] = p->shape.x0[i] + 0.5 * m * (p->shape.x1[i] - p->shape.x0[i]);
    }
}

void open_shape(proof *p) {
    const bool spheres = p->row->family == SCENE_TWO_SPHERES;
    if (p->large && !spheres) {
        make_tube(p);
        return;
    }
    if (spheres)
        make_spheres(p);
    else
        scene_make(p->row->family, p->row->seed, &p->shape);
    make_moments(p);
}

/* ---- objects -------------------------------------------------------------------------------------------- */

void describe_objects(const proof *p, cscd_object_desc out[2], uint32_t *count) {
    static uint32_t second[SCENE_TRIANGLES_MAX * 3];
    const scene *s = &p->shape;
    const uint32_t vertices = s->vertex_count / 2, triangles = s->triangle_count / 2;
    *count = p->row->family == SCENE_TWO_SPHERES ? 2 : 1;
    out[0] = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    if (*count == 1) return;
    for (uint32_t i = 0; i < triangles * 3; i++) second[i] = s->triangles[triangles * 3 + i] - vertices;
    out[0] = cscd_object_of_triangles(vertices, triangles, s->triangles);
    out[1] = cscd_object_of_triangles(vertices, triangles, second);
}

void open_mesh(proof *p) {
    cscd_object_desc objects[2];
    uint32_t count;
    open_shape(p);
    describe_objects(p, objects, &count);
    proof_need(p, cscd_mesh_create(p->context, objects, count, &p->mesh));
}

void open_detector_with(proof *p, cscd_detector_options options) {
    if (p->mesh == NULL) open_mesh(p);
    options.method = method_or_none(p->row->method);
    options.ours = ours_of_method(options.method);
    if (options.method == CSCD_METHOD_PUBLISHED) options.ours |= CSCD_OURS_STARTS; /* its proof shares work */
    proof_need(p, cscd_detector_create(p->context, p->mesh, p->plan, &options, &p->detector));
}

void open_detector(proof *p) {
    open_detector_with(p, cscd_detector_defaults());
}

void open_ignoring(proof *p) {
    cscd_detector_options options = cscd_detector_defaults();
    options.ignore = proof_ignore;
    options.ignore_user = p;
    open_detector_with(p, options);
}

const cscd_view *at_moment(const proof *p, int moment, cscd_view *view) {
    *view = cscd_view_doubles(p->x[moment], p->shape.vertex_count);
    return view;
}
