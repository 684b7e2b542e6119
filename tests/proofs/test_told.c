/* What every call promises (tests/support/proofs/proof.h), of those that tell a detector something, and what it answers then. */
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t list[SCENE_TRIANGLES_MAX]; /* what a call is given */

/* ---- parts ---------------------------------------------------------------------------------------------- */

static const uint32_t *labels_of(const proof *p, uint32_t count) {
    for (uint32_t t = 0; t < p->shape.triangle_count; t++) list[t] = t / 7 % (count + 1) - 1;
    return list;
}

static cscd_status set_parts(proof *p) {
    return cscd_detector_set_parts(p->detector, labels_of(p, 3), 3);
}

static cscd_status set_bodies(proof *p) {
    return cscd_detector_set_bodies(p->detector, labels_of(p, 2), 2);
}

static cscd_status find_parts(proof *p) {
    cscd_intersection_options options = ask_everything();
    cscd_view x;
    options.part_bodies = true;
    return cscd_detector_find_intersections(p->detector, at_moment(p, 2, &x), &options, &p->answer.pairs);
}

static const proof_call parts = {"detector_set_parts", PROOF_CHANGES, set_parts, NULL};
static const proof_call bodies = {"detector_set_bodies", PROOF_CHANGES, set_bodies, NULL};
static const proof_call parts_found = {"detector_find_intersections", PROOF_ASKS, find_parts, read_pairs};

/* ---- what is said of contacts --------------------------------------------------------------------------- */

typedef struct kept_contacts {
    cscd_contact *items;
    size_t count;
} kept_contacts;

static void keep_contacts(proof *p) {
    kept_contacts *kept = p->own;
    const cscd_contacts *found = &p->answer.contacts;
    read_contacts(p);
    if (kept->items == NULL) kept->items = calloc(found->count + 1, sizeof *kept->items);
    assert_non_null(kept->items);
    if (found->count > 0) memcpy(kept->items, found->items, found->count * sizeof *found->items);
    kept->count = found->count;
}

static void open_keeping(proof *p) {
    open_detector(p);
    p->own = calloc(1, sizeof(kept_contacts));
    assert_non_null(p->own);
}

static void free_contacts(proof *p) {
    free(((kept_contacts *)p->own)->items);
    free(p->own);
}

static cscd_status step_and_keep(proof *p) {
    return step_second.make(p);
}

static cscd_status sum_contacts(proof *p) {
    const kept_contacts *kept = p->own;
    return cscd_detector_contact_parts(p->detector, kept->items, kept->count, &p->answer.part_pairs);
}

static void read_sums(proof *p) {
    proof_add_items(p, p->answer.part_pairs.items, p->answer.part_pairs.count,
                    sizeof *p->answer.part_pairs.items);
}

static const proof_call kept_step = {"detector_step", PROOF_BEGINS, step_and_keep, keep_contacts};
static const proof_call sums = {"detector_contact_parts", PROOF_ASKS, sum_contacts, read_sums};

/* ---- who is looked at with whom ------------------------------------------------------------------------- */

static cscd_status give_rules(proof *p, uint64_t mask, double thickness) {
    cscd_object_rule rules[2] = {cscd_object_rule_default(), cscd_object_rule_default()};
    rules[1].mask = mask;
    rules[0].thickness = thickness;
    return cscd_detector_set_rules(p->detector, rules, 2, NULL, 0);
}

static cscd_status set_apart(proof *p) {
    return give_rules(p, 0, 0.0);
}

static cscd_status set_thick(proof *p) {
    return give_rules(p, UINT64_MAX, 0.05);
}

static cscd_status set_seams(proof *p) {
    const uint32_t half = p->shape.vertex_count / 2;
    for (uint32_t i = 0; i < 10; i++) {
        list[2 * i] = 3 * i;
        list[2 * i + 1] = half + 2 * i;
    }
    return cscd_detector_set_seams(p->detector, list, 10);
}

