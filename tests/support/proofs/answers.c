/* What of an answer the proofs compare, and calls that several tables make. */
#include "tests/support/proofs/answers.h"

#include "tests/support/proofs/openings.h"

#include <math.h>

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
