/* Elementary tests on query sets: false positives and negatives, which level decided, time per query. */
#include "benchmarks/lib/pair_batches.h"
#include "runtime/ccd/ccd.h"
#include "src/core/timer.h"
#include "tool/io/io.h"
#include "tool/io/json.h"

#include <errno.h>
#include <gmp.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: queries [--kind vf|ee] [--json] FILES...\n"
    "\n"
    "Runs the elementary tests on query sets with exact truth (CSV, 8 rows a query: x, y, z as numerator and\n"
    "denominator, then the truth). The kind follows from 'vertex-face' or 'edge-edge' in the path, or from "
    "--kind.\n"
    "All queries of a kind go through the feature queue together, in random order and in batches of random sizes,\n"
    "on every instruction set of this processor, and then each one alone: all answers must be the same bits. Times\n"
    "are those of the highest instruction set, of a query alone ('us batch': in batches of 496).\n";

enum { REPEATS = 3, CALLS_PER_REPEAT = 16, TIMED_BATCH = 496 };

/* ---- files of queries ---------------------------------------------------------------------------------- */

typedef struct query_set {
    elementary_query *queries;
    bool *truths; /* does the pair touch? */
    size_t count;
} query_set;

enum { ROWS_PER_QUERY = 8, POINTS_PER_TIME = 4 };

/* Reads the integer at *text and moves past it and one comma. */
static bool read_integer(char **text, mpz_ptr out) {
    size_t length = strcspn(*text, ",\r\n");
    char end = (*text)[length];
    (*text)[length] = '\0';
    bool read = length > 0 && mpz_set_str(out, *text, 10) == 0;
    *text += length + (end == ',');
    if (end != ',') **text = end;
    return read;
}

/* Reads numerator / denominator as a double; false when it is none. mpq_get_d truncates, so converting back shows
 * it. */
static bool read_coordinate(char **text, mpq_t value, mpq_t back, double *out) {
    if (!read_integer(text, mpq_numref(value)) || !read_integer(text, mpq_denref(value))) return false;
    if (mpz_sgn(mpq_denref(value)) == 0) return false;
    mpq_canonicalize(value);
    *out = mpq_get_d(value);
    mpq_set_d(back, *out);
    return mpq_equal(value, back) != 0;
}

static bool read_row(char *line, mpq_t value, mpq_t back, double point[3], bool *truth) {
    char *text = line;
    for (int k = 0; k < 3; k++) {
        if (!read_coordinate(&text, value, back, &point[k])) return false;
    }
    *truth = *text == '1';
    return (*text == '0' || *text == '1') && text[1 + strspn(text + 1, "\r\n")] == '\0';
}

static bool make_query_room(query_set *set, size_t *capacity) {
    if (set->count < *capacity) return true;
    size_t wider = *capacity * 2 + 256;
    elementary_query *queries = realloc(set->queries, wider * sizeof *queries);
    if (queries != NULL) set->queries = queries;
    bool *truths = realloc(set->truths, wider * sizeof *truths);
    if (truths != NULL) set->truths = truths;
    *capacity = wider;
    return queries != NULL && truths != NULL;
}

static bool read_rows(FILE *file, const char *path, query_set *set, io_error *error) {
    mpq_t value, back;
    char *line = NULL;
    size_t size = 0, capacity = 0, row = 0;
    bool read = true;
    mpq_inits(value, back, NULL);
    for (; read && getline(&line, &size, file) >= 0; row++) {
        size_t i = row % ROWS_PER_QUERY;
        bool truth = false;
        if (i == 0 && !make_query_room(set, &capacity)) {
            read = io_fail(error, "%s: out of memory", path);
            break;
        }
        elementary_query *query = &set->queries[set->count];
        double *point = i < POINTS_PER_TIME ? query->x0[i] : query->x1[i - POINTS_PER_TIME];
        if (!read_row(line, value, back, point, &truth) || (i > 0 && truth != set->truths[set->count]))
            read = io_fail(error, "%s:%zu: expected three fractions that are doubles and the query's truth",
                           path, row + 1);
        set->truths[set->count] = truth;
        set->count += i + 1 == ROWS_PER_QUERY;
    }
    if (read && row % ROWS_PER_QUERY != 0)
        read = io_fail(error, "%s:%zu: the last query has %zu rows, expected %d", path, row,
                       row % ROWS_PER_QUERY, ROWS_PER_QUERY);
    mpq_clears(value, back, NULL);
    free(line);
    return read;
}

static void query_set_free(query_set *set) {
    free(set->queries);
    free(set->truths);
    *set = (query_set){NULL, NULL, 0};
}

