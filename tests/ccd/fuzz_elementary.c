/* Elementary tests against the algebraic oracle on random degenerate queries, for as long as asked; prints
 * the queries on which they differ. Usage: fuzz_elementary SECONDS QUERIES SEED vf|ee|both; 0 is no limit. */
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/ccd/oracle_comparison.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { DIFFERENCES_SHOWN = 20, BATCH = 1024 };

typedef struct tally {
    uint64_t queries, hits, levels[ELEMENTARY_LEVEL_COUNT], results[COMPARISON_COUNT];
    double seconds, slowest; /* of test and oracle */
} tally;

typedef struct fuzzing {
    random_stream random;
    tally families[2][FAMILY_COUNT];
    uint64_t queries, differences;
    double started;
} fuzzing;

static double seconds_now(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void ask(fuzzing *f, cscd_contact_kind kind, query_family family) {
    tally *t = &f->families[kind][family];
    elementary_query query = generate_query(&f->random, kind, family);
    double start = seconds_now(CLOCK_THREAD_CPUTIME_ID);
    compared result = compare_with_oracle(kind, &query);
    double taken = seconds_now(CLOCK_THREAD_CPUTIME_ID) - start;
    f->queries++;
    t->queries++;
    t->hits += result.oracle.touching;
    t->levels[result.verdict.level]++;
    t->seconds += taken;
    if (taken > t->slowest) t->slowest = taken;
    t->results[result.result]++;
    if (result.result == COMPARISON_AGREES) return;
    if (f->differences++ >= DIFFERENCES_SHOWN) return;
    printf("\n/* %s, query %llu */ ", query_family_name(family), (unsigned long long)f->queries);
    print_compared(kind, &query, &result);
    fflush(stdout);
}

static void print_numbers(const uint64_t *numbers, int count) {
    for (int i = 0; i < count; i++) printf(" %9llu", (unsigned long long)numbers[i]);
}

static void print_totals(const fuzzing *f, cscd_contact_kind kind) {
    printf("%s %-14s %9s %9s %9s %9s %9s %9s %9s %9s %9s %7s %7s\n", kind == CSCD_CONTACT_VF ? "vf" : "ee",
           "family", "queries", "hits", "signs", "roots", "exact", "missed", "false", "late", "early",
           "us mean", "us max");
    for (int i = 0; i < FAMILY_COUNT; i++) {
        const tally *t = &f->families[kind][i];
        printf("   %-14s", query_family_name((query_family)i));
        print_numbers(&t->queries, 1);
        print_numbers(&t->hits, 1);
        print_numbers(t->levels, ELEMENTARY_LEVEL_COUNT);
        print_numbers(t->results + 1, COMPARISON_COUNT - 1);
        printf(" %7.1f %7.0f\n", 1e6 * t->seconds / (double)(t->queries > 0 ? t->queries : 1),
               1e6 * t->slowest);
    }
}

int main(int argument_count, char **arguments) {
    if (argument_count != 5) {
        fprintf(stderr, "usage: %s SECONDS QUERIES SEED vf|ee|both\n", arguments[0]);
        return 2;
    }
    double limit = strtod(arguments[1], NULL);
    uint64_t query_limit = strtoull(arguments[2], NULL, 0), seed = strtoull(arguments[3], NULL, 0);
    bool asked[2] = {strcmp(arguments[4], "ee") != 0, strcmp(arguments[4], "vf") != 0};
    fuzzing f = {.random = stream_start(seed), .started = seconds_now(CLOCK_MONOTONIC)};
    while (query_limit == 0 || f.queries < query_limit) {
        double elapsed = seconds_now(CLOCK_MONOTONIC) - f.started;
        if (limit > 0.0 && elapsed >= limit) break;
        if (isatty(STDERR_FILENO))
            fprintf(stderr, "\r%llu queries, %.0f s, %llu differences ", (unsigned long long)f.queries,
                    elapsed, (unsigned long long)f.differences);
        for (int i = 0; i < BATCH; i++)
            for (int kind = 0; kind < 2; kind++)
                if (asked[kind])
                    ask(&f, (cscd_contact_kind)kind, (query_family)stream_below(&f.random, FAMILY_COUNT));
    }
    if (isatty(STDERR_FILENO)) fprintf(stderr, "\n");
    for (int kind = 0; kind < 2; kind++)
        if (asked[kind]) print_totals(&f, (cscd_contact_kind)kind);
    printf("%llu queries, seed %llu, %llu differences\n", (unsigned long long)f.queries,
           (unsigned long long)seed, (unsigned long long)f.differences);
    algebraic_oracle_finish();
    return f.differences > 0 ? 1 : 0;
}
