/* The longest step towards x1 that is certified free of contact, by the stages of a step. */
#include "runtime/detector/step.h"
#include "runtime/solver/free_step.h"
#include "src/core/timer.h"

#include <string.h>

/* What is needed from one try to the next. */
typedef struct tries {
    cscd_detector *detector;
    cscd_timings timings;
    cscd_counters counters;
    bool any;
    double done; /* by estimate, of all tries */
} tries;

static void add_timings(cscd_timings *sum, const cscd_timings *more) {
    sum->update_ms += more->update_ms;
    sum->orientation_ms += more->orientation_ms;
    sum->contour_ms += more->contour_ms;
    sum->traversal_ms += more->traversal_ms;
    sum->contact_ms += more->contact_ms;
    sum->proof_ms += more->proof_ms;
}

_Static_assert(sizeof(cscd_counters) % sizeof(uint64_t) == 0, "counters are numbers of one kind");

static void add_counters(cscd_counters *sum, const cscd_counters *more) {
    uint64_t *to = (uint64_t *)sum;
    const uint64_t *from = (const uint64_t *)more;
    for (size_t i = 0; i < sizeof *sum / sizeof *to; i++) to[i] += from[i];
}

/* The vertices do not go to the end of the try before. */
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

static cscd_status check_arguments(cscd_detector *d, const double *x0, const double *x1,
                                   const cscd_free_step *out) {
    if (out == NULL)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT, "cscd_detector_max_step: out is NULL");
    if (d->traits->loses_contacts)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_max_step: method %s loses contacts and certifies nothing",
                            d->traits->name);
    return step_check_positions(d, x0, x1, "x0", "x1");
}

static cscd_status make_room(cscd_detector *d) {
    if (d->reached == NULL)
        d->reached = context_allocate(d->context, d->mesh->vertex_count, sizeof(double[3]));
    return d->reached != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

cscd_status cscd_detector_max_step(cscd_detector *detector, const double *x0, const double *x1, double *end,
                                   cscd_free_step *out) {
    if (detector == NULL) return CSCD_INVALID_ARGUMENT;
    double since = timer_now_ms();
    cscd_status status = check_arguments(detector, x0, x1, out);
    if (status != CSCD_OK) return status;
    motion m = {detector->mesh->vertex_count, x0, x1};
    tries t = {.detector = detector, .timings = {.check_ms = detector->timings.check_ms}};
    cscd_free_step step;
    call_begin(detector);
    status = make_room(detector);
    if (status == CSCD_OK)
        status = free_step_find(detector, &m, 1.0, try_motion, &t, detector->reached, &step);
    if (status != CSCD_OK) {
        if (t.any) step_withdraw(detector);
        return call_fail(detector, status);
    }
    step_take(detector, detector->reached);
    if (end != NULL) memcpy(end, detector->reached, m.vertex_count * sizeof(double[3]));
    timer_lap(&since, &t.timings.total_ms);
    detector->timings = t.timings;
    detector->counters = t.counters;
    *out = step;
    return CSCD_OK;
}
