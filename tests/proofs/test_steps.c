/* What every call promises (tests/support/proofs/proof.h), of steps and checks of a detector. */
#include "cscd/research.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#define STEPS                                                                                                \
    { &step_first, &step_second, &step_third, &step_back }

static void open_separated(proof *p) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.01;
    open_detector_with(p, options);
}

static void open_earliest(proof *p) {
    cscd_detector_options options = cscd_detector_defaults();
    options.mode = CSCD_MODE_EARLIEST;
    open_detector_with(p, options);
}

static void open_planned(proof *p) {
    cscd_plan_options options = cscd_plan_defaults();
    cscd_view x;
    options.method = CSCD_METHOD_KMEANS;
    open_mesh(p);
    proof_need(p, cscd_plan_create(p->context, p->mesh, at_moment(p, 0, &x), &options, &p->plan));
    open_detector(p);
}

/* ---- checks --------------------------------------------------------------------------------------------- */

static void read_check(proof *p) {
    const cscd_intersections *c = &p->answer.pairs;
    proof_add(p, &c->zero_area_triangles, sizeof c->zero_area_triangles);
    proof_add_items(p, c->items, c->count, sizeof *c->items);
}

static cscd_status check_at(proof *p, int moment) {
    cscd_view x;
    return cscd_detector_check(p->detector, at_moment(p, moment, &x), &p->answer.pairs);
}

static cscd_status check_start(proof *p) {
    return check_at(p, 0);
}

static cscd_status check_end(proof *p) {
    return check_at(p, 3);
}

static const proof_call start_check = {"detector_find_intersections", PROOF_ASKS, check_start, read_check};
static const proof_call end_check = {"detector_find_intersections", PROOF_ASKS, check_end, read_check};

/* ---- the table ------------------------------------------------------------------------------------------ */

static const proof_row rows[] = {
    {"step", STEPS, open_detector, .family = SCENE_BENT_CAPSULE, .seed = 3},
    {"step_ignore", STEPS, open_ignoring, .family = SCENE_TWO_SPHERES},
    {"step_open", STEPS, open_detector, .family = SCENE_FOLDED_SHEET, .seed = 7},
    {"step_soup", STEPS, open_detector, .family = SCENE_SOUP, .seed = 11},
    {"step_bow_tie", STEPS, open_detector, .family = SCENE_BOW_TIE, .seed = 3},
    {"step_separation", STEPS, open_separated, .family = SCENE_TWO_SPHERES},
    {"step_earliest", STEPS, open_earliest, .family = SCENE_TWO_SPHERES},
    {"step_planned", STEPS, open_planned, .family = SCENE_TWO_SPHERES},
    {"step_none", STEPS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_NONE},
    {"step_brute", STEPS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_BRUTE},
    {"step_iccd", STEPS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_ICCD},
    {"step_cones", STEPS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_CONES},
    {"step_published", STEPS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_PUBLISHED},
    {"step_iccd_published", STEPS, open_detector, .family = SCENE_SOUP, .seed = 11,
     .method = CSCD_METHOD_ICCD_PUBLISHED},
    {"check", {&start_check, &end_check, &step_back}, open_detector, .family = SCENE_TWO_SPHERES},
    {"check_ignore",
     {&start_check, &end_check, &step_back},
     open_ignoring,
     .family = SCENE_FOLDED_SHEET,
     .seed = 7},
};

PROOFS(rows)