static cscd_status set_ignored(proof *p) {
    const uint32_t half = p->shape.triangle_count / 2;
    for (uint32_t i = 0; i < 40; i++) {
        list[2 * i] = i;
        list[2 * i + 1] = half + i;
    }
    return cscd_detector_set_ignored(p->detector, list, 40);
}

static cscd_status set_separation(proof *p) {
    return cscd_detector_set_separation(p->detector, 0.02, 0.0);
}

static cscd_status set_longest(proof *p) {
    return cscd_detector_set_longest_list(p->detector, 1000000);
}

static const proof_call apart = {"detector_set_rules", PROOF_CHANGES, set_apart, NULL};
static const proof_call thick = {"detector_set_rules", PROOF_CHANGES, set_thick, NULL};
static const proof_call seams = {"detector_set_seams", PROOF_CHANGES, set_seams, NULL};
static const proof_call ignored = {"detector_set_ignored", PROOF_CHANGES, set_ignored, NULL};
static const proof_call separation = {"detector_set_separation", PROOF_CHANGES, set_separation, NULL};
static const proof_call longest = {"detector_set_longest_list", PROOF_CHANGES, set_longest, NULL};

static void open_torn(proof *p) {
    cscd_detector_options options = cscd_detector_defaults();
    options.seam_reach = INFINITY;
    open_detector_with(p, options);
}

/* ---- what waits ------------------------------------------------------------------------------------------ */

/* Two panels at one place, sewn together all over; they part and meet in turns. */
static void open_sewn(proof *p) {
    enum { SIDE = 5, HALF = SIDE * SIDE };
    uint32_t sewn[HALF][2];
    cscd_detector_options options = cscd_detector_defaults();
    scene_clear(&p->shape);
    for (int i = 0; i < 2; i++) scene_add_sheet(&p->shape, 4.0, 4.0, SIDE - 1, SIDE - 1);
    for (uint32_t v = 0; v < 2 * HALF; v++) {
        p->shape.x0[3 * v + 2] = 0.1 * sin(v % HALF * 1.3);
        for (int m = 0; m < PROOF_MOMENTS; m++)
            memcpy(&p->x[m][3 * v], &p->shape.x0[3 * v], sizeof(double[3]));
        if (v >= HALF) continue;
        p->x[1][3 * v + 2] += 0.3;
        p->x[3][3 * v + 2] += 0.3;
        sewn[v][0] = v;
        sewn[v][1] = HALF + v;
    }
    options.seams = sewn[0];
    options.seam_count = HALF;
    cscd_object_desc objects[2];
    uint32_t count;
    describe_objects(p, objects, &count);
    proof_need(p, cscd_mesh_create(p->context, objects, count, &p->mesh));
    open_detector_with(p, options);
}

static cscd_status open_seams(proof *p) {
    return cscd_detector_set_seams(p->detector, NULL, 0);
}

/* A step lets go of what is apart where it starts, also when it fails then. */
static cscd_status step_apart(proof *p) {
    return step_first.make(p);
}

static cscd_status step_together(proof *p) {
    return step_second.make(p);
}

static const proof_call parted = {"detector_step", PROOF_BEGINS, step_apart, read_contacts};
static const proof_call joined = {"detector_step", PROOF_BEGINS, step_together, read_contacts};
static const proof_call opened = {"detector_set_seams", PROOF_CHANGES, open_seams, NULL};

/* ---- what may move -------------------------------------------------------------------------------------- */

/* The first object rests, and the second one alone may move. */
static void open_resting(proof *p) {
    open_mesh(p);
    const size_t half = (size_t)p->shape.vertex_count / 2 * 3;
    for (int m = 1; m < PROOF_MOMENTS; m++) memcpy(p->x[m], p->x[0], half * sizeof *p->x[m]);
    open_detector(p);
}

static cscd_status set_active(proof *p) {
    const uint32_t half = p->shape.vertex_count / 2;
    for (uint32_t i = 0; i < half; i++) list[i] = half + i;
    return cscd_detector_set_active(p->detector, list, half);
}

