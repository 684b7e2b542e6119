/* Elementary tests: do a moving vertex and face, or two moving edges, touch, and when? Three levels, each of
 * which decides only what it is certain of; docs/theory/elementary.md derives every constant. */
#include "runtime/ccd/elementary.h"

#include "runtime/ccd/contact_frame.h"
#include "runtime/ccd/coplanarity.h"
#include "runtime/ccd/cubic.h"
#include "runtime/ccd/exact/exact_test.h"
#include "runtime/ccd/inside_test.h"
#include "runtime/ccd/separating_axis.h"

#include <assert.h>

enum { HALVINGS = 3 };

static const elementary_verdict apart_by_signs = {false, ELEMENTARY_SIGNS};

/* A root interval must be this narrow for its toi to be the TOI. */
static const double narrow = 0x1p-31;

/* Tries the whole interval, its halves and so on. Features that keep changing sides, as parallel edges that pass beside each
 * other, have no direction for all of it. */
static bool separated_in_halves(const elementary_query *query, cscd_contact_kind kind, double begin,
                                double end, int halvings) {
    if (separated_in_part(query, kind, begin, end)) return true;
    if (halvings == 0) return false;
    double middle = 0.5 * (begin + end);
    return separated_in_halves(query, kind, begin, middle, halvings - 1) &&
           separated_in_halves(query, kind, middle, end, halvings - 1);
}

/* Decides what level two leaves open. The directions come here, because before level two they cost more than
 * they save. */
static elementary_verdict decide_what_is_left(const elementary_query *query, cscd_contact_kind kind,
                                              const coplanarity *f, elementary_contact *contact) {
    double toi;
    if (separated_by_diagonals(query, kind) || separated_in_halves(query, kind, 0.0, 1.0, HALVINGS))
        return apart_by_signs;
    bool touching = exact_touch(query, kind, &toi);
    if (touching) contact_frame_describe(query, kind, f, toi, contact);
    return (elementary_verdict){touching, ELEMENTARY_EXACT};
}

/* A root at which the inside test is unsure is no contact if the features are certainly apart about it. If the next root is a
 * contact all the same, level three says when, as for every pair with an unsure root before its contact. */
static elementary_verdict decide_at_roots(const elementary_query *query, const point_vectors *vectors,
                                          cscd_contact_kind kind, const coplanarity *f,
                                          elementary_contact *contact) {
    root_interval roots[ROOTS_MAX];
    bool passed_unsure = false;
    int count = cubic_isolate(f, roots);
    if (count == ROOTS_UNCERTAIN) return decide_what_is_left(query, kind, f, contact);
    for (int i = 0; i < count; i++) {
        assert(roots[i].begin <= roots[i].end && (i == 0 || roots[i - 1].end <= roots[i].begin));
        inside_verdict inside = inside_test(vectors, kind, &roots[i]);
        if (inside == INSIDE_NO) continue;
        bool timed = roots[i].toi >= 0.0 && roots[i].end - roots[i].begin <= narrow;
        if (inside == INSIDE_UNSURE && separated_in_part(query, kind, roots[i].begin, roots[i].end)) {
            passed_unsure = true;
            continue;
        }
        if (inside == INSIDE_UNSURE || !roots[i].certain || !timed || passed_unsure)
            return decide_what_is_left(query, kind, f, contact);
        contact_frame_describe(query, kind, f, roots[i].toi, contact);
        return (elementary_verdict){true, ELEMENTARY_ROOTS};
    }
    return (elementary_verdict){false, ELEMENTARY_ROOTS};
}

elementary_verdict elementary_after_signs(const elementary_query *query, cscd_contact_kind kind,
                                          elementary_contact *contact) {
    point_vectors vectors;
    point_vectors_from(query, kind, &vectors);
    coplanarity f = coplanarity_cubic(&vectors);
    return decide_at_roots(query, &vectors, kind, &f, contact);
}
