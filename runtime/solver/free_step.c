/* Finds how far vertices may go on straight lines without contact: tries shorter and shorter steps until one is proven. */
#include "runtime/solver/free_step.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* Any shorter step leaves every vertex where it is: coordinates differ by at most 2^301, and are 0 or at
 * least 2^-300. */
static const double shortest = 0x1p-1000;

/* Stands in for a time of 0: times are early by less than 1e-9 (docs/theory/elementary.md). */
static const double about_0 = 0x1p-33;

/* ---- positions on the motion ----------------------------------------------------------------------------- */

static size_t coordinates_of(const straight_motion *m) {
    return (size_t)m->mesh->vertex_count * 3;
}

/* The coordinates of one object. */
typedef struct coordinate_range {
    size_t begin, end;
} coordinate_range;

static coordinate_range range_of(const cscd_mesh *mesh, uint32_t object) {
    size_t begin = (size_t)mesh->objects[object].first_vertex * 3;
    return (coordinate_range){begin, begin + (size_t)mesh->objects[object].vertex_count * 3};
}

static bool is_in_floats(const straight_motion *m, uint32_t object) {
    return m->scalars != NULL && m->scalars[object] == CSCD_SCALAR_FLOAT;
}

static bool becomes_infinite(double x) {
    return isinf(stored_coordinate(x, CSCD_SCALAR_FLOAT));
}

cscd_status motion_check(cscd_context *context, const straight_motion *m) {
    for (uint32_t o = 0; o < m->mesh->object_count; o++) {
        coordinate_range r = range_of(m->mesh, o);
        for (size_t i = r.begin; is_in_floats(m, o) && i < r.end; i++) {
            bool start = becomes_infinite(m->x0[i]);
            if (!start && !becomes_infinite(m->x1[i])) continue;
            return context_fail(context, CSCD_INVALID_ARGUMENT,
                                "%s: vertex %zu has %c = %g, which is infinite as a float",
                                start ? "x0" : "x1", i / 3, "xyz"[i % 3], start ? m->x0[i] : m->x1[i]);
        }
    }
    return CSCD_OK;
}

cscd_status motion_check_still(cscd_context *context, const straight_motion *m, const active_set *active) {
    for (uint32_t o = 0; active->vertices != NULL && o < m->mesh->object_count; o++) {
        coordinate_range r = range_of(m->mesh, o);
        for (size_t i = r.begin; is_in_floats(m, o) && i < r.end; i++) {
            if (active->vertices[i / 3] || stored_coordinate(m->x0[i], CSCD_SCALAR_FLOAT) == m->x0[i])
                continue;
            return context_fail(
                context, CSCD_INVALID_ARGUMENT,
                "vertex %zu is not active, but would move where x0 is rounded to floats: give x0 "
                "in floats, or ask for doubles",
                i / 3);
        }
    }
    return CSCD_OK;
}

static void round_to_floats(const straight_motion *m, double *x) {
    for (uint32_t o = 0; o < m->mesh->object_count; o++) {
        coordinate_range r = range_of(m->mesh, o);
        for (size_t i = r.begin; is_in_floats(m, o) && i < r.end; i++)
            x[i] = stored_coordinate(x[i], CSCD_SCALAR_FLOAT);
    }
}

void motion_at(const straight_motion *m, double fraction, double *out) {
    size_t count = coordinates_of(m);
    if (fraction == 0.0 || fraction == 1.0) {
        memmove(out, fraction == 0.0 ? m->x0 : m->x1, count * sizeof *out);
    } else {
        for (size_t i = 0; i < count; i++) {
            double x = m->x0[i] + fraction * (m->x1[i] - m->x0[i]);
            out[i] = stored_coordinate(x, CSCD_SCALAR_DOUBLE);
        }
    }
    round_to_floats(m, out);
}

/* C bounds the coordinates. In doubles
 * - the difference, which may be 2 C, is off by 2^-52 C, and the product by as much,
 * - the sum is off by 2^-53 C,
 * - together this is below 2^-50 C for each coordinate or, at 0, 2^-300;
 * so the distance of two points is off by less than 2^-48 C. Rounding to floats adds 2^-24 C, or 2^-150 close to 0, to
 * each coordinate. Two points with three coordinates each make 2 sqrt 3 (2^-24 + 2^-50) C < 2^-22 C. */
double motion_rounding(const straight_motion *m) {
    bool any = false;
    double largest = 0.0;
    for (uint32_t o = 0; o < m->mesh->object_count; o++) any |= is_in_floats(m, o);
    for (size_t i = 0; i < coordinates_of(m); i++)
        largest = max_of(largest, max_of(fabs(m->x0[i]), fabs(m->x1[i])));
    return any ? largest * 0x1p-22 + 0x1p-148 : largest * 0x1p-48 + 0x1p-297;
}

/* ---- tries ----------------------------------------------------------------------------------------------- */