/* What is not active must not move. */
static cscd_status move_resting(proof *p) {
    cscd_view x0, x1;
    const double kept = p->x[2][0];
    p->x[2][0] += 0.5;
    const cscd_status status =
        cscd_detector_step(p->detector, at_moment(p, 1, &x0), at_moment(p, 2, &x1), &p->answer.contacts);
    p->x[2][0] = kept;
    return status == CSCD_INVALID_ARGUMENT ? CSCD_OK : CSCD_INVALID_ARGUMENT;
}

static void open_active(proof *p) {
    open_resting(p);
    proof_need(p, set_active(p));
}

static const proof_call refused = {"detector_step", PROOF_BEGINS, move_resting, NULL};
static const proof_call active = {"detector_set_active", PROOF_CHANGES, set_active, NULL};

/* ---- other meshes, other detectors ---------------------------------------------------------------------- */

/* The second object loses its last triangle. */
static cscd_status create_change(proof *p) {
    cscd_object_desc objects[2];
    uint32_t count;
    describe_objects(p, objects, &count);
    objects[1].triangle_count--;
    const cscd_object_change change = {.object = 1, .desc = &objects[1]};
    return cscd_mesh_change_create(p->context, p->mesh, &change, 1, &p->answer.change);
}

static void keep_change(proof *p) {
    p->change = p->answer.change;
}

static cscd_status change_mesh(proof *p) {
    return cscd_detector_change_mesh(p->detector, p->change);
}

static cscd_status clone_detector(proof *p) {
    return cscd_detector_clone(p->context, p->detector, &p->answer.detector);
}

/* From here on the clone is asked. */
static void keep_clone(proof *p) {
    p->clone = p->detector;
    p->detector = p->answer.detector;
}

static const proof_call change_made = {"mesh_change_create", PROOF_CREATES, create_change, keep_change};
static const proof_call mesh_changed = {"detector_change_mesh", PROOF_CHANGES, change_mesh, NULL};
static const proof_call cloned = {"detector_clone", PROOF_CREATES, clone_detector, keep_clone};

/* ---- the table ------------------------------------------------------------------------------------------ */

#define SPHERES .family = SCENE_TWO_SPHERES

static const proof_row rows[] = {
    {"parts", {&parts, &bodies, &parts_found, &cloned, &parts_found}, open_detector, SPHERES},
    {"parts_of_contacts", {&kept_step, &parts, &sums}, open_keeping, free_contacts, SPHERES},
    {"rules", {&step_first, &apart, &step_second, &thick, &step_third}, open_detector, SPHERES},
    {"seams", {&step_first, &seams, &step_second, &step_third}, open_torn, SPHERES},
    {"waiting", {&opened, &parted, &joined, &step_third}, open_sewn, SPHERES},
    {"ignored", {&step_first, &ignored, &step_second, &step_third}, open_detector, SPHERES},
    {"separation", {&step_first, &separation, &step_second, &longest, &step_third}, open_detector, SPHERES},
    {"active", {&active, &step_first, &step_second, &step_third}, open_resting, SPHERES},
    {"active_later", {&step_first, &active, &step_second, &step_third}, open_resting, SPHERES},
    {"active_clone", {&active, &cloned, &step_first, &step_second}, open_resting, SPHERES},
    {"active_change",
     {&step_first, &change_made, &mesh_changed, &refused, &step_second},
     open_active,
     SPHERES},
    {"change", {&step_first, &change_made, &mesh_changed, &step_second, &step_third}, open_detector, SPHERES},
    {"change_told",
     {&step_first, &seams, &ignored, &thick, &change_made, &mesh_changed, &step_second, &step_third},
     open_torn,
     SPHERES},
    {"clone", {&step_first, &cloned, &step_second, &step_third}, open_detector, SPHERES},
};

PROOFS(rows)
