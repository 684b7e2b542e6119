/* The table and the JSON of benchmarks/methods. */
#include "benchmarks/lib/methods_report.h"

#include "tool/common/methods.h"

#include <stdio.h>

/* Prints the time of a stage, which the method may not have. */
static void print_stage(double ms) {
    if (ms > 0.0)
        printf(" %7.3f", ms);
    else
        printf(" %7s", "X");
}

/* Prints how much more the reference costs, and how much more it would if the method's own stages cost
 * nothing, so that only the update and the elementary tests were left. */
static void print_ratio(const score *reference, const score *s) {
    printf(" %5.2f (%5.2f)", reference->ms.total_ms / s->ms.total_ms,
           reference->ms.total_ms / (s->ms.update_ms + s->ms.contact_ms));
}

static void print_row(const contest_result *r, const score *s, const score *none, const score *iccd) {
    printf("  %-16s", r->entrant.name);
    for (int i = 0; i < TIMING_STAGES; i++) print_stage(timing_ms(&s->ms, &timing_rows[i]));
    printf(" %8.0f %8.0f %8.1f %6.1f %6.1f %7.3f %6.3f-%-6.3f", s->pcp, s->tests, s->contacts,
           s->losses.earliest_lost, s->losses.lost, s->ms.total_ms, r->least_ms, r->most_ms);
    print_ratio(none, s);
    print_ratio(iccd, s);
    putchar('\n');
}

static void print_class(const methods_report *r, int only, const char *title) {
    score none = score_mean(r->results[0].classes, only), iccd = score_mean(r->results[1].classes, only);
    if (none.intervals == 0) return;
    printf("\n  %s\n  %-16s", title, "method");
    for (int i = 0; i < TIMING_STAGES; i++) printf(" %7s", timing_rows[i].label);
    printf(" %8s %8s %8s %6s %6s %7s %13s %13s %13s\n", "#PCPs", "tests", "contacts", "e.lost", "lost",
           "total", "all: min-max", "none/ (bound)", "ICCD/ (bound)");
    for (uint32_t i = 0; i < r->count; i++) {
        score s = score_mean(r->results[i].classes, only);
        print_row(&r->results[i], &s, &none, &iccd);
    }
}

void methods_report_print(const methods_report *r) {
    const recording_data *data = r->truth->recording;
    uint32_t intervals = data->frame_count - 1, proven = r->truth->proven_count;
    char title[160];
    printf("\n%s: %u triangles, %u intervals, %u regions by charge; ms per interval\n", data->name,
           data->model.triangle_count, intervals, r->regions);
    snprintf(title, sizeof title, "all %u intervals", intervals);
    print_class(r, CLASS_COUNT, title);
    if (proven == 0 || proven == intervals) return;
    snprintf(title, sizeof title, "%u intervals that start proven to be embedded", proven);
    print_class(r, CLASS_PROVEN, title);
    snprintf(title, sizeof title,
             "%u intervals that do not: a component without a proven start gets every contact, with + too",
             intervals - proven);
    print_class(r, CLASS_OTHER, title);
}

static void write_stages(json *out, const cscd_timings *ms) {
    for (int i = 0; i < TIMING_STAGES; i++) {
        char key[32];
        snprintf(key, sizeof key, "%s_ms", timing_rows[i].key);
        json_number(out, key, timing_ms(ms, &timing_rows[i]));
    }
}

void methods_report_write(const methods_report *r, json *out, uint32_t thread_count) {
    for (uint32_t i = 0; i < r->count; i++) {
        const entrant *e = &r->results[i].entrant;
        score s = score_mean(r->results[i].classes, CLASS_COUNT);
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "scene", r->truth->recording->name);
        json_string(out, "method", e->name);
        json_string(out, "mode", cscd_name(CSCD_MODES, e->mode));
        json_string(out, "volume", cscd_name(CSCD_VOLUMES, e->volume));
        json_integer(out, "threads", thread_count);
        json_integer(out, "triangles", r->truth->recording->model.triangle_count);
        json_number(out, "ttcd_ms", s.ms.total_ms);
        json_number(out, "ttcd_min_ms", r->results[i].least_ms);
        json_number(out, "ttcd_max_ms", r->results[i].most_ms);
        write_stages(out, &s.ms);
        json_number(out, "pcp", s.pcp);
        json_number(out, "tests", s.tests);
        json_number(out, "contacts", s.contacts);
        json_number(out, "earliest_lost", s.losses.earliest_lost);
        json_number(out, "lost", s.losses.lost);
        json_number(out, "invented", s.losses.invented);
        json_end_object(out);
    }
}