/* A motion, its test, and the outcome of the last test. */
typedef struct trial {
    const step_quest *quest;
    const straight_motion *of;
    bool touches;
    cscd_contact first; /* if it touches */
} trial;

static cscd_status try_between(trial *t, const double *from, const double *to) {
    cscd_contacts found;
    cscd_status status = t->quest->test(t->quest->of, from, to, &found);
    if (status != CSCD_OK) return status;
    t->touches = found.count > 0;
    if (t->touches) t->first = found.items[0];
    return CSCD_OK;
}

static const char *name_of_first(const cscd_contact *at) {
    return at->kind == CSCD_CONTACT_EE || at->kind == CSCD_CONTACT_EV ? "edge" : "vertex";
}

static const char *name_of_second(const cscd_contact *at) {
    switch (at->kind) {
    case CSCD_CONTACT_VF:
        return "triangle";
    case CSCD_CONTACT_EE:
        return "edge";
    case CSCD_CONTACT_VH:
        return "the half-space, object";
    default:
        return "vertex";
    }
}

static cscd_status fail_in_contact(cscd_context *context, const cscd_contact *at) {
    return context_fail(
        context, CSCD_IN_CONTACT,
        "%s %u and %s %u touch at the start, so no step is free of contact: part them, or leave the "
        "pair out",
        name_of_first(at), at->a, name_of_second(at), at->b);
}

/* Tests an interval in which nothing moves. IN_CONTACT: something touches, which is t->first. */
static cscd_status check_start(trial *t) {
    cscd_status status = try_between(t, t->of->x0, t->of->x0);
    if (status != CSCD_OK || !t->touches) return status;
    return fail_in_contact(t->quest->context, &t->first);
}

/* Returns the share of a step that is tried next, after a contact was found at this time of the step. */
static double cut_for(const step_quest *quest, double time) {
    return quest->step_factor * (time > 0.0 ? time : about_0);
}

static bool is_moved(const straight_motion *m, const double *reached) {
    for (size_t i = 0; i < coordinates_of(m); i++) {
        if (reached[i] != m->x0[i]) return true;
    }
    return false;
}

/* x0 is given in doubles, is rounded to floats, and cannot get there. */
static cscd_status fail_to_round(cscd_context *context, const cscd_contact *at) {
    return context_fail(
        context, CSCD_IN_CONTACT,
        "%s %u and %s %u do not stay apart where x0 is rounded to floats: give x0 in floats, or ask "
        "for doubles",
        name_of_first(at), at->a, name_of_second(at), at->b);
}

/* A step of step_factor times the first contact's time is mostly free. Where its rounded end has contacts of its own,
 * or the time is 0, steps shrink ever faster. */
static cscd_status shorten_step(trial *t, double *reached, double *fraction) {
    cscd_status status = CSCD_OK;
    bool start_checked = false;
    for (double shrink = 0.25;; shrink *= shrink) {
        bool at_once = t->first.toi == 0.0;
        if (at_once && !start_checked) status = check_start(t);
        if (status != CSCD_OK) return status;
        start_checked |= at_once;
        motion_at(t->of, *fraction, reached);
        status = try_between(t, t->of->x0, reached);
        if (status != CSCD_OK || !t->touches) return status;
        if (*fraction == shortest && (start_checked || t->first.toi > 0.0))
            return fail_to_round(t->quest->context, &t->first);
        *fraction = max_of(*fraction * min_of(cut_for(t->quest, t->first.toi), shrink), shortest);
    }
}

static cscd_status find_step(trial *t, double *reached, cscd_free_step *step) {
    const double longest = t->quest->longest;
    motion_at(t->of, longest, reached);
    cscd_status status = try_between(t, t->of->x0, reached);
    if (status != CSCD_OK || !t->touches) return status;
    step->limited = true;
    step->limit = t->first;
    step->limit.toi *= longest;
    double cut = longest * cut_for(t->quest, 0.0);
    if (t->first.toi > 0.0)
        cut = t->quest->step_factor * step->limit.toi; /* rounding must not make it larger */
    step->fraction = max_of(cut, shortest);
    status = shorten_step(t, reached, &step->fraction);
    if (status == CSCD_IN_CONTACT) *step = (cscd_free_step){.limited = true, .limit = t->first};
    return status;
}

cscd_status free_step_find(const step_quest *quest, const straight_motion *m, double *reached,
                           cscd_free_step *out) {
    cscd_free_step found = {.fraction = quest->longest};
    trial t = {.quest = quest, .of = m};
    cscd_status status = find_step(&t, reached, &found);
    if (status == CSCD_OK) found.moved = is_moved(m, reached);
    if (status == CSCD_OK && !found.moved) memcpy(reached, m->x0, coordinates_of(m) * sizeof *reached);
    if (status == CSCD_OK || status == CSCD_IN_CONTACT) *out = found;
    return status;
}
