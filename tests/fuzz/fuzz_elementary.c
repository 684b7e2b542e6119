/* Elementary tests, through the feature queue and on every instruction set of the processor, against the algebraic
 * oracle on random degenerate queries, for as long as asked; prints the queries on which they differ.
 * Usage: fuzz_elementary SECONDS QUERIES SEED vf|ee|both; 0 is no limit. */
#include "tests/support/ccd/algebraic_oracle.h"
#include "tests/support/ccd/elementary_generator.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { DIFFERENCES_SHOWN = 20, BATCH = 1024 };

typedef struct family_tally {
    uint64_t queries, hits, results[COMPARISON_COUNT];
} family_tally;

typedef struct fuzzing {
    random_stream random;
    family_tally families[2][FAMILY_COUNT];
    uint64_t levels[2][ELEMENTARY_LEVEL_COUNT];
    uint64_t queries, differences;
    double started;
} fuzzing;

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void note_result(fuzzing *f, cscd_contact_kind kind, query_family family,
                        const elementary_query *query, const compared *result) {
    family_tally *t = &f->families[kind][family];
    f->queries++;
    t->queries++;
    t->hits += result->oracle.touching;
    t->results[result->result]++;
    if (result->result == COMPARISON_AGREES) return;
    if (f->differences++ >= DIFFERENCES_SHOWN) return;
    printf("\n/* %s, query %llu */ ", query_family_name(family), (unsigned long long)f->queries);
    print_compared(kind, query, result);
    fflush(stdout);
}

/* All families in one batch after the other, in random order: hits, misses and degenerate queries side by side. */
static void ask_queries(fuzzing *f, cscd_contact_kind kind) {
    static elementary_query queries[BATCH];
    static query_family families[BATCH];
    static compared results[BATCH];
    for (int i = 0; i < BATCH; i++) {
        families[i] = (query_family)stream_below(&f->random, FAMILY_COUNT);
        queries[i] = generate_query(&f->random, kind, families[i]);
    }
    compare_all_with_oracle(kind, queries, BATCH, results);
    for (int i = 0; i < ELEMENTARY_LEVEL_COUNT; i++) f->levels[kind][i] += pair_test_decided()[i];
    for (int i = 0; i < BATCH; i++) note_result(f, kind, families[i], &queries[i], &results[i]);
}

static void print_numbers(const uint64_t *numbers, int count) {
    for (int i = 0; i < count; i++) printf(" %9llu", (unsigned long long)numbers[i]);
}

static void print_totals(const fuzzing *f, cscd_contact_kind kind) {
    const uint64_t *levels = f->levels[kind];
    printf("%s %-14s %9s %9s %9s %9s %9s %9s\n", cscd_contact_kind_name(kind), "family", "queries", "hits",
           "missed", "false", "late", "early");
    for (int i = 0; i < FAMILY_COUNT; i++) {
        const family_tally *t = &f->families[kind][i];
        printf("   %-14s", query_family_name((query_family)i));
        print_numbers(&t->queries, 1);
        print_numbers(&t->hits, 1);
        print_numbers(t->results + 1, COMPARISON_COUNT - 1);
        printf("\n");
    }
    printf("   decided by signs %llu, at roots %llu, exactly %llu\n",
           (unsigned long long)levels[ELEMENTARY_SIGNS], (unsigned long long)levels[ELEMENTARY_ROOTS],
           (unsigned long long)levels[ELEMENTARY_EXACT]);
}

int main(int argument_count, char **arguments) {
    if (argument_count != 5) {
        fprintf(stderr, "usage: %s SECONDS QUERIES SEED vf|ee|both\n", arguments[0]);
        return 2;
    }
    double limit = strtod(arguments[1], NULL);
    uint64_t query_limit = strtoull(arguments[2], NULL, 0), seed = strtoull(arguments[3], NULL, 0);
    bool asked[2] = {strcmp(arguments[4], "ee") != 0, strcmp(arguments[4], "vf") != 0};
    fuzzing f = {.random = stream_start(seed), .started = seconds_now()};
    while (query_limit == 0 || f.queries < query_limit) {
        double elapsed = seconds_now() - f.started;
        if (limit > 0.0 && elapsed >= limit) break;
        if (isatty(STDERR_FILENO))
            fprintf(stderr, "\r%llu queries, %.0f s, %llu differences ", (unsigned long long)f.queries,
                    elapsed, (unsigned long long)f.differences);
        for (int kind = 0; kind < 2; kind++)
            if (asked[kind]) ask_queries(&f, (cscd_contact_kind)kind);
    }
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\n");
    for (int kind = 0; kind < 2; kind++)
        if (asked[kind]) print_totals(&f, (cscd_contact_kind)kind);
    printf("%llu queries, seed %llu, %llu differences\n", (unsigned long long)f.queries,
           (unsigned long long)seed, (unsigned long long)f.differences);
    algebraic_oracle_finish();
    return f.differences > 0 ? 1 : 0;
}
