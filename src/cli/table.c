/* The table at the end of a replay: the thesis' columns, mean and maximum per frame. */
#include "src/cli/summary.h"

#include <stdio.h>

static void add(column *c, double value) {
    c->sum += value;
    c->max = value > c->max ? value : c->max;
}

void totals_add(totals *t, const interval_result *r) {
    if (r->contacts.count > 0 && t->intervals_with_contact++ == 0) t->first_contact_frame = r->frame;
    t->intervals++;
    t->states[r->state]++;
    t->vf += r->counters.vf;
    t->ee += r->counters.ee;
    t->bounded += r->counters.bounded;
    add(&t->update, r->timings.update_ms);
    add(&t->traversal, r->timings.traversal_ms);
    add(&t->contact, r->timings.contact_ms);
    add(&t->check, r->timings.check_ms);
    add(&t->total, r->timings.total_ms);
    add(&t->pcp, (double)r->counters.pcp);
    add(&t->tests, (double)r->counters.tests);
}

static double mean(const column *c, uint32_t count) {
    return count > 0 ? c->sum / count : 0.0;
}

void totals_print_table(const totals *t, const char *method) {
    uint32_t n = t->intervals;
    printf("\n%-8s %12s %12s %12s %12s %12s %12s %12s\n", "method", "BVH update", "orientation", "traversal",
           "contact", "#PCPs", "total", "check");
    printf("%-8s %9.3f ms %12s %9.3f ms %9.3f ms %12.0f %9.3f ms %9.3f ms  mean per frame\n", method,
           mean(&t->update, n), "X", mean(&t->traversal, n), mean(&t->contact, n), mean(&t->pcp, n),
           mean(&t->total, n), mean(&t->check, n));
    printf("%-8s %9.3f ms %12s %9.3f ms %9.3f ms %12.0f %9.3f ms %9.3f ms  maximum\n", "", t->update.max, "X",
           t->traversal.max, t->contact.max, t->pcp.max, t->total.max, t->check.max);
    printf("X: not part of this method. The check is not part of the total.\n");
}
