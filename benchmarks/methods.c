/* The methods side by side on recordings: the tables of the thesis, and what each method loses. */
#include "benchmarks/lib/methods_report.h"
#include "benchmarks/lib/recording_program.h"
#include "benchmarks/lib/thesis_numbers.h"
#include "cscd/research.h"

#include <stdio.h>

enum { KMEANS_RUNS = 5, REPEATS = 3 };

static const char help[] =
    "usage: methods [--quick] [--json OUT.json] [--threads N] [--cache FOLDER] [--data FOLDER] [SCENE...]\n"
    "\n"
    "Replays recordings with every method and prints the thesis's columns, what each method loses of the\n"
    "contacts that method none finds, and ratios. A contact list that breaks its method's guarantee is an\n"
    "error. '+' behind a method: mode earliest. 'kdop14': trees of 14-DOPs, not boxes. What is missing is "
    "made first, and not counted.\n"
    "\n"
    "  --quick          pawn-drop, dumbbell-stairs and figure-balls, one thread, fewer repeats\n"
    "  --json OUT.json  all rows, and where they come from\n"
    "  --threads N      default 1\n"
    "  --cache FOLDER   recordings and plans (default build/models)\n"
    "  --data FOLDER    more recordings, NAME.obj with NAME.pc2 (default: sequences/ in\n"
    "                   CSCD_DATA, if that is set)\n";

/* ---- what takes part --------------------------------------------------------------------------------- */

static bool enter_contest(methods_report *r, const entrant *e, uint32_t repeats, io_error *error) {
    if (!contest_run(r->truth, e, repeats, &r->results[r->count], error)) return false;
    r->count++;
    return true;
}

/* Enters a method, except one by regions when nothing is closed, for then there are none. */
static bool enter_method(methods_report *r, cscd_method method, cscd_mode mode, uint32_t repeats,
                         io_error *error) {
    if (method == CSCD_METHOD_CHARGE && r->truth->recording->charge == NULL) return true;
    entrant e = {.method = method, .mode = mode};
    snprintf(e.name, sizeof e.name, "%s%s", cscd_method_name(method), mode == CSCD_MODE_EARLIEST ? "+" : "");
    return enter_contest(r, &e, repeats, error);
}

/* Enters a method with trees of 14-DOPs, to measure whether they pay. */
static bool enter_kdop14(methods_report *r, cscd_method method, uint32_t repeats, io_error *error) {
    if (method == CSCD_METHOD_CHARGE && r->truth->recording->charge == NULL) return true;
    entrant e = {.method = method, .mode = CSCD_MODE_ALL, .volume = CSCD_VOLUME_KDOP14};
    snprintf(e.name, sizeof e.name, "%s kdop14", cscd_method_name(method));
    return enter_contest(r, &e, repeats, error);
}

/* Enters k-means with five seeded runs, as in the thesis. */
static bool enter_kmeans(methods_report *r, uint32_t k, cscd_mode mode, io_error *error) {
    if (r->truth->recording->charge == NULL) return true;
    entrant e = {.method = CSCD_METHOD_KMEANS, .mode = mode, .k = k, .seed = 1};
    snprintf(e.name, sizeof e.name, "kmeans:%u%s", k, mode == CSCD_MODE_EARLIEST ? "+" : "");
    return enter_contest(r, &e, KMEANS_RUNS, error);
}

static bool enter_all(methods_report *r, bool every_k, uint32_t repeats, io_error *error) {
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_SINGLE,
                                          CSCD_METHOD_CHARGE};
    uint32_t n = r->regions, from = every_k ? (n > 3 ? n - 2 : 1) : n, to = every_k ? n + 2 : n;
    bool good = true;
    for (int i = 0; good && i < 4; i++)
        good = enter_method(r, methods[i], CSCD_MODE_ALL, repeats, error) &&
               (i != 1 || enter_method(r, CSCD_METHOD_CONES, CSCD_MODE_ALL, repeats, error));
    for (uint32_t k = from; good && k <= to; k++) good = enter_kmeans(r, k, CSCD_MODE_ALL, error);
    for (int i = 2; good && i < 4; i++)
        good = enter_method(r, methods[i], CSCD_MODE_EARLIEST, repeats, error);
    for (uint32_t k = from; good && k <= to; k++) good = enter_kmeans(r, k, CSCD_MODE_EARLIEST, error);
    good = good && enter_kdop14(r, CSCD_METHOD_NONE, repeats, error) &&
           enter_kdop14(r, CSCD_METHOD_CHARGE, repeats, error);
    return good && enter_method(r, CSCD_METHOD_PUBLISHED, CSCD_MODE_ALL, repeats, error) &&
           enter_method(r, CSCD_METHOD_ICCD_PUBLISHED, CSCD_MODE_ALL, repeats, error);
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_scene(void *state, const replay_choices *o, const char *scene, json *out, io_error *error) {
    (void)state;
    recording_data data;
    truth known;
    methods_report r = {.count = 0};
    bool own = recording_is_own(scene);
    if (!recording_program_open(o, scene, &data, error)) return false;
    bool good = truth_find(&data, &known, error);
    if (good) {
        r.truth = &known;
        r.regions = data.charge != NULL ? cscd_plan_region_count(data.charge) : 1;
        good = enter_all(&r, own && !o->quick, own && !o->quick ? REPEATS : 1, error);
        if (good) methods_report_print(&r);
        if (good) thesis_numbers_print(scene);
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