/* Eight rows a query, seven integers a row: x, y, z as numerator and denominator, then the truth. VF rows are
 * the vertex and the face at t = 0, then at t = 1; EE rows the ends of a and of b. Integers have any size; a
 * value that is no double is an error, as is a truth that differs between rows. On false *out is
 * untouched. */
static bool query_file_read(const char *path, query_set *out, io_error *error) {
    query_set set = {NULL, NULL, 0};
    FILE *file = fopen(path, "r");
    if (file == NULL) return io_fail(error, "%s: cannot open: %s", path, strerror(errno));
    bool read = read_rows(file, path, &set, error);
    fclose(file);
    if (read)
        *out = set;
    else
        query_set_free(&set);
    return read;
}

/* Finds the kind from "vertex-face" or "edge-edge" in the path; false when it holds neither. */
static bool query_kind_from_path(const char *path, cscd_contact_kind *out) {
    if (strstr(path, "vertex-face") != NULL)
        *out = CSCD_CONTACT_VF;
    else if (strstr(path, "edge-edge") != NULL)
        *out = CSCD_CONTACT_EE;
    else
        return false;
    return true;
}

static pair_batches batches; /* large */

/* ---- sets ---------------------------------------------------------------------------------------------- */

/* All queries of one kind, file after file. */
typedef struct query_pool {
    elementary_query *queries;
    query_answer *answers;
    bool *truths;
    size_t count;
} query_pool;

/* The queries begin to begin + count - 1 of a pool. */
typedef struct pool_part {
    const char *path;
    cscd_contact_kind kind;
    size_t begin, count;
} pool_part;

typedef struct all_queries {
    query_pool pools[2]; /* by kind */
    pool_part *parts;
    size_t part_count;
} all_queries;

static bool add_set(query_pool *pool, const query_set *set) {
    size_t count = pool->count + set->count;
    elementary_query *queries = realloc(pool->queries, (count + 1) * sizeof *queries);
    if (queries != NULL) pool->queries = queries;
    query_answer *answers = realloc(pool->answers, (count + 1) * sizeof *answers);
    if (answers != NULL) pool->answers = answers;
    bool *truths = realloc(pool->truths, (count + 1) * sizeof *truths);
    if (truths != NULL) pool->truths = truths;
    if (queries == NULL || answers == NULL || truths == NULL) return false;
    if (set->count > 0) {
        memcpy(pool->queries + pool->count, set->queries, set->count * sizeof *queries);
        memcpy(pool->truths + pool->count, set->truths, set->count * sizeof *truths);
    }
    pool->count = count;
    return true;
}

static bool read_part(const char *path, cscd_contact_kind kind, all_queries *all, io_error *error) {
    query_set set = {NULL, NULL, 0};
    query_pool *pool = &all->pools[kind];
    if (!query_file_read(path, &set, error)) return false;
    pool_part *parts = realloc(all->parts, (all->part_count + 1) * sizeof *parts);
    if (parts != NULL) all->parts = parts;
    bool added = parts != NULL;
    if (added) {
        parts[all->part_count++] = (pool_part){path, kind, pool->count, set.count};
        added = add_set(pool, &set);
    }
    query_set_free(&set);
    return added || io_fail(error, "%s: out of memory", path);
}

static void free_queries(all_queries *all) {
    for (int kind = 0; kind < 2; kind++) {
        free(all->pools[kind].queries);
        free(all->pools[kind].answers);
        free(all->pools[kind].truths);
    }
    free(all->parts);
}

/* ---- answers and times --------------------------------------------------------------------------------- */

typedef struct query_result {
    size_t queries, false_positives, false_negatives;
    size_t levels[ELEMENTARY_LEVEL_COUNT]; /* how many queries each level decided */
    double *microseconds;                  /* per query alone, sorted */
    double mean;
    double sum[2]; /* sums of times: of queries that miss, and of those that hit */
    size_t hits;
    double batch; /* microseconds of all queries in batches */
} query_result;

/* Returns the least time of a few repeats. Short queries are called several times in each, because the clock is
 * coarse. */
static double time_query(int level, cscd_contact_kind kind, size_t i) {
    double least = 1e300;
    int calls = CALLS_PER_REPEAT;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double start = timer_now_ms();
        for (int call = 0; call < calls; call++) pair_batches_run(&batches, level, kind, i, i + 1);
        double microseconds = (timer_now_ms() - start) * 1e3 / calls;
        least = microseconds < least ? microseconds : least;
        if (microseconds > 20.0) calls = 1;
    }
    return least;
}

