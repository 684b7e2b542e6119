/* The dense solution by panels: matrices of one to three panels whose solutions are known, zero pivots, and cancelling. */
#include "preprocess/baselines/dense/dense.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PANEL = 256 };

/* A host that runs tasks one after the other, and cancels at a report. */
typedef struct plain_host {
    bool backwards;
    uint32_t rounds, reports, cancels_at; /* counted from 1; 0: never */
} plain_host;

static void run_tasks(void *context, uint32_t count, void (*task)(void *data, uint32_t task), void *data) {
    plain_host *h = context;
    h->rounds++;
    for (uint32_t i = 0; i < count; i++) task(data, h->backwards ? count - 1 - i : i);
}

static bool go_on(void *context, double share) {
    (void)context;
    assert_true(share >= 0.0 && share <= 1.0);
    return true;
}

static cscd_status report_share(void *context) {
    plain_host *h = context;
    return ++h->reports == h->cancels_at ? CSCD_CANCELLED : CSCD_OK;
}

static dense_host host_of(plain_host *h) {
    return (dense_host){
        .context = h, .run = run_tasks, .go_on = go_on, .progress = report_share, .threads = 2};
}

/* Column after column. */
typedef struct equations {
    uint32_t count;
    double *matrix, *solution;
    int32_t *pivots;
} equations;

static equations equations_of(uint32_t count) {
    equations e = {count, calloc((size_t)count * count, sizeof *e.matrix), calloc(count, sizeof *e.solution),
                   calloc(count, sizeof *e.pivots)};
    assert_true(e.matrix != NULL && e.solution != NULL && e.pivots != NULL);
    return e;
}

static void equations_free(equations *e) {
    free(e->matrix);
    free(e->solution);
    free(e->pivots);
}

/* Random numbers, so that rows are swapped from end to end; the right side is for charges of 1 and -1 in turn. */
static equations random_equations(uint32_t count) {
    equations e = equations_of(count);
    random_stream random = stream_start(count);
    for (uint32_t k = 0; k < count; k++) {
        for (uint32_t i = 0; i < count; i++) {
            e.matrix[(size_t)k * count + i] = stream_between(&random, -1.0, 1.0);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        double sum = 0.0;
        for (uint32_t k = 0; k < count; k++)
            sum += (k % 2 == 0 ? 1.0 : -1.0) * e.matrix[(size_t)k * count + i];
        e.solution[i] = sum;
    }
    return e;
}

TEST(known_solutions_are_found) {
    static const uint32_t counts[] = {1, 2, PANEL - 1, PANEL, PANEL + 1, 2 * PANEL, 2 * PANEL + 88};
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        equations e = random_equations(counts[n]);
        plain_host h = {.backwards = false};
        const dense_host host = host_of(&h);
        expect_ok(dense_factor(&host, e.matrix, e.count, e.pivots));
        dense_substitute(e.matrix, e.count, e.pivots, e.solution);
        for (uint32_t i = 0; i < e.count; i++)
            assert_true(fabs(e.solution[i] - (i % 2 == 0 ? 1.0 : -1.0)) < 1e-9);
        equations_free(&e);
    }
}

TEST(who_runs_the_tasks_changes_no_bit) {
    const uint32_t count = 2 * PANEL + 88;
    equations e[2] = {random_equations(count), random_equations(count)};
    for (int i = 0; i < 2; i++) {
        plain_host h = {.backwards = i == 1};
        const dense_host host = host_of(&h);
        expect_ok(dense_factor(&host, e[i].matrix, count, e[i].pivots));
    }
    assert_memory_equal(e[0].matrix, e[1].matrix, (size_t)count * count * sizeof *e[0].matrix);
    assert_memory_equal(e[0].pivots, e[1].pivots, count * sizeof *e[0].pivots);
    for (int i = 0; i < 2; i++) equations_free(&e[i]);
}

/* In the identity without one of its columns the pivot of that one is 0, whichever panel it is in. */
TEST(a_pivot_of_nothing_is_zero) {
    const uint32_t count = 2 * PANEL + 88, missing[] = {0, PANEL - 1, PANEL, 2 * PANEL + 1, count - 1};
    for (size_t n = 0; n < sizeof missing / sizeof *missing; n++) {
        equations e = equations_of(count);
        for (uint32_t i = 0; i < count; i++) e.matrix[(size_t)i * count + i] = i != missing[n];
        plain_host h = {.backwards = false};
        const dense_host host = host_of(&h);
        expect_ok(dense_factor(&host, e.matrix, count, e.pivots));
        for (uint32_t i = 0; i < count; i++)
            assert_true(e.matrix[(size_t)i * count + i] == (i != missing[n] ? 1.0 : 0.0));
        equations_free(&e);
    }
}

TEST(cancelled_after_each_panel) {
    for (uint32_t at = 1; at <= 2; at++) {
        equations e = random_equations(2 * PANEL + 88);
        plain_host h = {.cancels_at = at};
        const dense_host host = host_of(&h);
        assert_int_equal(dense_factor(&host, e.matrix, e.count, e.pivots), CSCD_CANCELLED);
        assert_true(h.reports == at && h.rounds == at); /* and no more */
        equations_free(&e);
    }
}
