/* How far vertices may go on straight lines without contact: tries shorter and shorter steps until one is proven. */
#include "runtime/solver/free_step.h"

#include "src/core/vec3.h"

#include <string.h>

/* Any shorter step leaves every vertex where it is: coordinates differ by at most 2^301, and are 0 or at
 * least 2^-300. */
static const double shortest = 0x1p-1000;

/* Stands in for a time of 0: times are early by less than 1e-9 (docs/theory/elementary.md). */
static const double about_0 = 0x1p-33;

static const double least_coordinate = 0x1p-300;

void motion_at(const straight_motion *m, double length, double *out) {
    size_t count = (size_t)m->vertex_count * 3;
    if (length == 0.0 || length == 1.0) {
        memmove(out, length == 0.0 ? m->x0 : m->x1, count * sizeof *out);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        double x = m->x0[i] + length * (m->x1[i] - m->x0[i]);
        out[i] = fabs(x) < least_coordinate ? 0.0 : x;
    }
}

static cscd_status fail_in_contact(cscd_detector *d, const cscd_contact *at) {
    bool vf = at->kind == CSCD_CONTACT_VF;
    const char *how = d->limit.distance > 0.0 ? "are within min_separation" : "touch";
    return context_fail(
        d->context, CSCD_IN_CONTACT,
        "%s %u and %s %u %s at the start, so no step is free of contact: part them, or leave the "
        "pair out",
        vf ? "vertex" : "edge", at->a, vf ? "triangle" : "edge", at->b, how);
}

/* A motion, its test, and the outcome of the last test. */
typedef struct trial {
    const straight_motion *of;
    motion_test *test;
    void *data;
    bool touches;
    cscd_contact first; /* if it touches */
} trial;

static cscd_status try_between(trial *t, const double *from, const double *to) {
    cscd_contacts found;
    cscd_status status = t->test(t->data, from, to, &found);
    if (status != CSCD_OK) return status;
    t->touches = found.count > 0;
    if (t->touches) t->first = found.items[0];
    return CSCD_OK;
}

/* With min_separation, a pair that ends just farther apart than that, but within the tolerance, is not found in this
 * motion, and would be found at the start of the next one. So the end is tested by itself, too. */
static cscd_status try_step(const cscd_detector *d, trial *t, const double *end) {
    cscd_status status = try_between(t, t->of->x0, end);
    if (status != CSCD_OK || t->touches || d->limit.distance == 0.0) return status;
    status = try_between(t, end, end);
    t->first.toi = 1.0;
    return status;
}

/* Tests an interval in which nothing moves. IN_CONTACT: something touches. */
static cscd_status check_start(cscd_detector *d, trial *t) {
    cscd_status status = try_between(t, t->of->x0, t->of->x0);
    if (status != CSCD_OK || !t->touches) return status;
    return fail_in_contact(d, &t->first);
}

/* Returns the share of a step that is tried next, after a contact was found at this time of the step. */
static double cut_for(const cscd_detector *d, double time) {
    return d->options.step_factor * (time > 0.0 ? time : about_0);
}

/* A step of step_factor times the first contact's time is mostly free. Where its rounded end has contacts of its own,
 * or the time is 0, steps shrink ever faster. */
static cscd_status shorten_step(cscd_detector *d, trial *t, double *reached, double *length) {
    cscd_status status = CSCD_OK;
    double shrink = 0.25;
    bool start_checked = false, at_once = t->first.toi == 0.0;
    for (;;) {
        if (at_once && !start_checked) status = check_start(d, t);
        if (status != CSCD_OK) return status;
        start_checked = at_once;
        motion_at(t->of, *length, reached);
        status = try_step(d, t, reached);
        if (status != CSCD_OK || !t->touches) return status;
        *length = max_of(*length * min_of(cut_for(d, t->first.toi), shrink), shortest);
        shrink *= shrink;
        at_once = true;
    }
}

cscd_status free_step_find(cscd_detector *d, const straight_motion *m, double longest, motion_test *test,
                           void *of, double *reached, cscd_free_step *out) {
    cscd_free_step step = {.length = longest};
    trial t = {.of = m, .test = test, .data = of};
    motion_at(m, longest, reached);
    cscd_status status = try_step(d, &t, reached);
    if (status == CSCD_OK && t.touches) {
        step.limited = true;
        step.limit = t.first;
        step.limit.toi *= longest;
        double cut = longest * cut_for(d, 0.0);
        if (t.first.toi > 0.0)
            cut = d->options.step_factor * step.limit.toi; /* rounding must not make it larger */
        step.length = max_of(cut, shortest);
        status = shorten_step(d, &t, reached, &step.length);
    }
    if (status == CSCD_OK) *out = step;
    return status;
}
