/* What a replay says to people. */
#include "tool/replay/replay_print.h"

#include "tool/answers/answer_words.h"
#include "tool/common/methods.h"

#include <stdio.h>

/* What a user must know before he relies on the contacts. */
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
