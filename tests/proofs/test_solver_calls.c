/* What every call promises (tests/support/proofs/proof.h), of those that solvers make. */
#include "cscd/research.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#include <string.h>

static double near_of(const proof *p) {
    return p->large ? 0.05 : 0.3;
}

static const cscd_mutable_view *reached_of(proof *p, cscd_mutable_view *view) {
    *view = cscd_mutable_view_doubles(p->reached, p->shape.vertex_count);
    return view;
}

/* ---- one moment ----------------------------------------------------------------------------------------- */

static cscd_status find_near(proof *p, cscd_near_form form) {
    cscd_view x;
    return cscd_detector_find_near(p->detector, at_moment(p, 1, &x), near_of(p), form, &p->answer.near);
}

static cscd_status find_pairs(proof *p) {
    return find_near(p, CSCD_NEAR_PAIRS);
}

static cscd_status find_unique(proof *p) {
    return find_near(p, CSCD_NEAR_UNIQUE);
}

static cscd_status set_rest(proof *p) {
    cscd_view x;
    return cscd_detector_set_rest(p->detector, at_moment(p, 0, &x));
}

static cscd_status bound_displacements(proof *p) {
    cscd_view x;
    return cscd_detector_displacement_bounds(p->detector, at_moment(p, 0, &x), near_of(p), CSCD_SCALAR_DOUBLE,
                                             p->reached, p->shape.vertex_count * sizeof *p->reached,
                                             &p->answer.bounds);
}

static void read_bounds(proof *p) {
    proof_add(p, &p->answer.bounds.least, sizeof p->answer.bounds.least);
    proof_add_items(p, p->reached, p->shape.vertex_count, sizeof *p->reached);
}

static const proof_call near_pairs = {"detector_find_near", PROOF_ASKS, find_pairs, read_near};
static const proof_call near_unique = {"detector_find_near", PROOF_ASKS, find_unique, read_near};
static const proof_call rest = {"detector_set_rest", PROOF_CHANGES, set_rest, NULL};
static const proof_call bounds = {"detector_displacement_bounds", PROOF_ASKS, bound_displacements,
                                  read_bounds};

/* ---- on the way ----------------------------------------------------------------------------------------- */

static cscd_status go_free(proof *p) {
    cscd_view x0, x1;
    cscd_mutable_view end;
    const cscd_status status = cscd_detector_max_step(p->detector, at_moment(p, 0, &x0), at_moment(p, 3, &x1),
                                                      reached_of(p, &end), &p->answer.step);
    if (status != CSCD_IN_CONTACT) return status;
    p->answer.step = (cscd_free_step){.fraction = -1.0}; /* an answer, too */
    return CSCD_OK;
}

static cscd_status truncate_motion(proof *p) {
    cscd_view x0, x1;
    cscd_mutable_view end;
    return cscd_detector_truncate(p->detector, at_moment(p, 0, &x0), at_moment(p, 2, &x1), near_of(p),
                                  reached_of(p, &end), &p->answer.truncation);
}

static void read_truncation(proof *p) {
    proof_add(p, &p->answer.truncation.fraction, sizeof p->answer.truncation.fraction);
    proof_add(p, &p->answer.truncation.near_count, sizeof p->answer.truncation.near_count);
    read_reached(p);
}

static cscd_status make_motion_safe(proof *p) {
    cscd_view x0, x1;
    cscd_mutable_view end;
    return cscd_detector_make_safe(p->detector, at_moment(p, 0, &x0), at_moment(p, 3, &x1), NULL,
                                   reached_of(p, &end), &p->answer.safe);
}

static void read_safe_motion(proof *p) {
    const cscd_safe_motion *safe = &p->answer.safe;
    proof_add(p, safe->responses, p->shape.vertex_count);
    proof_add(p, &safe->mean_share, sizeof safe->mean_share);
    proof_add(p, &safe->rounds, sizeof safe->rounds);
    proof_add_items(p, safe->held, safe->held_count, sizeof *safe->held);
    read_reached(p);
}

static const proof_call safe_motion = {"detector_make_safe", PROOF_ASKS, make_motion_safe, read_safe_motion};
static const proof_call max_step = {"detector_max_step", PROOF_ASKS, go_free, read_step};
static const proof_call truncation = {"detector_truncate", PROOF_ASKS, truncate_motion, read_truncation};

