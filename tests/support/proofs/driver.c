/* The promises, each proven by worlds whose answers are compared. */
#include "tests/support/proofs/proof.h"

#include "src/core/system.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* So many places follow each other, then ever fewer: of refused allocations, of refusing reports, and of all else. */
enum { ALLOCATIONS = PACED(1000, 5), REPORTS = PACED(12, 3), PLACES = PACED(3, 2) };
enum { ASKED_AGAIN = 16 };

typedef enum proof_depth { COMPARE_ANSWERS, COMPARE_COUNTERS } proof_depth;

static proof expected, found; /* large; one row at a time */

static void compare_worlds(proof_depth depth, const char *where, size_t number) {
    for (int i = 0; found.row->calls[i] != NULL; i++) {
        const char *what = NULL;
        if (found.digests[i].answer != expected.digests[i].answer)
            what = "answered something else";
        else if (depth == COMPARE_COUNTERS && found.digests[i].counters != expected.digests[i].counters)
            what = "counted something else";
        if (what != NULL)
            fail_msg("%s %d: %s, %s %zu of call %d", found.row->calls[i]->function, i, what, where, number,
                     found.only);
    }
}

static void live_unharmed(const proof_row *row) {
    expected = proof_world(row, 1, PROOF_UNHARMED, 0);
    proof_live(&expected);
}

/* Lives in worlds that are harmed at one place after the other. Returns how many were. */
static size_t harm_everywhere(const proof_row *row, proof_source source, uint32_t threads, int only,
                              bool skips, proof_depth depth) {
    const size_t dense = skips                                              ? PLACES
                         : source == PROOF_REPORT_REFUSES                   ? REPORTS
                         : source == PROOF_ALLOCATION_FAILS && threads == 1 ? ALLOCATIONS
                                                                            : PLACES;
    size_t harmed = 0;
    for (size_t at = 0;; at += 1 + at / dense) {
        found = proof_world(row, threads, source, at);
        found.only = only;
        found.skips = skips;
        found.unwatched = source == PROOF_ALLOCATION_FAILS && threads > 1;
        if (source == PROOF_TASK_CANCELS) proof_host_loop(&found);
        proof_live(&found);
        if (!atomic_load(&found.struck)) return harmed;
        if (skips) { /* what the harmed call has answered, if it went on all the same, is not compared */
            found.digests[only] = expected.digests[only];
            if (found.failures + found.cancellations == 0) continue;
        }
        compare_worlds(found.failures + found.cancellations > 0 ? depth : COMPARE_ANSWERS, "after place", at);
        harmed += found.failures + found.cancellations;
    }
}

static void expect_reason(const proof_row *row, bool happens, const char *reason, const char *what) {
    if (happens && reason != NULL) fail_msg("%s: %s, although the table says: %s", row->name, what, reason);
    if (!happens && reason == NULL) fail_msg("%s: never %s, and the table gives no reason", row->name, what);
}

/* ---- the promises --------------------------------------------------------------------------------------- */

static void prove_memory(void **state) {
    const proof_row *row = *state;
    live_unharmed(row);
    size_t failures = harm_everywhere(row, PROOF_ALLOCATION_FAILS, 1, -1, false, COMPARE_COUNTERS);
    harm_everywhere(row, PROOF_ALLOCATION_FAILS, 3, -1, false, COMPARE_ANSWERS);
    print_message("  %zu failures\n", failures);
    expect_reason(row, failures > 0, row->no_allocation, "failed for want of memory");
}

static void prove_cancelled(void **state) {
    const proof_row *row = *state;
    live_unharmed(row);
    size_t refused = harm_everywhere(row, PROOF_REPORT_REFUSES, 2, -1, false, COMPARE_COUNTERS), others = 0;
    for (int source = PROOF_REPORT_CANCELS; source < PROOF_SOURCE_COUNT; source++)
        others += harm_everywhere(row, (proof_source)source, 2, -1, false, COMPARE_COUNTERS);
    print_message("  %zu times by a report, %zu times by a callback\n", refused, others);
    expect_reason(row, refused > 0, row->no_report, "cancelled");
}

/* A call that creates an object, or that those behind it need, cannot be left out, and nothing is behind the last one. */
static bool can_skip(const proof_row *row, int call) {
    const proof_kind kind = row->calls[call]->kind;
    return row->calls[call + 1] != NULL && (kind == PROOF_ASKS || kind == PROOF_CHANGES);
}

