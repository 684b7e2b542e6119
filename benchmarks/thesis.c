/* Chapters 5 and 6 of the thesis (Yeh 2012) with our recordings in place of its own: its tables, with its
 * numbers next to ours. */
#include "benchmarks/lib/contest.h"
#include "cscd/research.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { ROUNDS = 3, KMEANS_RUNS = 5, ENTRANTS_MAX = 24 };

/* ---- numbers of the thesis ----------------------------------------------------------------------------- */

/* Measurements of the thesis: figures 5.2 to 5.4 and 6.4. */
/* Milliseconds, as means per frame; a negative stage is not part of the method. The range of the total
 * over five runs of k-means is that of figure 6.4. k 0: its own method; -1: ICCD. */
typedef struct thesis_row {
    int k;
    double update, orientation, contour, traversal, contact, pcp, total, least, most;
} thesis_row;

enum { THESIS_ROWS = 7 };

typedef struct thesis_experiment {
    const char *scene, *title;
    int regions;
    thesis_row rows[THESIS_ROWS]; /* those without a total are none */
} thesis_experiment;

static const thesis_experiment experiments[] = {
    {"pawn-drop",
     "Pawn, 5,130 triangles (figure 5.2)",
     3,
     {{0, 3.0, 0.9, -1, 1.1, 1.8, 2281, 8.3, 8.3, 8.3},
      {1, 3.0, 0.8, -1, 1.5, 1.5, 1925, 8.4, 8.3, 8.4},
      {2, 3.0, 0.8, -1, 1.0, 1.3, 1580, 7.6, 7.5, 7.8},
      {3, 3.0, 0.8, -1, 1.3, 1.4, 1725, 8.1, 8.0, 8.1},
      {4, 3.0, 0.8, -1, 1.6, 1.6, 1892, 8.6, 8.5, 8.7},
      {5, 3.0, 0.8, -1, 1.6, 1.7, 1956, 8.6, 8.4, 9.1},
      {-1, 3.1, -1, 7.3, 3.2, 2.7, 3089, 17.1, 17.1, 17.1}}},
    {"dumbbell-stairs",
     "Dumbbell, 1,710 triangles (figure 5.3)",
     2,
     {{0, 1.0, 0.3, -1, 0.2, 0.3, 339, 2.3, 2.3, 2.3},
      {1, 1.1, 0.3, -1, 0.1, 0.1, 132, 2.3, 2.1, 2.4},
      {2, 1.0, 0.3, -1, 0.2, 0.3, 296, 2.4, 2.2, 2.5},
      {3, 1.1, 0.3, -1, 0.4, 0.4, 374, 2.8, 2.5, 3.1},
      {4, 1.1, 0.3, -1, 0.5, 0.5, 427, 2.9, 2.7, 3.3},
      {-1, 0.9, -1, 2.3, 0.5, 0.5, 473, 4.5, 4.5, 4.5}}},
    {"figure-balls",
     "Luigi, 4,014 triangles (figure 5.4)",
     5,
     {{0, 2.3, 0.6, -1, 0.9, 0.7, 766, 5.9, 5.9, 5.9},
      {3, 2.3, 0.6, -1, 1.0, 0.8, 800, 6.0, 5.8, 6.0},
      {4, 2.3, 0.6, -1, 1.1, 0.8, 806, 6.1, 6.1, 6.2},
      {5, 2.4, 0.6, -1, 1.1, 0.8, 824, 6.2, 5.8, 6.5},
      {6, 2.4, 0.6, -1, 1.1, 0.8, 810, 6.3, 5.9, 6.6},
      {7, 2.4, 0.6, -1, 1.1, 0.9, 845, 6.3, 6.2, 6.5},
      {-1, 2.4, -1, 6.5, 1.9, 1.5, 1432, 12.9, 12.9, 12.9}}},
};

/* The experiment that a recording of ours stands for; NULL: none. */
static const thesis_experiment *thesis_experiment_of(const char *scene) {
    for (size_t i = 0; i < sizeof experiments / sizeof *experiments; i++)
        if (strcmp(experiments[i].scene, scene) == 0) return &experiments[i];
    return NULL;
}

/* ---- tables -------------------------------------------------------------------------------------------- */

