/* Elementary tests on query sets: false positives and negatives, which level decided, time per query. */
#include "benchmarks/lib/query_file.h"
#include "src/core/timer.h"
#include "src/io/json.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] = "usage: queries [--kind vf|ee] [--json] FILES...\n"
                           "\n"
                           "Runs the elementary tests on query sets with exact truth (CSV, 8 rows a query: "
                           "x, y, z as numerator and\n"
                           "denominator, then the truth). The kind follows from 'vertex-face' or 'edge-edge' "
                           "in the path, or from --kind.\n";

enum { REPEATS = 3, CALLS_PER_REPEAT = 16 };

typedef struct result {
    size_t queries, false_positives, false_negatives;
    size_t levels[ELEMENTARY_LEVEL_COUNT]; /* how many queries each level decided */
    double *microseconds;                  /* per query, sorted */
    double mean;
    double sum[2]; /* of the times, of queries that miss and of those that hit */
    size_t hits;
} result;

static elementary_verdict decide(const elementary_query *query, cscd_contact_kind kind) {
    elementary_hit hit;
    return kind == CSCD_CONTACT_VF ? elementary_vf(query, &hit) : elementary_ee(query, &hit);
}

/* The least of a few repeats; short queries are called several times in each, for the clock's sake. */
static double time_query(const elementary_query *query, cscd_contact_kind kind) {
    double least = 1e300;
    int calls = CALLS_PER_REPEAT;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double start = timer_now_ms();
        for (int i = 0; i < calls; i++) decide(query, kind);
        double microseconds = (timer_now_ms() - start) * 1e3 / calls;
        least = microseconds < least ? microseconds : least;
        if (microseconds > 20.0) calls = 1;
    }
    return least;
}

static int compare_times(const void *left, const void *right) {
    double l = *(const double *)left, r = *(const double *)right;
    return l < r ? -1 : l > r;
}

static void finish(result *r) {
    for (size_t i = 0; i < r->queries; i++) r->mean += r->microseconds[i] / (double)r->queries;
    if (r->queries > 0) qsort(r->microseconds, r->queries, sizeof *r->microseconds, compare_times);
}

static double quantile(const result *r, double fraction) {
    if (r->queries == 0) return 0.0;
    size_t i = (size_t)(fraction * (double)r->queries);
    return r->microseconds[i < r->queries ? i : r->queries - 1];
}

/* microseconds has room for all queries of the set. */
static void run_set(const query_set *set, cscd_contact_kind kind, result *out) {
    for (size_t i = 0; i < set->count; i++) {
        elementary_verdict verdict = decide(&set->queries[i], kind);
        out->false_positives += verdict.touching && !set->truths[i];
        out->false_negatives += !verdict.touching && set->truths[i];
        out->levels[verdict.level]++;
        double microseconds = time_query(&set->queries[i], kind);
        out->microseconds[out->queries++] = microseconds;
        out->sum[verdict.touching] += microseconds;
        out->hits += verdict.touching;
    }
}

static void write_json(json *out, const result *r) {
    json_integer(out, "queries", r->queries);
    json_integer(out, "fp", r->false_positives);
    json_integer(out, "fn", r->false_negatives);
    json_begin_array(out, "levels");
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) json_integer(out, NULL, r->levels[i]);
    json_end_array(out);
    json_number(out, "us_mean", r->mean);
    json_number(out, "us_p99", quantile(r, 0.99));
    json_number(out, "us_max", quantile(r, 1.0));
    json_end_object(out);
}

static void print_mean(double sum, size_t count) {
    if (count > 0)
        printf(" %8.3f", sum / (double)count);
    else
        printf(" %8s", "-");
}

static void print_row(const char *name, const result *r) {
    printf("%-44s %8zu %4zu %4zu %7zu %7zu %7zu %8.3f %8.3f %8.3f", name, r->queries, r->false_positives,
           r->false_negatives, r->levels[0], r->levels[1], r->levels[2], r->mean, quantile(r, 0.99),
           quantile(r, 1.0));
    print_mean(r->sum[1], r->hits);
    print_mean(r->sum[0], r->queries - r->hits);
    putchar('\n');
}

