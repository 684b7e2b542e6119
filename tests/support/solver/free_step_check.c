/* Checks by brute force everything that a step certified free of contact promises. */
#include "tests/support/solver/free_step_check.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* Times are early by less than this, each by a different amount. */
static const double early = 1e-9;

static const double untouched = -4711.0;

void free_step_prepare(const double *x0, const double *x1, double longest, double step_factor,
                       free_step_call *call) {
    call->x0 = x0;
    call->x1 = x1;
    call->longest = longest;
    call->step_factor = step_factor;
    call->step = (cscd_free_step){.length = untouched};
    for (size_t i = 0; i < sizeof call->end / sizeof *call->end; i++) call->end[i] = untouched;
}

rig free_step_reference(const scene *s, const cscd_detector_options *options) {
    cscd_detector_options brute = *options;
    brute.method = CSCD_METHOD_BRUTE;
    return rig_create(s, 1, &brute);
}

static size_t coordinates_of(const rig *r) {
    return (size_t)cscd_mesh_vertex_count(r->mesh) * 3;
}

void free_step_positions(const rig *r, const double *x0, const double *x1, double length, double *out) {
    for (size_t i = 0; i < coordinates_of(r); i++) {
        double x = x0[i] + length * (x1[i] - x0[i]);
        out[i] = length == 1.0 ? x1[i] : length == 0.0 ? x0[i] : fabs(x) < 0x1p-300 ? 0.0 : x;
    }
}

static cscd_contacts contacts_between(const rig *reference, const double *x0, const double *x1) {
    cscd_contacts found;
    assert_int_equal(cscd_detector_step(reference->detector, x0, x1, &found), CSCD_OK);
    return found;
}

bool free_step_embedded(const rig *reference, const double *positions) {
    cscd_intersections found;
    assert_int_equal(cscd_detector_check(reference->detector, positions, &found), CSCD_OK);
    return found.count == 0 && found.zero_area_triangles == 0;
}

static void check_refused(const rig *reference, const cscd_context *called, const free_step_call *call) {
    assert_int_equal(call->status, CSCD_IN_CONTACT);
    assert_true(call->step.length == untouched && !call->step.limited);
    for (size_t i = 0; i < coordinates_of(reference); i++) assert_true(call->end[i] == untouched);
    assert_non_null(strstr(cscd_context_detail(called), "at the start"));
}

/* Checks that the limit is a first contact of the requested motion, on the scale of the line. */
static void check_limit(const free_step_call *call, cscd_contacts truth) {
    const cscd_contact *limit = &call->step.limit;
    bool listed = false;
    assert_true(limit->toi <= (truth.items[0].toi + early) * call->longest);
    for (size_t i = 0; i < truth.count; i++) {
        const cscd_contact *t = &truth.items[i];
        bool same = t->kind == limit->kind && t->a == limit->a && t->b == limit->b;
        listed |= same && t->toi * call->longest == limit->toi && t->u == limit->u && t->v == limit->v;
    }
    assert_true(listed);
    if (limit->toi > early) assert_true(call->step.length <= call->step_factor * limit->toi);
}

/* Without a contact on the way the step may be limited only if its end lies within min_separation, and
 * then by the end. */
static void check_unlimited(const rig *reference, const free_step_call *call) {
    static double end[SCENE_VERTICES_MAX * 3];
    free_step_positions(reference, call->x0, call->x1, call->longest, end);
    assert_int_equal(call->step.limited, contacts_between(reference, end, end).count > 0);
    if (call->step.limited) assert_true(call->step.limit.toi == call->longest);
}

bool free_step_check(const rig *reference, const cscd_context *called, const free_step_call *call) {
    static double end[SCENE_VERTICES_MAX * 3];
    if (contacts_between(reference, call->x0, call->x0).count > 0) {
        check_refused(reference, called, call);
        return false;
    }
    assert_int_equal(call->status, CSCD_OK);
    assert_true(call->step.length > 0.0 && call->step.length <= call->longest);
    free_step_positions(reference, call->x0, call->x1, call->longest, end);
    cscd_contacts truth = contacts_between(reference, call->x0, end);
    assert_int_equal(call->step.limited, call->step.length < call->longest);
    if (truth.count > 0) {
        assert_true(call->step.limited);
        check_limit(call, truth);
    }
    free_step_positions(reference, call->x0, call->x1, call->step.length, end);
    assert_memory_equal(end, call->end, coordinates_of(reference) * sizeof(double));
    assert_int_equal(contacts_between(reference, call->x0, call->end).count, 0);
    assert_int_equal(contacts_between(reference, call->end, call->end).count, 0);
    if (truth.count == 0) check_unlimited(reference, call);
    return true;
}
