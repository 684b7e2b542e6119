/* The methods side by side on recordings, and what each of them loses. */
#include "benchmarks/lib/methods_report.h"
#include "benchmarks/lib/recording_program.h"
#include "cscd/research.h"

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