/* Adds counts and times of part to total. */
static bool add_result(result *total, const result *part) {
    double *times = realloc(total->microseconds, (total->queries + part->queries + 1) * sizeof *times);
    if (times == NULL) return false;
    if (part->queries > 0) memcpy(times + total->queries, part->microseconds, part->queries * sizeof *times);
    total->microseconds = times;
    total->queries += part->queries;
    total->false_positives += part->false_positives;
    total->false_negatives += part->false_negatives;
    total->hits += part->hits;
    for (int i = 0; i < 2; i++) total->sum[i] += part->sum[i];
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) total->levels[i] += part->levels[i];
    return true;
}

static bool run_file(const char *path, cscd_contact_kind kind, json *out, result *total, io_error *error) {
    query_set set;
    if (!query_file_read(path, &set, error)) return false;
    result r = {.microseconds = malloc((set.count + 1) * sizeof(double))};
    bool ran = r.microseconds != NULL;
    if (ran) {
        run_set(&set, kind, &r);
        finish(&r);
        ran = add_result(total, &r);
        const char *slash = strrchr(path, '/');
        if (out->file != NULL) {
            json_break_line(out);
            json_begin_object(out, NULL);
            json_string(out, "file", path);
            json_string(out, "kind", kind == CSCD_CONTACT_VF ? "vf" : "ee");
            write_json(out, &r);
        } else {
            print_row(slash != NULL ? slash + 1 : path, &r);
        }
    }
    free(r.microseconds);
    query_set_free(&set);
    return ran || io_fail(error, "%s: out of memory", path);
}

typedef struct options {
    bool as_json, kind_given;
    cscd_contact_kind kind;
    int first_file;
} options;

static bool parse(int argument_count, char **arguments, options *o) {
    int i = 1;
    for (; i < argument_count && strncmp(arguments[i], "--", 2) == 0; i++) {
        if (strcmp(arguments[i], "--json") == 0) {
            o->as_json = true;
        } else if (strcmp(arguments[i], "--kind") == 0 && i + 1 < argument_count) {
            const char *kind = arguments[++i];
            o->kind_given = true;
            o->kind = strcmp(kind, "vf") == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
            if (o->kind == CSCD_CONTACT_EE && strcmp(kind, "ee") != 0) return false;
        } else {
            return false;
        }
    }
    o->first_file = i;
    return i < argument_count;
}

static bool run_files(const options *o, int argument_count, char **arguments, json *out, result *total,
                      io_error *error) {
    for (int i = o->first_file; i < argument_count; i++) {
        cscd_contact_kind kind = o->kind;
        if (!o->kind_given && !query_kind_from_path(arguments[i], &kind))
            return io_fail(error, "%s: neither vertex-face nor edge-edge in the name; give --kind",
                           arguments[i]);
        if (!run_file(arguments[i], kind, out, total, error)) return false;
    }
    return true;
}

int main(int argument_count, char **arguments) {
    options o = {.kind = CSCD_CONTACT_VF};
    io_error error = {""};
    result total = {0};
    if (!parse(argument_count, arguments, &o)) {
        fputs(help, stderr);
        return 2;
    }
    json out = {.file = o.as_json ? stdout : NULL};
    if (o.as_json) {
        json_begin_object(&out, NULL);
        json_begin_array(&out, "files");
    } else {
        printf("%-44s %8s %4s %4s %7s %7s %7s %8s %8s %8s %8s %8s\n", "set", "queries", "fp", "fn", "signs",
               "roots", "exact", "us mean", "us p99", "us max", "us hit", "us miss");
    }
    bool ran = run_files(&o, argument_count, arguments, &out, &total, &error);
    finish(&total);
    if (o.as_json) {
        json_end_array(&out);
        json_begin_object(&out, "total");
        write_json(&out, &total);
        json_end_object(&out);
        putchar('\n');
    } else {
        print_row("total", &total);
    }
    free(total.microseconds);
    if (!ran) fprintf(stderr, "queries: %s\n", error.text);
    return ran ? 0 : 1;
}
