/* The worth of particle sensors: recall, false alarms and time on scenes of many objects, compared with the
 * detector. */
#include "benchmarks/lib/scene_files.h"
#include "benchmarks/sensors/trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: sensors [--folder FOLDER] [--only rules|reach|cost] [SCENE...]\n"
    "\n"
    "Recall and precision are of pairs of objects and intervals: those with a warning against those in which the\n"
    "detector finds a contact. Times are medians, ms a step; the detector is method none. Scenes: recordings\n"
    "NAME.obj and NAME.pc2 in FOLDER (default build/models, by make models); a plan by charge is made where\n"
    "NAME.plan.ply is missing. Cost, by size and by number of objects, has bodies of its own.\n";

static const char *const all_scenes[] = {"two-spheres",   "two-spheres-unequal",
                                         "three-spheres", "three-spheres-unequal",
                                         "v-shape",       "u-pair",
                                         "u-three",       "mixed",
                                         "t-pair",        "w-pair",
                                         "tumble"};

typedef enum table { TABLE_RULES, TABLE_REACH, TABLE_COST, TABLE_COUNT } table;

static const char *const table_names[TABLE_COUNT] = {"rules", "reach", "cost"};

enum { SCENES = sizeof all_scenes / sizeof *all_scenes, RANDOM_SEEDS = 5 };

/* ---- the methods --------------------------------------------------------------------------------------- */

static const sensor_rules rules[] = {
    {.name = "cells"},
    {.name = "cells, plan", .plan = true},
    {.name = "cells, vector", .rule = RULE_VECTOR},
    {.name = "cells, scalar", .rule = RULE_SCALAR},
    {.name = "cells, strongest", .rule = RULE_STRONGEST},
    {.name = "cells, mu 1 edge", .mu_edges = 1.0},
    {.name = "cells, mu 1/2 edge", .mu_edges = 0.5},
};

static const sensor_rules random_rules[] = {
    {.name = "random, 5", .random = true, .particles = 5},
    {.name = "random, as cells", .random = true, .as_cells = true},
};

static void print_sweep(const char *scene, const char *rule, const sensor_trial *t) {
    printf("  %-21s %-18s %8.0f %7.0f %8.0f %7.4f %9.3f %9.3f %10.2f %10.2f %9.2f\n", scene, rule,
           t->touching, t->touching - t->found, t->warned - t->found, t->found / t->touching,
           t->found / t->warned, t->confirmed / t->touching, 1e-6 * t->vertices, 1e-6 * t->pairs, t->ms);
    fflush(stdout);
}

static void print_trial(const char *scene, const char *method, const sensor_trial *t, uint32_t runs) {
    double n = runs;
    printf("  %-21s %-18s %9.0f %8.0f %7.1f %8.1f %7.3f %9.3f %9.3f %7.1f %6.1f %9.3f %8.2f\n", scene, method,
           t->particles / n, t->touching / n, (t->touching - t->found) / n, (t->warned - t->found) / n,
           t->touching > 0 ? t->found / t->touching : 1.0, t->warned > 0 ? t->found / t->warned : 1.0,
           t->touching > 0 ? t->confirmed / t->touching : 1.0, t->rounds / n, 100.0 * t->cycles / n,
           t->ms / n, t->ms / n / t->trees_ms);
    fflush(stdout);
}

/* Shows the mean over some seeds, and how many of them have missed something. */
static bool run_random(const recording_data *r, const sensor_truth *truth, const sensor_rules *rule,
                       io_error *error) {
    sensor_trial sum = {0};
    sensor_rules seeded = *rule;
    double least = 1.0, most = 0.0;
    for (uint32_t seed = 1; seed <= RANDOM_SEEDS; seed++) {
        sensor_trial one;
        seeded.seed = seed;
        if (!sensor_trial_run(r, truth, &seeded, &one, error)) return false;
        sensor_trial_add(&sum, &one);
        double recall = one.touching > 0 ? one.found / one.touching : 1.0;
        least = recall < least ? recall : least;
        most = recall > most ? recall : most;
    }
    print_trial(r->name, rule->name, &sum, RANDOM_SEEDS);
    printf("  %-21s   recall of %d seeds: %.3f to %.3f\n", "", RANDOM_SEEDS, least, most);
    return true;
}

static bool run_scene(const recording_data *r, io_error *error) {
    sensor_truth truth;
    if (!sensor_truth_find(r, &truth, error)) return false;
    bool good = true;
    for (size_t i = 0; good && i < sizeof rules / sizeof *rules; i++) {
        sensor_trial trial;
        good = sensor_trial_run(r, &truth, &rules[i], &trial, error);
        if (good) print_trial(r->name, rules[i].name, &trial, 1);
    }
    for (size_t i = 0; good && i < sizeof random_rules / sizeof *random_rules; i++)
        good = run_random(r, &truth, &random_rules[i], error);
    if (good) printf("  %-21s %-18s %87.3f\n", r->name, "detector by trees", truth.trees_ms);
    sensor_truth_free(&truth);
    return good;
}

/* ---- how far they feel, and how many ------------------------------------------------------------------ */

