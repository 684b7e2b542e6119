/* Bounding volumes side by side on recordings: spheres, boxes, 14-, 18- and 26-DOPs in a binary tree of swept triangles,
 * as the thesis behind the method has it, which claims that 14-DOPs are the best balance between update and culling. */
#include "benchmarks/lib/recording_program.h"
#include "benchmarks/lib/volume_trial.h"

#include <math.h>
#include <stdio.h>

static const char help[] =
    "usage: volumes [--quick] [--json OUT.json] [--simd LEVEL] [--cache FOLDER] [--data FOLDER] [SCENE...]\n"
    "\n"
    "Replays recordings with five kinds of bounding volumes in the same binary tree, one triangle a leaf, and prints per\n"
    "interval: pairs of volumes that are tested; pairs of triangles that are found and share no vertex; milliseconds of\n"
    "processor time, on one thread, of the refit and of the search; of the tests of the pairs as a step does them\n"
    "(filtered), and without its filter of features (direct); sums of the first two and either test. Medians of five\n"
    "rounds, in which all kinds take turns. With 'none' nothing is culled; with 'single' and 'charge' the search leaves out\n"
    "what a step of that method does, and pairs that share a vertex are tested and counted, too. Pays from: so many\n"
    "nanoseconds must the test of a pair cost for the kind to be as fast as boxes. It is an error when a kind misses a pair\n"
    "in contact, or when k-DOPs do not nest.\n"
    "\n"
    "  --quick          pawn-drop, dumbbell-stairs and figure-balls, every tenth interval\n"
    "  --json OUT.json  all rows, and where they come from\n"
    "  --simd LEVEL     auto (default), scalar, avx2, avx512, neon\n"
    "  --cache FOLDER   recordings (default build/models)\n"
    "  --data FOLDER    more recordings, NAME.obj with NAME.pc2 (default: sequences/ in\n"
    "                   CSCD_DATA, if that is set; then also the cloth of frames/)\n";

enum { METHODS = 3, QUICK_STRIDE = 10 };

static const cscd_method methods[METHODS] = {CSCD_METHOD_NONE, CSCD_METHOD_SINGLE, CSCD_METHOD_CHARGE};

/* The volumes that are compared with boxes, over all recordings. */
typedef enum summed_column {
    SUM_TESTS,
    SUM_PAIRS,
    SUM_REFIT,
    SUM_SEARCH,
    SUM_BOTH,
    SUM_FILTERED,
    SUM_DIRECT,
    SUM_COLUMNS
} summed_column;

/* Sums of logarithms of ratios to boxes: of medians, and of each round. */
typedef struct volume_summary {
    double logs[METHODS][VOLUME_KINDS][SUM_COLUMNS];
    double rounds[METHODS][VOLUME_KINDS][VOLUME_ROUNDS]; /* of SUM_BOTH */
    uint32_t recordings[METHODS];
} volume_summary;

/* ---- rows -------------------------------------------------------------------------------------------- */

static double both_ms(const volume_cost *c) {
    return c->ms[VOLUME_REFIT] + c->ms[VOLUME_SEARCH];
}

static double column_of(const volume_cost *c, summed_column column) {
    switch (column) {
    case SUM_TESTS:
        return c->tests;
    case SUM_PAIRS:
        return c->pairs;
    case SUM_REFIT:
        return c->ms[VOLUME_REFIT];
    case SUM_SEARCH:
        return c->ms[VOLUME_SEARCH];
    case SUM_BOTH:
        return both_ms(c);
    case SUM_FILTERED:
        return both_ms(c) + c->ms[VOLUME_FILTERED];
    default:
        return both_ms(c) + c->ms[VOLUME_DIRECT];
    }
}

/* Prints from which price of a pair on a kind is faster than boxes, or up to which. */
static void print_price(const volume_cost *c, const volume_cost *box) {
    double saved = box->pairs - c->pairs, dearer = both_ms(c) - both_ms(box);
    if (c == box)
        printf(" %12s\n", "");
    else if (saved <= 0.0)
        printf(" %12s\n", dearer >= 0.0 ? "never" : "always");
    else if (dearer <= 0.0)
        printf(" %12s\n", "always");
    else
        printf(" %9.0f ns\n", dearer / saved * 1e6);
}

static void print_result(const recording_data *data, const volume_result *r) {
    const volume_cost *box = &r->of[VOLUME_BOX];
    printf("\n%s, %s: %u triangles, %u intervals, %.1f contacts, %.0f pairs that share a vertex\n"
           "  %-8s %9s %9s %8s %8s %8s %8s %8s %9s %9s %8s %12s\n",
           data->name, cscd_method_name(r->method), data->model.triangle_count, r->intervals, r->contacts,
           box->adjacent, "volume", "tests", "pairs", "refit", "search", "both", "filtered", "direct",
           "+filtered", "+direct", "both/box", "pays from");
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        const volume_cost *c = &r->of[kind];
        printf("  %-8s %9.0f %9.0f", volume_kind_name((volume_kind)kind), c->tests, c->pairs);
        printf(" %8.3f %8.3f %8.3f %8.3f %8.3f %9.3f %9.3f %8.2f", c->ms[VOLUME_REFIT], c->ms[VOLUME_SEARCH],
               both_ms(c), c->ms[VOLUME_FILTERED], c->ms[VOLUME_DIRECT], column_of(c, SUM_FILTERED),
               column_of(c, SUM_DIRECT), both_ms(c) / both_ms(box));
        print_price(c, box);
    }
}

