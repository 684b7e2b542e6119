/* Elementary tests: do a moving vertex and face, or two moving edges, touch, and when? Three levels, each of
 * which decides only what it is certain of; docs/theory/elementary.md derives every constant. */

#include "runtime/ccd/elementary_levels.h"
#include "runtime/ccd/exact.h"

#include <assert.h>

enum { HALVINGS = 3 };

static const elementary_verdict apart_by_signs = {false, ELEMENTARY_SIGNS};

/* A root interval must be this narrow for its toi to be the TOI. */
static const double narrow = 0x1p-31;

/* Tries the directions that are cheapest to try, and separate most of the pairs that get here. */
static bool separated_throughout(const elementary_query *query, cscd_contact_kind kind) {
    return separated_by_diagonals(query, kind) || separated_in_plane(query, kind);
}

/* Tries the whole interval, its halves and so on. Features that keep changing sides, as parallel edges that
 * pass close to each other, have no direction for all of it. */
static bool separated_in_halves(const elementary_query *query, cscd_contact_kind kind, double begin,
                                double end, int halvings) {
    if (separated_in_part(query, kind, begin, end)) return true;
    if (halvings == 0) return false;
    double middle = 0.5 * (begin + end);
    return separated_in_halves(query, kind, begin, middle, halvings - 1) &&
           separated_in_halves(query, kind, middle, end, halvings - 1);
}

static elementary_verdict decide_exactly(const elementary_query *query, cscd_contact_kind kind,
                                         const coplanarity *f, elementary_contact *contact) {
    double toi;
    bool touching = exact_touch(query, kind, &toi);
    if (touching) contact_frame_describe(query, kind, f, toi, contact);
    return (elementary_verdict){touching, ELEMENTARY_EXACT};
}

/* Decides where no roots are known. The directions come here, because before level two they cost more than
 * they save. */
static elementary_verdict decide_without_roots(const elementary_query *query, cscd_contact_kind kind,
                                               const coplanarity *f, elementary_contact *contact) {
    if (separated_throughout(query, kind) || separated_in_halves(query, kind, 0.0, 1.0, HALVINGS))
        return apart_by_signs;
    return decide_exactly(query, kind, f, contact);
}

/* A root that is not clear is no contact if the features are certainly apart about it. If a later one is a
 * contact, level three says when, as for every pair whose first contact is not clear. */
static elementary_verdict decide_at_roots(const elementary_query *query, const point_vectors *vectors,
                                          cscd_contact_kind kind, const coplanarity *f,
                                          elementary_contact *contact) {
    root_interval roots[ROOTS_MAX];
    bool passed_unclear = false;
    int count = cubic_isolate(f, roots);
    if (count == ROOTS_UNCERTAIN) return decide_without_roots(query, kind, f, contact);
    for (int i = 0; i < count; i++) {
        assert(roots[i].begin <= roots[i].end && (i == 0 || roots[i - 1].end <= roots[i].begin));
        inside_verdict inside = inside_test(vectors, kind, &roots[i]);
        if (inside == INSIDE_NO) continue;
        bool timed = roots[i].toi >= 0.0 && roots[i].end - roots[i].begin <= narrow;
        if (inside == INSIDE_YES && roots[i].certain && timed && !passed_unclear) {
            contact_frame_describe(query, kind, f, roots[i].toi, contact);
            return (elementary_verdict){true, ELEMENTARY_ROOTS};
        }
        if (!passed_unclear && separated_throughout(query, kind)) return apart_by_signs;
        if (!separated_in_part(query, kind, roots[i].begin, roots[i].end))
            return decide_exactly(query, kind, f, contact);
        passed_unclear = true;
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
