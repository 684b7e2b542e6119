/* Decides for each component and interval whether culling pays, by counts of work and never by the clock.
 *
 * Culling saves most pairs of a component with itself, and costs the orientation of its triangles, pairs of neighbours where
 * orientations differ, and the proof of what is not known to be clean at the start. A component is culled, or it is not,
 * until what the other way would have saved covers the price of changing over: the proof of its start, or the list of
 * orphan pairs. This is the rule for renting or buying skis: whatever comes, the cost is at most about twice that of someone
 * who knows it in advance, and near to it when things go on as they are. Each time that culling has lost, its hopes count for
 * half, so that tries become rare. */
#include "runtime/culling/culling.h"

/* Prices in nanoseconds, on one core with AVX-512; only their ratios matter. Fitted to `cscd replay --no-check --json` by
 * `none` and `single` on the recordings of docs/about/measurements.md and to `scaling`. */
static const double price_of_pairs = 55.0; /* all pairs of a triangle with its component, without culling */
static const double price_of_orientation = 14.0; /* with culling: orienting a triangle, and the traversal */
static const double price_of_kept = 70.0;        /* a pair of triangles that culling keeps */
static const double price_of_proof = 175.0;      /* a triangle that is not known to be free */
static const double price_of_pass = 5.0;         /* a closing pass, for each triangle */
static const double price_of_orphans = 450.0;    /* the list of orphan pairs, for each triangle */

/* Pairs that a triangle has kept when it is tainted, and the most that a component may be hoped to keep for each triangle. */
static const double kept_by_taint = 10.0, kept_at_most = 0.4;

/* Shares of what is new in means that are carried from interval to interval. */
static const double share_of_unproven = 0.25;

enum { DISTRUST_MAX = 5 };

static double triangles_of(const start_states *s, uint32_t component) {
    return s->mesh->components[component].triangle_count;
}

static double smaller_of(double a, double b) {
    return a < b ? a : b;
}

static double larger_of(double a, double b) {
    return a > b ? a : b;
}

/* ---- at the start -------------------------------------------------------------------------------------- */

static double proof_of(const component_start *start) {
    return price_of_proof * (start->unknown + start->crossing);
}

/* Returns the share of its triangles that an interval like this one has to prove in addition to those that
 * earlier ones have left. */
static double fresh_share(const component_start *start, double triangles) {
    if (start->moved || start->culls) return (start->unknown + start->crossing) / triangles;
    return smaller_of(start->touched, 1.0);
}

/* Returns the saving that culling promises in each interval, for each triangle, once the start is proven. */
static double hope_of(const component_start *start) {
    double kept = smaller_of(start->kept, kept_at_most) + kept_by_taint * start->unproven_now;
    return price_of_pairs - price_of_orientation - price_of_kept * kept -
           price_of_proof * start->unproven_now;
}

static bool changes_over(const component_start *start, double triangles, bool proves) {
    if (start->culls) {
        double price = start->has_been_plain ? 0.05 * price_of_orphans : price_of_orphans;
        return start->regret >= triangles * price;
    }
    double price = larger_of(proves ? proof_of(start) : 0.0, 0.1 * triangles * price_of_proof);
    return hope_of(start) > 0.0 && start->regret >= price;
}

void culling_choice_decide(start_states *s, bool proves) {
    for (uint32_t c = 0; s->adapts && c < s->mesh->component_count; c++) {
        component_start *start = &s->of[c];
        double fresh = fresh_share(start, triangles_of(s, c));
        start->unproven_now =
            start->seen ? start->unproven + share_of_unproven * (fresh - start->unproven) : 0.0;
        start->chosen = start->culls != changes_over(start, triangles_of(s, c), proves);
        if (start->chosen && !start->culls) start->pause = start->backoff = 0;
        start->proof = proves && start->chosen && start->pause == 0 ? proof_of(start) : 0.0;
    }
}

/* ---- at the end ---------------------------------------------------------------------------------------- */

/* A component that chose culling in vain, because too little of it was clean, has paid only for the proof. */
static void learn_from_culling(component_start *start, double triangles, bool culled, uint64_t passes) {
    double each = price_of_pairs - price_of_orientation - price_of_kept * start->kept -
                  price_of_pass * (double)(passes < 16 ? passes : 16);
    double saved = (culled ? each * triangles : 0.0) - start->proof;
    start->stay = (start->culls ? start->stay : 0.0) + saved;
    bool goes_on = start->seen && start->culls; /* otherwise the proof is the price of changing over */
    start->regret = goes_on ? larger_of(0.0, start->regret - saved) : 0.0;
    start->has_been_plain |= !culled;
}

static void learn_without_culling(component_start *start, double triangles) {
    if (start->culls) { /* until now */
        start->distrust = start->stay >= 0.0 ? 0 : start->distrust + (start->distrust < DISTRUST_MAX);
        start->regret = 0.0;
        start->has_been_plain = true;
    }
    double hope = triangles * hope_of(start) / (double)(1u << start->distrust);
    start->regret = larger_of(0.0, start->regret + hope);
}

/* A contact taints some triangles, and neighbouring contacts mostly the same. */
static double share_touched(uint32_t contacts, double triangles, bool forgets) {
    if (forgets) return contacts > 0 ? 1.0 : 0.0;
    return 2.0 * contacts / triangles;
}

bool culling_choice_begins(const start_states *s) {
    bool begins = false;
    for (uint32_t c = 0; s->adapts && c < s->mesh->component_count; c++)
        begins |= s->of[c].chosen && !(s->of[c].culls && s->of[c].seen);
    return begins;
}

void culling_choice_learn(start_states *s, const culling_outcome *outcome) {
    for (uint32_t c = 0; s->adapts && c < s->mesh->component_count; c++) {
        component_start *start = &s->of[c];
        double triangles = triangles_of(s, c);
        if (outcome->culled[c] && outcome->kept != NULL) start->kept = outcome->kept[c] / triangles;
        if (start->chosen)
            learn_from_culling(start, triangles, outcome->culled[c], outcome->passes);
        else
            learn_without_culling(start, triangles);
        start->touched = share_touched(outcome->contacts[c], triangles, outcome->forgets);
        start->unproven = start->unproven_now;
        start->culls = start->chosen;
        start->seen = true;
        start->moved = false;
    }
}
