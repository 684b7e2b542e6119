/* The progress of a call, and the host's wish to end it. */
#include "src/core/progress.h"

#include "src/core/timer.h"

#include <assert.h>
#include <math.h>

static const double interval_ms = 4.0;

progress progress_of(cscd_progress host, entry_state *entry) {
    return (progress){.host = host, .entry = entry, .interval_ms = interval_ms};
}

bool progress_wanted(const progress *p) {
    return p->host.report != NULL;
}

bool progress_cancelled(const progress *p) {
    return atomic_load_explicit(&p->cancelled, memory_order_relaxed);
}

void progress_cancel(progress *p) {
    atomic_store_explicit(&p->cancelled, true, memory_order_relaxed);
}

void progress_begin_call(progress *p) {
    atomic_store_explicit(&p->cancelled, false, memory_order_relaxed);
    p->by_report = false;
}

void progress_begin(progress *p) {
    if (!progress_wanted(p) || p->held != NULL) return;
    p->caller = pthread_self();
    p->asked_ms = timer_now_ms();
    p->reported = 0.0;
    progress_part(p, 0.0, 1.0);
    progress_stage(p, "", 0.0, 1.0);
}

void progress_hold(progress *p, const char *stage, double share) {
    p->held = stage;
    p->held_share = share;
}

void progress_let_go(progress *p) {
    p->held = NULL;
}

void progress_part(progress *p, double begin, double end) {
    assert(begin <= end);
    p->part_begin = begin;
    p->part_end = end;
}

void progress_stage(progress *p, const char *stage, double begin, double end) {
    assert(begin <= end);
    p->stage = stage;
    p->begin = begin;
    p->end = end;
}

progress_outer progress_enter(progress *p, const char *stage) {
    progress_outer outer = {p->stage, p->begin, p->end};
    progress_stage(p, stage, p->begin, p->begin);
    return outer;
}

void progress_leave(progress *p, progress_outer outer) {
    progress_stage(p, outer.stage, outer.begin, outer.end);
}

/* Estimates may fall; the number that is reported does not. */
static void advance_report(progress *p, double share) {
    double part = p->begin + (p->end - p->begin) * share;
    double fraction = fmin(1.0, p->part_begin + (p->part_end - p->part_begin) * part);
    if (p->held != NULL) fraction = p->held_share;
    if (fraction > p->reported) p->reported = fraction;
}

static bool ask_host(progress *p) {
    host_call call = host_call_begin(p->entry);
    bool go_on = p->host.report(p->host.user, p->held != NULL ? p->held : p->stage, p->reported);
    host_call_end(&call);
    return go_on;
}

bool progress_go_on(progress *p, double share) {
    if (progress_cancelled(p)) return false;
    if (!progress_wanted(p)) return true;
    if (!pthread_equal(p->caller, pthread_self())) return true;
    double now = timer_now_ms();
    if (now - p->asked_ms < p->interval_ms) return true;
    advance_report(p, share);
    bool go_on = ask_host(p);
    p->asked_ms = timer_now_ms();
    p->by_report = !go_on;
    if (!go_on) progress_cancel(p);
    return !progress_cancelled(p);
}