/* Where the host cancels, the answer is the best so far, which is another one. */
static cscd_status untangle_moment(proof *p) {
    static double best[SCENE_VERTICES_MAX * 3];
    const cscd_mutable_view end = cscd_mutable_view_doubles(best, p->shape.vertex_count);
    cscd_view x;
    cscd_untangled found;
    cscd_untangle_options options = cscd_untangle_defaults();
    options.max_rounds = 3;
    options.max_steps = 2;
    const cscd_status status =
        cscd_detector_untangle(p->detector, at_moment(p, 3, &x), &options, &end, &found);
    if (status != CSCD_OK) return status;
    if (found.stopped) return CSCD_CANCELLED;
    memcpy(p->reached, best, p->shape.vertex_count * sizeof(double[3]));
    p->answer.untangled = found;
    return CSCD_OK;
}

static void read_untangled(proof *p) {
    proof_add(p, &p->answer.untangled, sizeof p->answer.untangled);
    read_reached(p);
}

static const proof_call untangling = {"detector_untangle", PROOF_ASKS, untangle_moment, read_untangled};

static cscd_status find_lenses(proof *p) {
    cscd_view x;
    return cscd_detector_find_lenses(p->detector, at_moment(p, 3, &x), NULL, &p->answer.lenses);
}

static void read_lenses(proof *p) {
    const cscd_lenses *found = &p->answer.lenses;
    proof_add(p, &found->thickness, sizeof found->thickness);
    proof_add(p, &found->pairs, sizeof found->pairs);
    proof_add(p, &found->undecided, sizeof found->undecided);
    proof_add_items(p, found->items, found->count, sizeof *found->items);
    proof_add_items(p, found->points, found->point_count, sizeof *found->points);
}

static const proof_call lenses = {"detector_find_lenses", PROOF_ASKS, find_lenses, read_lenses};

/* ---- a line --------------------------------------------------------------------------------------------- */

static cscd_status create_line(proof *p) {
    return cscd_line_search_create(p->detector, &p->answer.line);
}

static void keep_line(proof *p) {
    p->line = p->answer.line;
}

static cscd_status begin_line(proof *p) {
    cscd_view x0, x1;
    return cscd_line_search_begin(p->line, at_moment(p, 0, &x0), at_moment(p, 3, &x1), near_of(p));
}

static cscd_status begin_short(proof *p) {
    cscd_view x0, x1;
    return cscd_line_search_begin(p->line, at_moment(p, 0, &x0), at_moment(p, 1, &x1), 0.0);
}

static void read_candidates(proof *p) {
    const size_t count = cscd_line_search_candidate_count(p->line);
    proof_add(p, &count, sizeof count);
}

static cscd_status list_candidates(proof *p) {
    return cscd_line_search_candidates(p->line, &p->answer.candidates);
}

static void read_list(proof *p) {
    proof_add_items(p, p->answer.candidates.items, p->answer.candidates.count, sizeof(cscd_candidate));
}

static cscd_status write_positions(proof *p) {
    cscd_mutable_view x;
    return cscd_line_search_positions(p->line, 0.3, reached_of(p, &x));
}

static cscd_status go_along(proof *p) {
    cscd_mutable_view end;
    return cscd_line_search_max_step(p->line, 0.7, reached_of(p, &end), &p->answer.step);
}

static cscd_status find_on_line(proof *p) {
    return cscd_line_search_find_near(p->line, 0.2, near_of(p), CSCD_NEAR_PAIRS, &p->answer.near);
}

static const proof_call line_create = {"line_search_create", PROOF_CREATES, create_line, keep_line};
static const proof_call line_begin = {"line_search_begin", PROOF_BEGINS, begin_line, read_candidates};
static const proof_call line_again = {"line_search_begin", PROOF_BEGINS, begin_short, read_candidates};
static const proof_call line_list = {"line_search_candidates", PROOF_ASKS, list_candidates, read_list};
static const proof_call line_positions = {"line_search_positions", PROOF_ASKS, write_positions, read_reached};
static const proof_call line_step = {"line_search_max_step", PROOF_ASKS, go_along, read_step};
static const proof_call line_near = {"line_search_find_near", PROOF_ASKS, find_on_line, read_near};

