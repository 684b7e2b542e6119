/* The longest step towards x1 that is certified free of contact, by the stages of a step. */
#include "runtime/solver/max_step.h"

#include "runtime/detector/step.h"
#include "runtime/detector/waiting.h"
#include "src/core/timer.h"
#include "src/mesh/views.h"

#include <string.h>

/* The sums over all tries of a call. */
typedef struct tries {
    cscd_detector *detector;
    cscd_timings timings;
    cscd_counters counters;
    bool any;
    double done; /* estimated share of the call: each try takes half of what is left */
} tries;

static void add_timings(cscd_timings *sum, const cscd_timings *more) {
    sum->update_ms += more->update_ms;
    sum->orientation_ms += more->orientation_ms;
    sum->contour_ms += more->contour_ms;
    sum->traversal_ms += more->traversal_ms;
    sum->contact_ms += more->contact_ms;
    sum->proof_ms += more->proof_ms;
}

static void add_counters(cscd_counters *sum, const cscd_counters *more) {
    sum->static_checks += more->static_checks;
    sum->clean += more->clean;
    sum->rebuilds += more->rebuilds;
    sum->passes += more->passes;
    sum->plus += more->plus;
    sum->minus += more->minus;
    sum->contours += more->contours;
    sum->sealed += more->sealed;
    sum->boxes_tested += more->boxes_tested;
    sum->pcp += more->pcp;
    sum->adjacent += more->adjacent;
    sum->feature_pairs += more->feature_pairs;
    sum->tests += more->tests;
    sum->by_signs += more->by_signs;
    sum->by_roots += more->by_roots;
    sum->by_exact += more->by_exact;
    sum->vf += more->vf;
    sum->ee += more->ee;
    sum->bounded += more->bounded;
    sum->loose += more->loose;
    sum->coherent += more->coherent;
}

_Static_assert(offsetof(cscd_counters, reserved) == 21 * sizeof(uint64_t), "add_counters adds every counter");

/* Withdraws the previous try first, because the vertices did not go to its end. */
static cscd_status try_motion(void *of, const double *from, const double *to, cscd_contacts *out) {
    tries *t = of;
    step_outcome found;
    if (t->any) step_withdraw(t->detector);
    t->any = true;
    progress_part(&t->detector->context->progress, t->done, 0.5 + 0.5 * t->done);
    t->done = 0.5 + 0.5 * t->done;
    cscd_status status = step_find(t->detector, from, to, CSCD_MODE_EARLIEST, true, &found);
    if (status != CSCD_OK) return status;
    add_timings(&t->timings, &found.timings);
    add_counters(&t->counters, &found.counters);
    *out = found.contacts;
    return CSCD_OK;
}

static cscd_status check_method(const cscd_detector *d) {
    if (!d->traits->loses_contacts) return CSCD_OK;
    return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                        "cscd_detector_max_step: method %s loses contacts and certifies nothing",
                        d->traits->name);
}

static cscd_status reserve_reached(cscd_detector *d) {
    if (d->reached == NULL)
        d->reached = context_allocate(d->context, d->mesh->vertex_count, sizeof(double[3]));
    return d->reached != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

/* Withdraws what a failed call has tried, and passes the status on. */
static cscd_status fail_tries(const tries *t, cscd_status status) {
    if (t->any) step_withdraw(t->detector);
    return detector_fail_call(t->detector, status);
}

cscd_status max_step_find(cscd_detector *d, const straight_motion *m, cscd_free_step *out) {
    double since = timer_now_ms();
    tries t = {.detector = d, .timings = {.check_ms = d->timings.check_ms}};
    cscd_status status = motion_check(d->context, m);
    if (status == CSCD_OK) status = motion_check_still(d->context, m, &d->space.active);
    if (status != CSCD_OK) return status;
    detector_begin_call(d);
    status = waiting_settle(d, m->x0);
    if (status == CSCD_OK) status = waiting_only_touching(d, m->x0);
    if (status == CSCD_OK) status = reserve_reached(d);
    if (status == CSCD_OK) status = free_step_find(d, m, 1.0, try_motion, &t, d->reached, out);
    if (status == CSCD_OK) status = context_progress_status(d->context);
    if (status != CSCD_OK) return fail_tries(&t, status);
    step_take(d, d->reached);
    timer_lap(&since, &t.timings.total_ms);
    d->timings = t.timings;
    d->counters = t.counters;
    return CSCD_OK;
}

static cscd_status max_step_between(cscd_detector *d, const double *x0, const double *x1,
                                    cscd_free_step *out) {
    double since = timer_now_ms(), check_ms = 0.0;
    cscd_status status = step_check_positions(d, x0, x1);
    if (status != CSCD_OK) return status;
    straight_motion m = {d->mesh, x0, x1, d->reached_scalars};
    timer_lap(&since, &check_ms);
    status = max_step_find(d, &m, out);
    if (status == CSCD_OK) d->timings.total_ms += check_ms;
    return status;
}

static cscd_status max_step_of_views(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                     const cscd_mutable_view *reached, cscd_free_step *out) {
    cscd_context *context = detector->context;
    const cscd_mesh *mesh = detector->mesh;
    if (out == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_max_step: out is NULL");
    const double *from = NULL, *to = NULL;
    cscd_free_step step;
    cscd_status status = check_method(detector);
    if (status == CSCD_OK) status = views_read(context, mesh, x0, "x0", &detector->unpacked[0], &from);
    if (status == CSCD_OK) status = views_read(context, mesh, x1, "x1", &detector->unpacked[1], &to);
    if (status == CSCD_OK) status = views_check_mutable(context, mesh, reached, "reached");
    if (status == CSCD_OK && reached == NULL) views_scalars(mesh, x0, detector->reached_scalars);
    if (status == CSCD_OK && reached != NULL) views_mutable_scalars(mesh, reached, detector->reached_scalars);
    if (status == CSCD_OK) status = max_step_between(detector, from, to, &step);
    if (status == CSCD_OK) views_write(mesh, reached, detector->reached);
    if (status == CSCD_OK || status == CSCD_IN_CONTACT) *out = step;
    return status;
}

cscd_status cscd_detector_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                   const cscd_mutable_view *reached, cscd_free_step *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, max_step_of_views(detector, x0, x1, reached, out));
}