static const char *const recordings[] = {"pawn-drop", "dumbbell-stairs", "figure-balls"};
enum { RECORDINGS = 3 };

static const uint64_t detector_steps =
    CSCD_OURS_MOTION | CSCD_OURS_STARTS | CSCD_OURS_REPRESENTATIVES | CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS;

/* The methods of a table, and their results. */
typedef struct thesis_table {
    entrant entrants[ENTRANTS_MAX];
    contest_result results[ENTRANTS_MAX];
    uint32_t count;
} thesis_table;

static entrant *add_entrant(thesis_table *t, const char *name, cscd_method method, cscd_method plan) {
    entrant *e = &t->entrants[t->count++];
    *e = (entrant){.method = method, .plan = plan};
    snprintf(e->name, sizeof e->name, "%s", name);
    return e;
}

static bool run_table(thesis_table *t, const truth *known, io_error *error) {
    return contest_run(known, t->entrants, t->count, ROUNDS, t->results, error);
}

static score mean_of(const thesis_table *t, uint32_t i) {
    return score_mean(t->results[i].classes, CLASS_COUNT);
}

/* ---- figures 5.2 to 5.4 and 6.4 --------------------------------------------------------------------- */

static void print_stage(double ms, const char *format) {
    if (ms > 0.0)
        printf(format, ms);
    else
        printf("%8s", "X");
}

static void print_stages(const cscd_timings *ms, double pcp, const char *format) {
    const double stages[] = {ms->update_ms, ms->orientation_ms, ms->contour_ms, ms->traversal_ms,
                             ms->contact_ms};
    for (int i = 0; i < 5; i++) print_stage(stages[i], format);
    printf("%9.0f", pcp);
    print_stage(ms->total_ms, format);
}

static const thesis_row *row_of(const thesis_experiment *e, int k) {
    for (int i = 0; i < THESIS_ROWS; i++)
        if (e->rows[i].k == k && e->rows[i].total > 0.0) return &e->rows[i];
    return NULL;
}

static void print_thesis(const thesis_row *row) {
    const cscd_timings ms = {.update_ms = row->update,
                             .orientation_ms = row->orientation,
                             .contour_ms = row->contour,
                             .traversal_ms = row->traversal,
                             .contact_ms = row->contact,
                             .total_ms = row->total};
    printf("  %-16s", "  the thesis");
    print_stages(&ms, row->pcp, "%8.1f");
    if (row->most > row->least) printf("%17.1f to %.1f", row->least, row->most);
    putchar('\n');
}

static void print_result(const thesis_table *t, uint32_t i) {
    const contest_result *r = &t->results[i];
    const score s = mean_of(t, i);
    printf("  %-16s", r->entrant.name);
    print_stages(&s.ms, s.apart, "%8.3f");
    if (r->entrant.runs > 1)
        printf("%17.3f to %.3f%10.0f to %.0f", r->least_ms, r->most_ms, r->least_apart, r->most_apart);
    putchar('\n');
}

static void add_kmeans(thesis_table *t, const thesis_experiment *e) {
    for (int i = 0; i < THESIS_ROWS; i++) {
        char name[32];
        if (e->rows[i].k < 1) continue;
        snprintf(name, sizeof name, "K = %d", e->rows[i].k);
        entrant *k = add_entrant(t, name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_KMEANS);
        k->k = (uint32_t)e->rows[i].k;
        k->runs = KMEANS_RUNS;
    }
}

static bool print_experiment(const truth *known, const thesis_experiment *e, io_error *error) {
    thesis_table t = {.count = 0};
    add_entrant(&t, "ours", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED);
    add_kmeans(&t, e);
    add_entrant(&t, "ICCD", CSCD_METHOD_ICCD_PUBLISHED, CSCD_METHOD_NONE);
    if (!run_table(&t, known, error)) return false;
    printf("\n%s, ours %s: %u regions (%d)\n  %-16s%8s%8s%8s%8s%8s%9s%8s%24s%17s\n", e->title, e->scene,
           t.results[0].regions, e->regions, "ms per interval", "BVHUP", "ORIENT", "CNC&CT", "TRA", "Contact",
           "#PCPs", "TTCD", "TTCD of five seeds", "#PCPs of these");
    for (uint32_t i = 0; i < t.count; i++) {
        const entrant *entered = &t.entrants[i];
        print_result(&t, i);
        print_thesis(row_of(e, i == 0 ? 0 : entered->k > 0 ? (int)entered->k : -1));
    }
    const double ours = mean_of(&t, 0).ms.total_ms, iccd = mean_of(&t, t.count - 1).ms.total_ms;
    printf("  ICCD / ours %.2f (%.2f)\n", iccd / ours, row_of(e, -1)->total / row_of(e, 0)->total);
    return true;
}

