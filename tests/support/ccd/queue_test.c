/* The elementary tests as a step runs them: through the feature queue, on every instruction set of the processor. */
#include "tests/support/ccd/queue_test.h"

#include <stdio.h>
#include <stdlib.h>

/* Large; opened by the first test, closed when the program ends. */
static pair_batches batches, best_batches;

static void close_batches(void) {
    pair_batches_close(&batches);
    pair_batches_close(&best_batches);
}

static void stop_test(const char *problem) {
    fprintf(stderr, "queue test: %s\n", problem);
    abort();
}

static pair_batches *open_batches(void) {
    if (batches.contexts[0] != NULL) return &batches;
    if (!pair_batches_open(&batches)) stop_test("memory ran out");
    atexit(close_batches);
    return &batches;
}

/* What decides the pairs of whole scenes. Under sanitizers one instruction set does: all pairs of a scene on three of
 * them took most of the time of such tests. That they agree on these scenes is seen in the other configurations, and on
 * single queries in all. */
static pair_batches *open_scene_batches(void) {
#ifdef SLOW_MACHINE
    if (best_batches.contexts[0] != NULL) return &best_batches;
    if (!pair_batches_open_best(&best_batches)) stop_test("memory ran out");
    atexit(close_batches);
    return &best_batches;
#else
    return open_batches();
#endif
}

static void print_query(const elementary_query *query) {
    for (int i = 0; i < 8; i++) {
        const double *x = i < 4 ? query->x0[i] : query->x1[i - 4];
        fprintf(stderr, "  %a, %a, %a\n", x[0], x[1], x[2]);
    }
}

/* Prints the queries that instruction sets differ on even alone. */
static void print_different(cscd_contact_kind kind, const elementary_query *queries, size_t count) {
    for (size_t i = 0; i < count; i++) {
        query_answer answer;
        const char *problem;
        if (pair_batches_decide_queries(&batches, kind, &queries[i], 1, &answer, &problem)) continue;
        fprintf(stderr, "query %zu: %s\n", i, problem);
        print_query(&queries[i]);
    }
}

void pair_test_all(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                   query_answer *answers) {
    const char *problem;
    if (pair_batches_decide_queries(open_batches(), kind, queries, count, answers, &problem)) return;
    print_different(kind, queries, count);
    stop_test(problem);
}

elementary_verdict pair_test(cscd_contact_kind kind, const elementary_query *query, elementary_contact *hit) {
    query_answer answer;
    pair_test_all(kind, query, 1, &answer);
    int level = 0;
    while (pair_test_decided()[level] == 0) level++;
    if (answer.touching) *hit = answer.hit;
    return (elementary_verdict){answer.touching, (elementary_level)level};
}

const uint64_t *pair_test_decided(void) {
    return pair_batches_decided(&batches);
}

const cscd_contact *pair_test_source(const feature_source *source, cscd_contact_kind kind,
                                     const uint32_t (*pairs)[2], size_t count, size_t *contact_count) {
    const char *problem;
    const cscd_contact *contacts =
        pair_batches_decide(open_scene_batches(), source, kind, pairs, count, contact_count, &problem);
    if (contacts == NULL) stop_test(problem);
    return contacts;
}
