/* How rows of proofs find what their calls need, what of an answer they compare, and calls that several tables make. */
#include "tests/support/proofs/openings.h"

#include "cscd/research.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"
#include "tests/support/workload.h"

#include <math.h>
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

/* ---- answers ------------------------------------------------------------------------------------------- */

static void add_waiting(proof *p) {
    const cscd_waiting waiting = cscd_detector_waiting(p->detector);
    proof_add(p, &waiting, sizeof waiting);
}

void read_contacts(proof *p) {
    const cscd_contacts *c = &p->answer.contacts;
    proof_add_items(p, c->items, c->count, sizeof *c->items);
    add_waiting(p);
    for (uint32_t i = 0; i < cscd_mesh_component_count(p->mesh); i++) {
        const cscd_guarantee g = cscd_detector_guarantee(p->detector, i);
        proof_add(p, &g.complete, sizeof g.complete);
    }
}

void read_near(proof *p) {
    proof_add_items(p, p->answer.near.items, p->answer.near.count, sizeof *p->answer.near.items);
}

void read_reached(proof *p) {
    proof_add_items(p, p->reached, p->shape.vertex_count, sizeof(double[3]));
}

void read_step(proof *p) {
    proof_add(p, &p->answer.step.fraction, sizeof p->answer.step.fraction);
    proof_add(p, &p->answer.step.limited, sizeof p->answer.step.limited);
    read_reached(p);
}

/* ---- intersections -------------------------------------------------------------------------------------- */

cscd_intersection_options ask_everything(void) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = options.patches = options.overlaps = options.depths = options.parts = options.cut_offs =
        true;
    return options;
}

static void read_curves(proof *p, const cscd_curves *c) {
    proof_add_items(p, c->items, c->count, sizeof *c->items);
    proof_add_items(p, c->points, c->point_count, sizeof *c->points);
    proof_add_items(p, c->pieces, c->piece_count, sizeof *c->pieces);
    proof_add_items(p, c->pair_curves, c->pair_count, sizeof *c->pair_curves);
}

static void read_patches(proof *p, const cscd_patches *c) {
    const size_t vertices = cscd_mesh_vertex_count(p->mesh), triangles = cscd_mesh_triangle_count(p->mesh);
    proof_add_items(p, c->items, c->count, sizeof *c->items);
    proof_add_items(p, c->windings, c->winding_count, sizeof *c->windings);
    proof_add_items(p, c->vertex_patches, vertices, sizeof *c->vertex_patches);
    proof_add_items(p, c->triangle_patches, triangles, sizeof *c->triangle_patches);
    proof_add_items(p, c->corner_patches, 3 * triangles, sizeof *c->corner_patches);
    if (c->turned != NULL) proof_add(p, c->turned, cscd_mesh_component_count(p->mesh) * sizeof *c->turned);
}

static void read_overlaps(proof *p, const cscd_overlaps *c) {
    for (size_t i = 0; i < c->count; i++) {
        cscd_overlap one = c->items[i];
        if (isnan(one.volume)) one.volume = -1.0; /* not known; there are several NaN */
        proof_add(p, &one, sizeof one);
    }
}

void read_pairs(proof *p) {
    const cscd_intersections *c = &p->answer.pairs;
    proof_add_items(p, c->items, c->count, sizeof *c->items);
    proof_add(p, &c->zero_area_triangles, sizeof c->zero_area_triangles);
    add_waiting(p);
    if (c->curves != NULL) read_curves(p, c->curves);
    if (c->patches != NULL) read_patches(p, c->patches);
    if (c->overlaps != NULL) read_overlaps(p, c->overlaps);
    if (c->depths != NULL) {
        proof_add_items(p, c->depths->items, c->depths->count, sizeof *c->depths->items);
        proof_add_items(p, c->depths->patches, c->depths->patch_count, sizeof *c->depths->patches);
    }
    if (c->cut_offs != NULL)
        proof_add_items(p, c->cut_offs->items, c->cut_offs->count, sizeof *c->cut_offs->items);
    if (c->parts != NULL) proof_add_items(p, c->parts->items, c->parts->count, sizeof *c->parts->items);
}

/* ---- steps ---------------------------------------------------------------------------------------------- */

static cscd_status step_between(proof *p, int from, int to) {
    cscd_view x0, x1;
    return cscd_detector_step(p->detector, at_moment(p, from, &x0), at_moment(p, to, &x1),
                              &p->answer.contacts);
}

static cscd_status make_first(proof *p) {
    return step_between(p, 0, 1);
}

static cscd_status make_second(proof *p) {
    return step_between(p, 1, 2);
}

static cscd_status make_third(proof *p) {
    return step_between(p, 2, 3);
}

static cscd_status make_back(proof *p) {
    return step_between(p, 3, 0);
}

const proof_call step_first = {"detector_step", PROOF_ASKS, make_first, read_contacts};
const proof_call step_second = {"detector_step", PROOF_ASKS, make_second, read_contacts};
const proof_call step_third = {"detector_step", PROOF_ASKS, make_third, read_contacts};
const proof_call step_back = {"detector_step", PROOF_ASKS, make_back, read_contacts};