static const sensor_rules sweep[] = {
    {.name = "default"},
    {.name = "R_eff mu", .reach_mu = 1.0},
    {.name = "R_eff 2 mu", .reach_mu = 2.0},
    {.name = "R_eff 4 mu", .reach_mu = 4.0},
    {.name = "R_eff mu + 1 cell", .reach_mu = 1.0, .reach_cells = 1.0},
    {.name = "R_eff mu + 2 cells", .reach_mu = 1.0, .reach_cells = 2.0},
    {.name = "vector, 2 mu", .rule = RULE_VECTOR, .reach_mu = 2.0},
    {.name = "scalar, 2 mu", .rule = RULE_SCALAR, .reach_mu = 2.0},
    {.name = "strongest, mu", .rule = RULE_STRONGEST, .reach_mu = 1.0},
    {.name = "strongest, 2 mu", .rule = RULE_STRONGEST, .reach_mu = 2.0},
    {.name = "strongest, 4 mu", .rule = RULE_STRONGEST, .reach_mu = 4.0},
    {.name = "1 cell", .cells = 1},
    {.name = "4 cells", .cells = 4},
    {.name = "12 cells", .cells = 12},
    {.name = "36 cells", .cells = 36},
    {.name = "36, R_eff 2 mu", .cells = 36, .reach_mu = 2.0},
    {.name = "108, R_eff 2 mu", .cells = 108, .reach_mu = 2.0},
};

enum { SWEEP = sizeof sweep / sizeof *sweep };

static sensor_trial swept[SWEEP];

/* Adds to the sums over all scenes; a scene of many objects is also shown by itself. */
static bool run_sweep(const recording_data *r, io_error *error) {
    sensor_truth truth;
    if (!sensor_truth_find(r, &truth, error)) return false;
    bool good = true;
    for (int i = 0; good && i < SWEEP; i++) {
        sensor_trial one;
        good = sensor_trial_run(r, &truth, &sweep[i], &one, error);
        if (!good) break;
        sensor_trial_add(&swept[i], &one);
        if (cscd_mesh_component_count(r->mesh) > 4) print_sweep(r->name, sweep[i].name, &one);
    }
    sensor_truth_free(&truth);
    return good;
}

/* ---- the program -------------------------------------------------------------------------------------- */

static bool for_scenes(const char *folder, const char *const *names, size_t count,
                       bool (*run)(const recording_data *, io_error *), io_error *error) {
    for (size_t i = 0; i < count; i++) {
        recording_data r;
        if (!recording_data_open(folder, names[i], 1, &r, error)) return false;
        bool good = run(&r, error);
        recording_data_close(&r);
        if (!good) return false;
    }
    return true;
}

static void print_heads(table t) {
    if (t == TABLE_RULES)
        printf("\n  %-21s %-18s %9s %8s %7s %8s %7s %9s %9s %7s %6s %9s %8s\n", "scene", "method",
               "particles", "touching", "missed", "false", "recall", "precision", "confirmed", "rounds",
               "cyc %", "ms", "of trees");
    if (t == TABLE_REACH)
        printf(
            "\nhow far particles feel, and how many they are: cells, no plan; all scenes (ms: the sum of their "
            "medians)\n  %-21s %-18s %8s %7s %8s %7s %9s %9s %10s %10s %9s\n",
            "scene", "rule", "touching", "missed", "false", "recall", "precision", "confirmed", "vertices M",
            "pairs M", "ms");
}

static bool print_table(table t, const char *folder, const char *const *names, size_t count,
                        io_error *error) {
    print_heads(t);
    switch (t) {
    case TABLE_RULES:
        return for_scenes(folder, names, count, run_scene, error);
    case TABLE_REACH:
        if (!for_scenes(folder, names, count, run_sweep, error)) return false;
        for (int i = 0; i < SWEEP; i++) print_sweep("all", sweep[i].name, &swept[i]);
        return true;
    default:
        return sensor_cost_print(error);
    }
}

int main(int argument_count, char **arguments) {
    const char *folder = "build/models";
    int only = -1, next = 1;
    for (; next + 1 < argument_count && strncmp(arguments[next], "--", 2) == 0; next += 2) {
        if (strcmp(arguments[next], "--folder") == 0) folder = arguments[next + 1];
        for (int t = 0; t < TABLE_COUNT && strcmp(arguments[next], "--only") == 0; t++)
            if (strcmp(arguments[next + 1], table_names[t]) == 0) only = t;
    }
    if (next < argument_count && arguments[next][0] == '-') {
        fputs(help, stdout);
        return strcmp(arguments[next], "--help") == 0 ? 0 : 2;
    }
    io_error error = {""};
    bool named = next < argument_count, good = true;
    const char *const *names = named ? (const char *const *)(arguments + next) : all_scenes;
    for (int t = 0; good && t < TABLE_COUNT; t++)
        if (only < 0 ? t < TABLE_COST || !named : t == only)
            good = print_table((table)t, folder, names, named ? (size_t)(argument_count - next) : SCENES,
                               &error);
    if (!good) fprintf(stderr, "sensors: %s\n", error.text);
    return good ? 0 : 1;
}