static void prove_skipped(void **state) {
    static const proof_source sources[] = {PROOF_ALLOCATION_FAILS, PROOF_REPORT_REFUSES,
                                           PROOF_IGNORE_CANCELS};
    const proof_row *row = *state;
    size_t failures = 0;
    for (int call = 0; row->calls[call] != NULL; call++) {
        if (!can_skip(row, call)) continue;
        expected = proof_world(row, 1, PROOF_UNHARMED, 0);
        expected.out = call;
        proof_live(&expected);
        for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
            failures += harm_everywhere(row, sources[i], 1, call, true, COMPARE_ANSWERS);
    }
    print_message("  %zu calls failed\n", failures);
}

/* The last world is that of a host's loop. */
static void prove_threads(void **state) {
    const proof_row *row = *state;
    static const uint32_t counts[] = {1, 2, 7, 7};
    for (int large = 0; large < 2; large++) {
        for (int i = 0; i < 4; i++) {
            found = proof_world(row, counts[i], PROOF_UNHARMED, 0);
            found.large = large == 1;
            if (i == 3) proof_host_loop(&found);
            proof_live(&found);
            if (i == 0) expected = found;
            compare_worlds(COMPARE_COUNTERS, i < 3 ? "threads:" : "tasks of the host:", counts[i]);
        }
    }
    expect_reason(row, found.wide_loops > 0, row->one_thread, "shared work");
}

static void prove_levels(void **state) {
    const proof_row *row = *state;
    for (int large = 0; large < 2; large++) {
        for (int level = CSCD_SIMD_SCALAR; level <= SIMD_LAST; level++) {
            if (!processor_has_simd((cscd_simd)level)) continue;
            found = proof_world(row, 1, PROOF_UNHARMED, 0);
            found.options.simd = (cscd_simd)level;
            found.large = large == 1;
            proof_live(&found);
            if (level == CSCD_SIMD_SCALAR) expected = found;
            compare_worlds(COMPARE_COUNTERS, cscd_name(CSCD_SIMDS, (cscd_simd)level), (size_t)level);
        }
    }
}

static void prove_repeated(void **state) {
    const proof_row *row = *state;
    live_unharmed(row);
    found = proof_world(row, 1, PROOF_UNHARMED, 0);
    proof_live(&found);
    compare_worlds(COMPARE_COUNTERS, "in world", 2);
    if (found.items == 0) fail_msg("%s finds nothing that could be compared", row->name);
    found = proof_world(row, 1, PROOF_UNHARMED, 0);
    found.again = ASKED_AGAIN;
    proof_live(&found);
    compare_worlds(COMPARE_ANSWERS, "asked again in world", 3);
    if (found.allocates != NULL && row->allocates == NULL)
        fail_msg("%s allocates also when nothing changes", found.allocates);
    if (found.allocates == NULL && row->allocates != NULL)
        fail_msg("%s allocates nothing in the end, although the table says: %s", row->name, row->allocates);
}

/* ---- the tests of a table ------------------------------------------------------------------------------- */

typedef struct proof_promise {
    const char *name;
    void (*prove)(void **state);
} proof_promise;

static const proof_promise promises[] = {{"memory", prove_memory},   {"cancelled", prove_cancelled},
                                         {"skipped", prove_skipped}, {"threads", prove_threads},
                                         {"levels", prove_levels},   {"repeated", prove_repeated}};
enum { PROMISES = sizeof promises / sizeof *promises, NAME_MAX_SIZE = 64 };

/* The thread sanitizer has nothing to see in worlds of one thread. */
static bool has_promise(const proof_row *row, const proof_promise *promise) {
#ifdef __SANITIZE_THREAD__
    if (promise->prove != prove_threads) return false;
#endif
    bool any = promise->prove != prove_skipped;
    for (int i = 0; row->calls[i] != NULL; i++) any |= can_skip(row, i);
    return any;
}

int proofs_run(const char *name, const proof_row *rows, size_t row_count) {
    struct CMUnitTest *tests = calloc(row_count * PROMISES, sizeof *tests);
    char(*names)[NAME_MAX_SIZE] = calloc(row_count * PROMISES, sizeof *names);
    size_t count = 0;
    if (tests == NULL || names == NULL) return 1;
    for (size_t r = 0; r < row_count; r++) {
        for (int k = 0; k < PROMISES; k++) {
            if (!has_promise(&rows[r], &promises[k])) continue;
            snprintf(names[count], NAME_MAX_SIZE, "%s_%s", rows[r].name, promises[k].name);
            tests[count] = (struct CMUnitTest){names[count], promises[k].prove, NULL, NULL, (void *)&rows[r]};
            count++;
        }
    }
    int failed = _cmocka_run_group_tests(name, tests, count, NULL, NULL);
    free(tests);
    free(names);
    return failed;
}