/* ---- pairs with neighbours, and sound methods ----------------------------------------------------------- */

static bool print_pairs(const truth *known, io_error *error) {
    thesis_table t = {.count = 0};
    static const cscd_method methods[] = {CSCD_METHOD_NONE, CSCD_METHOD_ICCD, CSCD_METHOD_CHARGE};
    for (int i = 0; i < 3; i++)
        add_entrant(&t, cscd_method_name(methods[i]), methods[i],
                    i == 2 ? CSCD_METHOD_CHARGE : CSCD_METHOD_NONE);
    add_entrant(&t, "published", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED);
    add_entrant(&t, "iccd-published", CSCD_METHOD_ICCD_PUBLISHED, CSCD_METHOD_NONE);
    add_entrant(&t, "published, neighbours", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->ours =
        CSCD_OURS_NEIGHBOURS;
    if (!run_table(&t, known, error)) return false;
    printf(
        "\n%s: pairs of triangles, with and without those that share a vertex\n  %-24s%12s%12s%10s%10s%10s\n",
        known->recording->name, "method", "with", "without", "ms", "lost", "invented");
    for (uint32_t i = 0; i < t.count; i++) {
        const score s = mean_of(&t, i);
        printf("  %-24s%12.0f%12.0f%10.3f%10.0f%10.0f\n", t.entrants[i].name, s.pcp, s.apart, s.ms.total_ms,
               s.losses.lost, s.losses.invented);
    }
    const double ms[] = {mean_of(&t, 1).ms.total_ms / mean_of(&t, 2).ms.total_ms,
                         mean_of(&t, 4).ms.total_ms / mean_of(&t, 3).ms.total_ms};
    printf("  iccd / charge, which lose nothing, %.2f; iccd-published / published %.2f\n", ms[0], ms[1]);
    return true;
}

/* ---- thresholds (section 5.3) ---------------------------------------------------------------------------- */

static bool print_thresholds(const truth *known, io_error *error) {
    static const double thresholds[] = {0.05, 0.1, 0.15, 0.2, 0.3}, counts[] = {1600, 800, 400, 200, 100};
    thesis_table t = {.count = 0};
    for (int i = 0; i < 5; i++) {
        char name[48];
        snprintf(name, sizeof name, "threshold_cluster %.2f", thresholds[i]);
        add_entrant(&t, name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->threshold = thresholds[i];
    }
    for (int i = 0; i < 5; i++) {
        char name[48];
        snprintf(name, sizeof name, "threshold_growing N/%.0f", counts[i]);
        add_entrant(&t, name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->growing = 1.0 / counts[i];
    }
    if (!run_table(&t, known, error)) return false;
    printf("\n%s\n  %-28s%9s%9s%9s\n", known->recording->name, "", "regions", "#PCPs", "ms");
    for (uint32_t i = 0; i < t.count; i++) {
        const score s = mean_of(&t, i);
        printf("  %-28s%9u%9.0f%9.3f\n", t.entrants[i].name, t.results[i].regions, s.apart, s.ms.total_ms);
    }
    return true;
}

/* ---- rules: alone, and one after the other --------------------------------------------------------------- */

typedef struct rule {
    const char *name;
    uint64_t detector, plan; /* the CSCD_OURS_ bit of either */
} rule;

/* In the order in which they are given up. */
static const rule rules[] = {
    {"plain cubic roots", CSCD_OURS_TESTS, 0},
    {"adjacent triangles not tested", CSCD_OURS_NEIGHBOURS, 0},
    {"fixed representatives", CSCD_OURS_REPRESENTATIVES, 0},
    {"the start assumed free", CSCD_OURS_STARTS, 0},
    {"the detector point stays", CSCD_OURS_MOTION, 0},
    {"14-DOPs", CSCD_OURS_BOXES, 0},
    {"a dense system", 0, CSCD_OURS_CHARGE},
    {"256 bins", 0, CSCD_OURS_RANKS},
    {"clusters that grow and shrink", 0, CSCD_OURS_CUTS},
    {"centroids", 0, CSCD_OURS_POINTS},
};
enum { RULES = sizeof rules / sizeof *rules, LOSING_RULES = 5 };

static void print_losses(const truth *known, const thesis_table *t, const char *title) {
    printf("\n%s: %s\n  %-44s%8s%8s%8s%10s%10s%8s%10s\n", known->recording->name, title, "", "regions",
           "#PCPs", "with", "lost", "first", "inv.", "ms");
    for (uint32_t i = 0; i < t->count; i++) {
        const score s = mean_of(t, i);
        printf("  %-44s%8u%8.0f%8.0f%10.0f%10.0f%8.0f%10.3f\n", t->entrants[i].name, t->results[i].regions,
               s.apart, s.pcp, s.losses.lost, s.losses.earliest_lost, s.losses.invented, s.ms.total_ms);
    }
}

static bool print_rules(const truth *known, io_error *error) {
    thesis_table t = {.count = 0};
    add_entrant(&t, "none of them", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->ours = detector_steps;
    for (int i = 0; i < LOSING_RULES; i++)
        add_entrant(&t, rules[i].name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->ours =
            detector_steps & ~rules[i].detector;
    for (int i = 0; i < LOSING_RULES; i++) {
        char name[48];
        snprintf(name, sizeof name, "all but: %s", rules[i].name);
        add_entrant(&t, name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED)->ours = rules[i].detector;
    }
    add_entrant(&t, "all, as published", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED);
    if (!run_table(&t, known, error)) return false;
    print_losses(known, &t, "what each published rule loses, alone, and what is lost without it");
    return true;
}

static bool print_ablation(const truth *known, io_error *error) {
    thesis_table t = {.count = 0};
    entrant *e = add_entrant(&t, "as published", CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED);
    for (int i = 0; i < RULES; i++) {
        char name[48];
        const entrant before = *e;
        snprintf(name, sizeof name, "without: %s", rules[i].name);
        e = add_entrant(&t, name, CSCD_METHOD_PUBLISHED, CSCD_METHOD_PUBLISHED);
        e->ours = before.ours | rules[i].detector;
        e->plan_ours = before.plan_ours | rules[i].plan;
    }
    add_entrant(&t, "charge: blocks, closing passes", CSCD_METHOD_CHARGE, CSCD_METHOD_CHARGE);
    if (!run_table(&t, known, error)) return false;
    print_losses(known, &t, "from published to charge, one step after the other");
    return true;
}

/* ---- the program ----------------------------------------------------------------------------------------- */

static bool run_recording(const char *name, io_error *error) {
    recording_data r;
    truth known;
    char free_name[64];
    if (!recording_data_open("build/models", name, 1, &r, error)) return false;
    bool good = truth_find(&r, &known, error);
    if (good) {
        good = print_experiment(&known, thesis_experiment_of(name), error) && print_pairs(&known, error) &&
               print_thresholds(&known, error) && print_rules(&known, error) && print_ablation(&known, error);
        truth_free(&known);
    }
    recording_data_close(&r);
    snprintf(free_name, sizeof free_name, "%s-free", name);
    if (!good || !recording_data_open("build/models", free_name, 1, &r, error)) return false;
    good = truth_find(&r, &known, error);
    if (good) {
        good = print_pairs(&known, error);
        truth_free(&known);
    }
    recording_data_close(&r);
    return good;
}

int main(int argument_count, char **arguments) {
    io_error error;
    if (argument_count > 1) {
        fprintf(
            stderr,
            "usage: thesis\n\nThe tables of chapters 5 and 6 of the thesis on our recordings, its numbers below ours: %d\n"
            "rounds by turns, of which the quickest of each interval counts, processor time. '%s' is no argument of it.\n",
            ROUNDS, arguments[1]);
        return 2;
    }
    for (int i = 0; i < RECORDINGS; i++) {
        if (run_recording(recordings[i], &error)) continue;
        fprintf(stderr, "thesis: %s\n", error.text);
        return 1;
    }
    return 0;
}
