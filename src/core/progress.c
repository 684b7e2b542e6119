/* How far a call has come, and whether the host wants it to end. */
#include "src/core/progress.h"

#include "src/core/context.h"
#include "src/core/timer.h"

#include <math.h>

static const double interval_ms = 4.0;

progress progress_of(cscd_progress host) {
    return (progress){.host = host, .interval_ms = interval_ms};
}

bool progress_wanted(const cscd_context *context) {
    return context->progress.host.report != NULL;
}

void progress_begin(cscd_context *context) {
    progress *p = &context->progress;
    if (!progress_wanted(context)) return;
    p->caller = pthread_self();
    p->asked_ms = timer_now_ms();
    p->reported = 0.0;
    atomic_store_explicit(&p->cancelled, false, memory_order_relaxed);
    progress_part(context, 0.0, 1.0);
    progress_stage(context, "", 0.0, 1.0);
}

void progress_part(cscd_context *context, double begin, double end) {
    context->progress.part_begin = begin;
    context->progress.part_end = end;
}

void progress_stage(cscd_context *context, const char *stage, double begin, double end) {
    progress *p = &context->progress;
    p->stage = stage;
    p->begin = begin;
    p->end = end;
}

/* Estimates may fall, and be off; what is reported does not. */
static void advance(progress *p, double share) {
    double part = p->begin + (p->end - p->begin) * share;
    double fraction = fmin(1.0, p->part_begin + (p->part_end - p->part_begin) * part);
    if (fraction > p->reported) p->reported = fraction;
}

bool progress_go_on(cscd_context *context, double share) {
    progress *p = &context->progress;
    if (!progress_wanted(context)) return true;
    if (atomic_load_explicit(&p->cancelled, memory_order_relaxed)) return false;
    if (!pthread_equal(p->caller, pthread_self())) return true;
    double now = timer_now_ms();
    if (now - p->asked_ms < p->interval_ms) return true;
    advance(p, share);
    bool go_on = p->host.report(p->host.user, p->stage, p->reported);
    p->asked_ms = timer_now_ms();
    if (!go_on) atomic_store_explicit(&p->cancelled, true, memory_order_relaxed);
    return go_on;
}

cscd_status progress_status(cscd_context *context) {
    const progress *p = &context->progress;
    if (!atomic_load_explicit(&p->cancelled, memory_order_relaxed)) return CSCD_OK;
    return context_fail(context, CSCD_CANCELLED,
                        "cancelled by the progress function, about %.0f %% through, in the stage \"%s\"; "
                        "the call may be repeated",
                        100.0 * p->reported, p->stage);
}