static void write_result(const recording_data *data, const volume_result *r, json *out) {
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        const volume_cost *c = &r->of[kind];
        json_break_line(out);
        json_begin_object(out, NULL);
        json_string(out, "scene", data->name);
        json_string(out, "method", cscd_method_name(r->method));
        json_string(out, "volume", volume_kind_name((volume_kind)kind));
        json_integer(out, "triangles", data->model.triangle_count);
        json_integer(out, "intervals", r->intervals);
        json_number(out, "contacts", r->contacts);
        json_number(out, "tests", c->tests);
        json_number(out, "pairs", c->pairs);
        json_number(out, "adjacent", c->adjacent);
        json_number(out, "refit_ms", c->ms[VOLUME_REFIT]);
        json_number(out, "search_ms", c->ms[VOLUME_SEARCH]);
        json_number(out, "filtered_ms", c->ms[VOLUME_FILTERED]);
        json_number(out, "direct_ms", c->ms[VOLUME_DIRECT]);
        json_end_object(out);
    }
}

/* ---- all recordings ---------------------------------------------------------------------------------- */

static void add_result(volume_summary *s, int method, const volume_result *r) {
    const volume_cost *box = &r->of[VOLUME_BOX];
    s->recordings[method]++;
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        const volume_cost *c = &r->of[kind];
        for (int i = 0; i < SUM_COLUMNS; i++)
            s->logs[method][kind][i] +=
                log(column_of(c, (summed_column)i) / column_of(box, (summed_column)i));
        for (int k = 0; k < VOLUME_ROUNDS; k++)
            s->rounds[method][kind][k] += log((c->rounds[VOLUME_REFIT][k] + c->rounds[VOLUME_SEARCH][k]) /
                                              (box->rounds[VOLUME_REFIT][k] + box->rounds[VOLUME_SEARCH][k]));
    }
}

static void print_summary(const volume_summary *s, int method) {
    double n = s->recordings[method];
    if (s->recordings[method] == 0) return;
    printf("\nall %u recordings, %s: geometric means of ratios to boxes; least and greatest of five rounds\n"
           "  %-8s %8s %8s %8s %8s %8s %15s %9s %9s\n",
           s->recordings[method], cscd_method_name(methods[method]), "volume", "tests", "pairs", "refit",
           "search", "both", "of a round", "+filtered", "+direct");
    for (int kind = 0; kind < VOLUME_KINDS; kind++) {
        const double *logs = s->logs[method][kind];
        double least = INFINITY, greatest = 0.0;
        for (int k = 0; k < VOLUME_ROUNDS; k++) {
            double ratio = exp(s->rounds[method][kind][k] / n);
            least = fmin(least, ratio);
            greatest = fmax(greatest, ratio);
        }
        printf("  %-8s %8.2f %8.2f %8.2f %8.2f %8.2f %9.2f-%.2f  %9.2f %9.2f\n",
               volume_kind_name((volume_kind)kind), exp(logs[SUM_TESTS] / n), exp(logs[SUM_PAIRS] / n),
               exp(logs[SUM_REFIT] / n), exp(logs[SUM_SEARCH] / n), exp(logs[SUM_BOTH] / n), least, greatest,
               exp(logs[SUM_FILTERED] / n), exp(logs[SUM_DIRECT] / n));
    }
}

static void print_summaries(void *state) {
    const volume_summary *s = state;
    for (int i = 0; i < METHODS; i++) print_summary(s, i);
}

/* ---- the program ------------------------------------------------------------------------------------- */

static bool run_scene(void *state, const replay_choices *o, const char *scene, json *out, io_error *error) {
    volume_summary *s = state;
    recording_data data;
    bool good = true;
    if (!recording_program_open(o, scene, &data, error)) return false;
    for (int i = 0; good && i < METHODS; i++) {
        volume_result r;
        if (methods[i] != CSCD_METHOD_NONE && data.charge == NULL) continue; /* nothing is closed */
        good = volume_trial_run(&data, methods[i], o->simd, o->quick ? QUICK_STRIDE : 1, &r, error);
        if (!good) continue;
        print_result(&data, &r);
        if (out != NULL) write_result(&data, &r, out);
        add_result(s, i, &r);
    }
    recording_data_close(&data);
    return good;
}

int main(int argument_count, char **arguments) {
    static const char *const options[] = {"--simd", NULL};
    volume_summary summary = {.recordings = {0}};
    const recording_program program = {"volumes", help, options, true, &summary, run_scene, print_summaries};
    return recording_program_main(&program, argument_count, arguments);
}