static double time_batches(int level, const pool_part *part) {
    double least = 1e300;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        double start = timer_now_ms();
        for (size_t i = 0; i < part->count; i += TIMED_BATCH) {
            size_t end = i + TIMED_BATCH < part->count ? i + TIMED_BATCH : part->count;
            pair_batches_run(&batches, level, part->kind, i, end);
        }
        double microseconds = (timer_now_ms() - start) * 1e3;
        least = microseconds < least ? microseconds : least;
    }
    return least;
}

/* Decides query i of those loaded alone; false when the answer is not the one in the batches. */
static bool same_alone(int level, cscd_contact_kind kind, size_t i, const query_answer *answer,
                       query_result *out) {
    pair_batches_run(&batches, level, kind, i, i + 1);
    const contact_worker *worker = batches.workers[level];
    for (int k = 0; k < ELEMENTARY_LEVEL_COUNT; k++) out->levels[k] += worker->decided[k];
    if (worker->count != (answer->touching ? 1 : 0)) return false;
    return !answer->touching ||
           (contact_worker_at(worker, 0)->toi == answer->hit.toi &&
            memcmp(contact_worker_at(worker, 0)->point, answer->hit.point, sizeof answer->hit.point) == 0 &&
            memcmp(contact_worker_at(worker, 0)->normal, answer->hit.normal, sizeof answer->hit.normal) == 0);
}

/* out->microseconds has room for all queries of the part. */
static bool run_part(const query_pool *pool, const pool_part *part, query_result *out, io_error *error) {
    int level = pair_batches_best_level(&batches);
    if (!pair_batches_load(&batches, part->kind, pool->queries + part->begin, part->count))
        return io_fail(error, "%s: out of memory", part->path);
    for (size_t i = 0; i < part->count; i++) {
        const query_answer *answer = &pool->answers[part->begin + i];
        bool truth = pool->truths[part->begin + i];
        if (!same_alone(level, part->kind, i, answer, out))
            return io_fail(error, "%s: query %zu has one answer alone and another one in a batch", part->path,
                           i + 1);
        out->false_positives += answer->touching && !truth;
        out->false_negatives += !answer->touching && truth;
        double microseconds = time_query(level, part->kind, i);
        out->microseconds[out->queries++] = microseconds;
        out->sum[answer->touching] += microseconds;
        out->hits += answer->touching;
    }
    out->batch = time_batches(level, part);
    return true;
}

static int compare_times(const void *left, const void *right) {
    double l = *(const double *)left, r = *(const double *)right;
    return l < r ? -1 : l > r;
}

static void finish_times(query_result *r) {
    for (size_t i = 0; i < r->queries; i++) r->mean += r->microseconds[i] / (double)r->queries;
    if (r->queries > 0) qsort(r->microseconds, r->queries, sizeof *r->microseconds, compare_times);
}

static double time_quantile(const query_result *r, double fraction) {
    if (r->queries == 0) return 0.0;
    size_t i = (size_t)(fraction * (double)r->queries);
    return r->microseconds[i < r->queries ? i : r->queries - 1];
}

static double batch_mean(const query_result *r) {
    return r->queries > 0 ? r->batch / (double)r->queries : 0.0;
}

/* Adds counts and times of part to total. */
static bool add_result(query_result *total, const query_result *part) {
    double *times = realloc(total->microseconds, (total->queries + part->queries + 1) * sizeof *times);
    if (times == NULL) return false;
    if (part->queries > 0) memcpy(times + total->queries, part->microseconds, part->queries * sizeof *times);
    total->microseconds = times;
    total->queries += part->queries;
    total->false_positives += part->false_positives;
    total->false_negatives += part->false_negatives;
    total->hits += part->hits;
    total->batch += part->batch;
    for (int i = 0; i < 2; i++) total->sum[i] += part->sum[i];
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) total->levels[i] += part->levels[i];
    return true;
}

/* ---- the table ----------------------------------------------------------------------------------------- */

static void write_json(json *out, const query_result *r) {
    json_integer(out, "queries", r->queries);
    json_integer(out, "fp", r->false_positives);
    json_integer(out, "fn", r->false_negatives);
    json_begin_array(out, "levels");
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) json_integer(out, NULL, r->levels[i]);
    json_end_array(out);
    json_number(out, "us_mean", r->mean);
    json_number(out, "us_p99", time_quantile(r, 0.99));
    json_number(out, "us_max", time_quantile(r, 1.0));
    json_number(out, "us_batch", batch_mean(r));
    json_end_object(out);
}

static void print_mean(double sum, size_t count) {
    if (count > 0)
        printf(" %8.3f", sum / (double)count);
    else
        printf(" %8s", "-");
}