/* ---- loose features ------------------------------------------------------------------------------------- */

/* Wires, points and half-spaces; with the seed 1 triangles, too. */
static void open_loose(proof *p) {
    static loose_scene loose; /* large */
    const loose_recipe recipe = {.triangles = p->row->seed == 1,
                                 .wires = true,
                                 .points = true,
                                 .half_spaces = true,
                                 .thickness = true,
                                 .motion = 1.5};
    random_stream random = stream_start(500);
    loose_scene_make(&loose, &recipe, &random, 1, CSCD_SIMD_AUTO);
    p->shape.vertex_count = loose.vertex_count;
    memcpy(p->shape.x0, loose.x0, loose.vertex_count * sizeof(double[3]));
    memcpy(p->shape.x1, loose.x1, loose.vertex_count * sizeof(double[3]));
    make_moments(p);
    proof_need(p, cscd_mesh_create(p->context, loose.objects, loose.object_count, &p->mesh));
    open_detector_with(p, loose_scene_options(&loose));
    loose_scene_free(&loose);
}

/* ---- the table ------------------------------------------------------------------------------------------ */

#define ALL_CALLS                                                                                            \
    {                                                                                                        \
        &rest, &line_create, &line_begin, &near_pairs, &near_unique, &bounds, &max_step, &truncation,        \
            &safe_motion, &line_list, &line_positions, &line_step, &line_near, &step_back                    \
    }
#define FAMILY_CALLS                                                                                         \
    { &step_first, &near_pairs, &near_unique, &step_second, &step_back }
#define LOOSE_CALLS                                                                                          \
    {                                                                                                        \
        &rest, &line_create, &line_begin, &near_pairs, &near_unique, &bounds, &max_step, &truncation,        \
            &safe_motion, &line_list, &line_near, &step_first, &step_back                                    \
    }

static const proof_row rows[] = {
    {"near", {&near_pairs}, open_detector, .family = SCENE_TWO_SPHERES},
    {"unique", {&near_unique}, open_detector, .family = SCENE_TWO_SPHERES},
    {"bounds", {&bounds}, open_detector, .family = SCENE_TWO_SPHERES},
    {"max_step", {&max_step}, open_detector, .family = SCENE_TWO_SPHERES},
    {"truncation", {&truncation}, open_detector, .family = SCENE_TWO_SPHERES},
    {"safe motion", {&safe_motion}, open_detector, .family = SCENE_TWO_SPHERES},
    {"untangling",
     {&untangling},
     open_detector,
     .family = SCENE_TWO_SPHERES,
     .allocates = "the memory of one call may be large, and is given back"},
    {"lenses",
     {&lenses},
     open_detector,
     .family = SCENE_TWO_SPHERES,
     .allocates = "the memory of one call may be large, and is given back"},
    {"line",
     {&line_create, &line_begin, &line_list, &line_near, &line_step, &line_again},
     open_detector,
     .family = SCENE_TWO_SPHERES},
    {"single", ALL_CALLS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_SINGLE},
    {"none", ALL_CALLS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_NONE},
    {"ignore", ALL_CALLS, open_ignoring, .family = SCENE_TWO_SPHERES},
    {"iccd", ALL_CALLS, open_detector, .family = SCENE_TWO_SPHERES, .method = CSCD_METHOD_ICCD},
    {"brute",
     {&line_create, &line_begin, &near_pairs, &max_step, &line_near},
     open_detector,
     .family = SCENE_TWO_SPHERES,
     .method = CSCD_METHOD_BRUTE},
    {"tori", FAMILY_CALLS, open_detector, .family = SCENE_LINKED_TORI, .seed = 4},
    {"spike", FAMILY_CALLS, open_detector, .family = SCENE_SPIKE, .seed = 4},
    {"grid", FAMILY_CALLS, open_detector, .family = SCENE_GRID, .seed = 4},
    {"far_away", FAMILY_CALLS, open_detector, .family = SCENE_FAR_AWAY, .seed = 4},
    {"loose", LOOSE_CALLS, open_loose, .seed = 0},
    {"loose_and_triangles", LOOSE_CALLS, open_loose, .seed = 1},
};

PROOFS(rows)
