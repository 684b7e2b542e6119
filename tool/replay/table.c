/* Results of a replay summed over its intervals, and the table at its end. */
#include "tool/replay/table.h"

#include <stdio.h>

/* A component without a surface is told of by itself. */
static bool all_complete(const cscd_guarantee *guarantees, const cscd_mesh *mesh) {
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++) {
        if (!guarantees[i].complete && guarantees[i].reason != CSCD_REASON_COLLAPSED) return false;
    }
    return true;
}

void totals_add(replay_totals *t, const interval_result *r, const cscd_mesh *mesh) {
    if (r->contact_count > 0 && t->intervals_with_contact++ == 0) t->first_contact_frame = r->frame;
    t->intervals++;
    t->states[r->state]++;
    if (r->guarantees != NULL)
        t->intervals_complete += all_complete(r->guarantees, mesh);
    else {
        t->intervals_unlisted++;
        t->contacts_unlisted += r->contact_count;
    }
    timings_add(&t->time_sum, &t->time_max, &r->timings);
    counters_add(&t->counter_sum, &t->counter_max, &r->counters);
}

/* Prints the stages that the method has, X for the others; the pairs; the total and the check. */
static void print_row(const char *name, cscd_method method, const cscd_timings *ms, double count, double pcp,
                      const char *what) {
    printf("%-14s", name);
    for (int i = 0; i < TIMING_STAGES; i++) {
        if (timing_applies(&timing_rows[i], method))
            printf(" %9.3f ms", timing_ms(ms, &timing_rows[i]) / count);
        else
            printf(" %12s", "X");
    }
    printf(" %12.0f %9.3f ms %9.3f ms  %s\n", pcp / count, ms->total_ms / count, ms->check_ms / count, what);
}

void totals_print_table(const replay_totals *t, cscd_method method) {
    double count = t->intervals > 0 ? t->intervals : 1.0;
    printf("\n%-14s", "method");
    for (int i = 0; i < TIMING_STAGES; i++) printf(" %12s", timing_rows[i].title);
    printf(" %12s %12s %12s\n", "#PCPs", "total", "check");
    print_row(cscd_method_name(method), method, &t->time_sum, count, (double)t->counter_sum.pcp,
              "mean per frame");
    print_row("", method, &t->time_max, 1.0, (double)t->counter_max.pcp, "maximum");
    printf("X: a stage that this method does not have. The check of frames is not part of the total.\n");
}
