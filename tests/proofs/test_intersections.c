/* What every call promises (tests/support/proofs/proof.h), of cscd_detector_find_intersections and of the volumes and lengths of what it
 * finds. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* ---- calls ---------------------------------------------------------------------------------------------- */

static cscd_status find_pairs(proof *p, cscd_intersection_options options) {
    cscd_view x;
    return cscd_detector_find_intersections(p->detector, at_moment(p, 2, &x), &options, &p->answer.pairs);
}

static cscd_status find_everything(proof *p) {
    return find_pairs(p, ask_everything());
}

static cscd_status find_by_part(proof *p) {
    cscd_intersection_options options = ask_everything();
    options.orientation = CSCD_ORIENTATION_BY_PART;
    options.part_bodies = true;
    return find_pairs(p, options);
}

static cscd_status find_first(proof *p) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.stop_after = 3;
    return find_pairs(p, options);
}

static cscd_status count_pairs(proof *p) {
    cscd_intersection_options options = cscd_intersection_defaults();
    options.answer = CSCD_ANSWER_COUNT;
    return find_pairs(p, options);
}

static cscd_status find_volumes(proof *p) {
    cscd_view x;
    return cscd_detector_overlap_volumes(p->detector, at_moment(p, 2, &x), NULL, &p->answer.measures);
}

static cscd_status find_lengths(proof *p) {
    cscd_view x;
    return cscd_detector_curve_lengths(p->detector, at_moment(p, 2, &x), NULL, &p->answer.measures);
}

static void read_measures(proof *p) {
    const cscd_measures *m = &p->answer.measures;
    proof_add_items(p, m->items, m->count, sizeof *m->items);
    proof_add_items(p, m->gradients, m->gradient_count, sizeof *m->gradients);
    proof_add(p, &m->sum, sizeof m->sum);
    proof_add(p, &m->unknown, sizeof m->unknown);
}

static cscd_status set_part(proof *p) {
    static const uint32_t labels[SCENE_TRIANGLES_MAX];
    return cscd_detector_set_parts(p->detector, labels, 1);
}

static const proof_call everything = {"detector_find_intersections", PROOF_ASKS, find_everything, read_pairs};
static const proof_call by_part = {"detector_find_intersections", PROOF_ASKS, find_by_part, read_pairs};
static const proof_call first = {"detector_find_intersections", PROOF_ASKS, find_first, read_pairs};
static const proof_call counted = {"detector_find_intersections", PROOF_ASKS, count_pairs, read_pairs};
static const proof_call volumes = {"detector_overlap_volumes", PROOF_ASKS, find_volumes, read_measures};
static const proof_call lengths = {"detector_curve_lengths", PROOF_ASKS, find_lengths, read_measures};
static const proof_call one_part = {"detector_set_parts", PROOF_CHANGES, set_part, NULL};

/* ---- bodies --------------------------------------------------------------------------------------------- */

static body_rig rig; /* what is added to it; large */

static void add_box(double x, double y, double z, double a, double b, double c) {
    const double low[3] = {x, y, z}, size[3] = {a, b, c};
    body_rig_add_box(&rig, low, size);
}

static void open_bodies(proof *p, cscd_detector_options options) {
    cscd_object_desc objects[BODIES_MAX];
    for (uint32_t i = 0; i < rig.body_count; i++)
        objects[i] = cscd_object_of_triangles(rig.bodies[i].vertex_count, rig.bodies[i].triangle_count,
                                              rig.bodies[i].triangles);
    p->shape = rig.all;
    memcpy(p->shape.x1, p->shape.x0, sizeof p->shape.x0);
    make_moments(p);
    proof_need(p, cscd_mesh_create(p->context, objects, rig.body_count, &p->mesh));
    open_detector_with(p, options);
}

/* A body of two boxes that cross, and a bar through both. */
static void open_boxes(proof *p) {
    body_rig_begin(&rig);
    add_box(0, 0, 0, 2, 2, 2);
    add_box(1.25, 1.5, 1.125, 2, 2, 2);
    body_rig_end_body(&rig);
    add_box(-1, 1.6, 1.2, 6, 0.25, 0.5);
    body_rig_end_body(&rig);
    open_bodies(p, cscd_detector_defaults());
}

/* Corner 7 of the first cube is in the second one, whose corner 0 is in the first one. */
static void add_cubes(void) {
    body_rig_begin(&rig);
    add_box(0, 0, 0, 2, 2, 2);
    body_rig_end_body(&rig);
    add_box(1.25, 1.5, 1.125, 2, 2, 2);
    body_rig_end_body(&rig);
}

/* Some pairs of their triangles are left out, so their curve has gaps. */
static void open_gaps(proof *p) {
    uint32_t ignored[24][2];
    for (uint32_t i = 0; i < 24; i++) {
        ignored[i][0] = i % 12;
        ignored[i][1] = 12 + i / 12;
    }
    cscd_detector_options options = cscd_detector_defaults();
    options.ignored = ignored[0];
    options.ignored_count = 24;
    add_cubes();
    open_bodies(p, options);
}

/* Seams join corners that are far apart. */
static void open_seams(proof *p) {
    static const uint32_t seams[3][2] = {{0, 7}, {7, 1}, {1, 6}};
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = seams[0];
    options.seam_count = 3;
    options.seam_reach = INFINITY;
    add_cubes();
    open_bodies(p, options);
}

/* Three cubes in each other, the middle one inside out, and a small one in the middle. */
static void open_shells(proof *p) {
    body_rig_begin(&rig);
    add_box(-2, -2, -2, 4, 4, 4);
    add_box(-1, -1, -1, 2, 2, 2);
    add_box(-0.5, -0.5, -0.5, 1, 1, 1);
    body_rig_end_body(&rig);
    add_box(-0.125, -0.125, -0.125, 0.25, 0.25, 0.25);
    body_rig_end_body(&rig);
    body_rig_turn(&rig, 12, 12);
    open_bodies(p, cscd_detector_defaults());
}

/* A post through a sheet, of which it cuts something off. */
static void open_post(proof *p) {
    static const double corner[3] = {0, 0, 0}, along[3] = {4, 0, 0}, up[3] = {0, 4, 0};
    body_rig_begin(&rig);
    body_rig_add_sheet(&rig, corner, along, up, 7, 9, false);
    body_rig_end_body(&rig);
    add_box(0.3, 0.4, -1, 2, 1.5, 2);
    body_rig_end_body(&rig);
    open_bodies(p, cscd_detector_defaults());
}

/* ---- the table ------------------------------------------------------------------------------------------ */

static const proof_row rows[] = {
    {"spheres", {&everything, &first, &counted}, open_detector, .family = SCENE_TWO_SPHERES},
    {"sheet", {&everything, &lengths, &step_back}, open_detector, .family = SCENE_FOLDED_SHEET, .seed = 7},
    {"measures", {&volumes, &lengths}, open_detector, .family = SCENE_TWO_SPHERES},
    {"ignore", {&everything, &first, &counted}, open_ignoring, .family = SCENE_TWO_SPHERES},
    {"boxes", {&everything, &volumes, &by_part, &lengths}, open_boxes, .seed = 0},
    {"gaps", {&volumes, &everything, &lengths}, open_gaps, .seed = 0},
    {"seams", {&everything}, open_seams, .seed = 0},
    {"shells", {&one_part, &by_part, &everything}, open_shells, .seed = 0},
    {"post", {&lengths, &everything, &volumes}, open_post, .seed = 0},
};

PROOFS(rows)