static void print_row(const char *name, const query_result *r) {
    printf("%-44s %8zu %4zu %4zu %7zu %7zu %7zu %8.3f %8.3f %8.3f", name, r->queries, r->false_positives,
           r->false_negatives, r->levels[0], r->levels[1], r->levels[2], r->mean, time_quantile(r, 0.99),
           time_quantile(r, 1.0));
    print_mean(r->sum[1], r->hits);
    print_mean(r->sum[0], r->queries - r->hits);
    print_mean(r->batch, r->queries);
    putchar('\n');
}

static void report_part(const pool_part *part, const query_result *r, json *out) {
    if (out->file == NULL) {
        const char *slash = strrchr(part->path, '/');
        print_row(slash != NULL ? slash + 1 : part->path, r);
        return;
    }
    json_break_line(out);
    json_begin_object(out, NULL);
    json_string(out, "file", part->path);
    json_string(out, "kind", part->kind == CSCD_CONTACT_VF ? "vf" : "ee");
    write_json(out, r);
}

static bool report_parts(const all_queries *all, json *out, query_result *total, io_error *error) {
    for (size_t i = 0; i < all->part_count; i++) {
        const pool_part *part = &all->parts[i];
        query_result r = {.microseconds = malloc((part->count + 1) * sizeof(double))};
        if (r.microseconds == NULL) return io_fail(error, "out of memory");
        bool ran = run_part(&all->pools[part->kind], part, &r, error);
        finish_times(&r);
        if (ran) report_part(part, &r, out);
        if (ran && !add_result(total, &r)) ran = io_fail(error, "out of memory");
        free(r.microseconds);
        if (!ran) return false;
    }
    return true;
}

/* ---- the program --------------------------------------------------------------------------------------- */

typedef struct query_options {
    bool as_json, kind_given;
    cscd_contact_kind kind;
    int first_file;
} query_options;

static bool parse_options(int argument_count, char **arguments, query_options *o) {
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

static bool read_files(const query_options *o, int argument_count, char **arguments, all_queries *all,
                       io_error *error) {
    for (int i = o->first_file; i < argument_count; i++) {
        cscd_contact_kind kind = o->kind;
        if (!o->kind_given && !query_kind_from_path(arguments[i], &kind))
            return io_fail(error, "%s: neither vertex-face nor edge-edge in the name; give --kind",
                           arguments[i]);
        if (!read_part(arguments[i], kind, all, error)) return false;
    }
    return true;
}

static bool decide_in_batches(all_queries *all, io_error *error) {
    for (int kind = 0; kind < 2; kind++) {
        query_pool *pool = &all->pools[kind];
        const char *problem;
        if (!pair_batches_decide_queries(&batches, (cscd_contact_kind)kind, pool->queries, pool->count,
                                         pool->answers, &problem))
            return io_fail(error, "%s: %s", kind == CSCD_CONTACT_VF ? "vertex-face" : "edge-edge", problem);
    }
    return true;
}

static void begin_output(json *out) {
    if (out->file != NULL) {
        json_begin_object(out, NULL);
        json_begin_array(out, "files");
        return;
    }
    printf("%-44s %8s %4s %4s %7s %7s %7s %8s %8s %8s %8s %8s %8s\n", "set", "queries", "fp", "fn", "signs",
           "roots", "exact", "us mean", "us p99", "us max", "us hit", "us miss", "us batch");
}

static void end_output(json *out, const query_result *total) {
    if (out->file == NULL) {
        print_row("total", total);
        return;
    }
    json_end_array(out);
    json_begin_object(out, "total");
    write_json(out, total);
    json_end_object(out);
    putchar('\n');
}

int main(int argument_count, char **arguments) {
    query_options o = {.kind = CSCD_CONTACT_VF};
    io_error error = {""};
    query_result total = {0};
    all_queries all = {.part_count = 0};
    if (!parse_options(argument_count, arguments, &o)) {
        fputs(help, stderr);
        return 2;
    }
    json out = {.file = o.as_json ? stdout : NULL};
    bool ran = pair_batches_open(&batches) || io_fail(&error, "out of memory");
    ran = ran && read_files(&o, argument_count, arguments, &all, &error) && decide_in_batches(&all, &error);
    begin_output(&out);
    ran = ran && report_parts(&all, &out, &total, &error);
    finish_times(&total);
    end_output(&out, &total);
    free(total.microseconds);
    free_queries(&all);
    pair_batches_close(&batches);
    if (!ran) fprintf(stderr, "queries: %s\n", error.text);
    return ran ? 0 : 1;
}
