/* Prints what a replay says to people, the sums over its intervals, and the table of stages. */

#include "tool/answers/answers.h"
#include "tool/common/methods.h"
#include "tool/replay/replay_run.h"

#include <stdio.h>

/* Facts that a user must know before he relies on the contacts. */
static void print_limits(const replay *r) {
    const replay_totals *t = &r->totals;
    if (r->options->min_separation > 0.0)
        printf("minimum separation: %g; contacts whose time is a bound only: %llu\n",
               r->options->min_separation, (unsigned long long)t->counter_sum.bounded);
    bool by_method = method_facts_of(r->plan.method).loses_contacts;
    const uint32_t known = t->intervals - t->intervals_unlisted;
    if (t->intervals_complete < known)
        printf("%s %s: in %u of %u intervals %scontacts of a component with itself may be missing\n",
               by_method ? "method" : "mode", by_method ? cscd_method_name(r->plan.method) : "earliest",
               known - t->intervals_complete, t->intervals, by_method ? "" : "later ");
    if (t->contradictions > 0) printf("intervals that lost all their contacts: %u\n", t->contradictions);
}

static void print_timings(const replay *r) {
    const replay_totals *t = &r->totals;
    const int32_t *numbers = r->recording.frame_numbers;
    printf("\n%s: %u vertices, %u triangles, %u component%s; frames %d to %d\n",
           recording_options_path(&r->options->source), cscd_mesh_vertex_count(r->recording.mesh),
           cscd_mesh_triangle_count(r->recording.mesh), cscd_mesh_component_count(r->recording.mesh),
           cscd_mesh_component_count(r->recording.mesh) == 1 ? "" : "s", numbers[r->first],
           numbers[r->first + t->intervals]);
    printf("intervals: %u clean, %u with contact, %u intersecting, %u unknown\n", t->states[INTERVAL_CLEAN],
           t->states[INTERVAL_CONTACT], t->states[INTERVAL_PENETRATING], t->states[INTERVAL_UNKNOWN]);
    totals_print_table(t, r->plan.method);
    if (t->frames_checked > 0) answers_print_frames(&r->answers, &r->unit);
}

void replay_print_results(const replay *r) {
    const replay_totals *t = &r->totals;
    answers_print_sentence(stdout, &r->answers, &r->unit);
    if (t->intervals == 0) return;
    answers_print_events(&r->answers, &r->unit);
    printf("%scontacts: %llu VF and %llu EE", r->answers.event_count > 0 ? "\n" : "",
           (unsigned long long)t->counter_sum.vf, (unsigned long long)t->counter_sum.ee);
    if (t->intervals_unlisted > 0)
        printf(" that are listed, and %llu that are not,", (unsigned long long)t->contacts_unlisted);
    printf(" in %u of %u intervals", t->intervals_with_contact, t->intervals);
    frame_list_print(&r->contact_frames, r->recording.frame_numbers, "; from frame ");
    print_limits(r);
    plan_choice_print(&r->plan);
    if (r->options->answers.timings) print_timings(r);
}

void replay_print_remarks(replay *r) {
    recording_warn(&r->recording);
    turned_parts_tell(&r->answers.turned);
    if (r->options->ignored.rest != REST_KEPT)
        printf("%zu triangle pairs that intersect or touch in frame %d are left out%s\n",
               r->ignored.rest_pairs, r->recording.frame_numbers[0],
               r->options->ignored.rest == REST_PARTS ? ", with all pairs of parts that they are in" : "");
}

/* ---- sums over the intervals, and the table of stages ---------------------------------------------------- */

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
