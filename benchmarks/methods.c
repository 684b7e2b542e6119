/* The methods side by side on recordings, and what each of them loses. */
#include "tool/common/methods.h"
#include "benchmarks/lib/contest.h"
#include "benchmarks/lib/recording_program.h"
#include "cscd/research.h"
#include "tool/io/json.h"

#include <stdio.h>

enum { KMEANS_RUNS = 5, ROUNDS = 5 };

static const char help[] =
    "usage: methods [--quick] [--json OUT.json] [--threads N] [--cache FOLDER] [--data FOLDER] [SCENE...]\n"
    "\n"
    "Replays recordings with every method and prints stages and pairs, what each method loses of the\n"
    "contacts that method none finds, and ratios. A contact list that breaks its method's guarantee is an\n"
    "error. Milliseconds are of processor time; all methods take turns, and of each interval the quickest of five\n"
    "rounds counts. '+' behind a method: mode earliest. 'kdop14': trees of 14-DOPs, not boxes. Plans are made anew,\n"
    "and missing recordings first; neither is counted, nor the first interval, which builds trees.\n"
    "\n"
    "  --quick          pawn-drop, dumbbell-stairs and figure-balls, one thread, fewer repeats\n"
    "  --json OUT.json  all rows, and where they come from\n"
    "  --threads N      default 1\n"
    "  --cache FOLDER   recordings (default build/models)\n"
    "  --data FOLDER    more recordings, NAME.obj with NAME.pc2 (default: sequences/ in\n"
    "                   CSCD_DATA, if that is set)\n";

/* ---- table and JSON ------------------------------------------------------------------------------------ */

enum { RESULTS_MAX = 32 };

/* The results on one recording; methods none and iccd come first. */
typedef struct methods_report {
    const truth *truth;
    contest_result results[RESULTS_MAX];
    uint32_t count, regions;
} methods_report;

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

static void methods_report_print(const methods_report *r) {
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

/* Writes one object per method over all intervals: means per interval, but losses per run. */
static void methods_report_write(const methods_report *r, json *out, uint32_t thread_count) {
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

/* ---- what takes part --------------------------------------------------------------------------------- */

typedef struct entrants {
    entrant items[RESULTS_MAX];
    uint32_t count;
    bool has_regions; /* something is closed */
} entrants;

/* Enters a method, except one by regions when nothing is closed, for then there are none. */
static void enter_method(entrants *list, cscd_method method, cscd_mode mode, cscd_volume volume) {
    const bool charge = method == CSCD_METHOD_CHARGE;
    if (charge && !list->has_regions) return;
    entrant e = {
        .method = method, .mode = mode, .volume = volume, .plan = charge ? method : CSCD_METHOD_NONE};
    snprintf(e.name, sizeof e.name, "%s%s%s", cscd_method_name(method), mode == CSCD_MODE_EARLIEST ? "+" : "",
             volume == CSCD_VOLUME_KDOP14 ? " kdop14" : "");
    list->items[list->count++] = e;
}

/* Enters k-means with five seeded runs, as in the thesis. */
static void enter_kmeans(entrants *list, uint32_t k, cscd_mode mode) {
    if (!list->has_regions) return;
    entrant e = {
        .method = CSCD_METHOD_KMEANS, .mode = mode, .plan = CSCD_METHOD_KMEANS, .k = k, .runs = KMEANS_RUNS};
    snprintf(e.name, sizeof e.name, "kmeans:%u%s", k, mode == CSCD_MODE_EARLIEST ? "+" : "");
    list->items[list->count++] = e;
}

/* The published methods, each with the plan of the thesis. */
static void enter_published(entrants *list) {
    entrant published = {.name = "published", .method = CSCD_METHOD_PUBLISHED, .plan = CSCD_METHOD_PUBLISHED};
    entrant iccd = {.name = "iccd-published", .method = CSCD_METHOD_ICCD_PUBLISHED};
    published.plan = list->has_regions ? published.plan : CSCD_METHOD_NONE;
    list->items[list->count++] = published;
    list->items[list->count++] = iccd;
}

static void enter_all(entrants *list, uint32_t regions, bool every_k) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_CONES,
                                          CSCD_METHOD_SINGLE, CSCD_METHOD_CHARGE};
    const uint32_t from = every_k ? (regions > 3 ? regions - 2 : 1) : regions,
                   to = every_k ? regions + 2 : regions;
    for (int i = 0; i < 5; i++) enter_method(list, methods[i], CSCD_MODE_ALL, CSCD_VOLUME_BOX);
    for (uint32_t k = from; k <= to; k++) enter_kmeans(list, k, CSCD_MODE_ALL);
    for (int i = 3; i < 5; i++) enter_method(list, methods[i], CSCD_MODE_EARLIEST, CSCD_VOLUME_BOX);
    enter_method(list, CSCD_METHOD_NONE, CSCD_MODE_ALL, CSCD_VOLUME_KDOP14);
    enter_method(list, CSCD_METHOD_CHARGE, CSCD_MODE_ALL, CSCD_VOLUME_KDOP14);
    enter_published(list);
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_scene(void *state, const replay_choices *o, const char *scene, json *out, io_error *error) {
    (void)state;
    recording_data data;
    truth known;
    methods_report r = {.count = 0};
    entrants list = {.count = 0};
    const bool own = recording_is_own(scene);
    if (!recording_program_open(o, scene, &data, error)) return false;
    bool good = truth_find(&data, &known, error);
    if (good) {
        r.truth = &known;
        r.regions = data.charge != NULL ? cscd_plan_region_count(data.charge) : 1;
        list.has_regions = data.charge != NULL;
        enter_all(&list, r.regions, own && !o->quick);
        r.count = list.count;
        good = contest_run(&known, list.items, list.count, o->quick ? 1 : ROUNDS, r.results, error);
        if (good) methods_report_print(&r);
        if (good && out != NULL) methods_report_write(&r, out, o->thread_count);
        truth_free(&known);
    }
    recording_data_close(&data);
    return good;
}

int main(int argument_count, char **arguments) {
    static const char *const options[] = {"--threads", NULL};
    static const recording_program program = {"methods", help, options, false, NULL, run_scene, NULL};
    return recording_program_main(&program, argument_count, arguments);
}
