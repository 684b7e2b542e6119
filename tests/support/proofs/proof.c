/* The promises of calls, each proven by worlds whose answers are compared; and the worlds in which the calls of a row are made. */
#include "tests/support/proofs/proof.h"

#include "src/core/context.h"
#include "src/core/system.h"
#include "src/mesh/mesh.h"
#include "tests/support/culling/clean_triangles.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNTOUCHED = 0xa5 };

static const char *const source_names[PROOF_SOURCE_COUNT] = {"nothing",
                                                             "a refused allocation",
                                                             "a refusing report",
                                                             "a cancelling report",
                                                             "a cancelling allocation",
                                                             "a cancelling task",
                                                             "a cancelling ignore"};

/* ---- callbacks ------------------------------------------------------------------------------------------ */

/* Is this the call of a callback that the world has been waiting for? */
static bool strikes_here(proof *p, proof_source source) {
    if (!p->armed || source != p->source) return false;
    if (atomic_fetch_add(&p->seen, 1) != p->at) return false;
    atomic_store(&p->struck, true);
    return true;
}

static void *allocate_block(void *user, size_t size, size_t alignment) {
    proof *p = user;
    cscd_allocator system = counting_allocator_interface(&p->counter);
    if (strikes_here(p, PROOF_ALLOCATION_FAILS)) return NULL;
    if (strikes_here(p, PROOF_ALLOCATION_CANCELS)) cscd_context_cancel(p->context);
    return system.allocate(system.user, size, alignment);
}

static void release_block(void *user, void *block, size_t size) {
    cscd_allocator system = counting_allocator_interface(&((proof *)user)->counter);
    system.release(system.user, block, size);
}

static bool report_progress(void *user, const char *stage, double fraction) {
    proof *p = user;
    assert_true(pthread_equal(p->thread, pthread_self()));
    assert_true(stage != NULL && stage[0] != '\0');
    assert_true(fraction >= p->fraction && fraction <= 1.0);
    p->fraction = fraction;
    if (strikes_here(p, PROOF_REPORT_CANCELS)) cscd_context_cancel(p->context);
    return !strikes_here(p, PROOF_REPORT_REFUSES);
}

static void run_backwards(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index),
                          void *data) {
    proof *p = user;
    p->wide_loops += task_count > 1;
    for (uint32_t i = task_count; i-- > 0;) {
        task(data, i);
        if (strikes_here(p, PROOF_TASK_CANCELS)) cscd_context_cancel(p->context);
    }
}

bool proof_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    proof *p = user;
    if (strikes_here(p, PROOF_IGNORE_CANCELS)) cscd_context_cancel(p->context);
    return kind == CSCD_CONTACT_TT && a == b;
}

/* ---- digests -------------------------------------------------------------------------------------------- */

static const uint64_t empty_digest = 0xcbf29ce484222325u;

static void add_bytes(uint64_t *digest, const void *bytes, size_t size) { /* FNV-1a */
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++) *digest = (*digest ^ byte[i]) * 0x100000001b3u;
}

void proof_add(proof *p, const void *bytes, size_t size) {
    add_bytes(&p->digests[p->at_call].answer, bytes, size);
}

void proof_add_items(proof *p, const void *items, size_t count, size_t size) {
    proof_add(p, &count, sizeof count);
    if (items != NULL) proof_add(p, items, count * size);
    p->items += count;
}

/* Trees may have been built again by a call that has failed then, so their number is not compared. */
static void read_detector(proof *p) {
    cscd_counters counters = cscd_detector_counters(p->detector);
    const cscd_mesh *mesh = cscd_detector_mesh(p->detector);
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) {
        for (int state = TRIANGLE_UNKNOWN; state <= TRIANGLE_CLEAN; state++) {
            const uint32_t known = start_states_in(p->detector, c, (triangle_state)state);
            add_bytes(&p->digests[p->at_call].counters, &known, sizeof known);
        }
    }
    counters.rebuilds = 0;
    add_bytes(&p->digests[p->at_call].counters, &counters, sizeof counters);
}

/* ---- calls ---------------------------------------------------------------------------------------------- */

static void expect_bytes(const proof *p, const void *bytes, size_t size, unsigned char value) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++)
        if (byte[i] != value)
            fail_msg("%s has failed and has written an output", p->row->calls[p->at_call]->function);
}

static void expect_failure(proof *p, const proof_call *call, cscd_status status, size_t held) {
    const bool memory = p->source == PROOF_ALLOCATION_FAILS;
    if (!atomic_load(&p->struck) || status != (memory ? CSCD_OUT_OF_MEMORY : CSCD_CANCELLED))
        fail_msg("%s: %s, after %s, number %zu", call->function, cscd_status_string(status),
                 source_names[p->source], p->at);
    if (p->context != NULL)
        assert_non_null(strstr(cscd_context_detail(p->context), memory ? "out of memory" : "cancel"));
    expect_bytes(p, &p->answer, sizeof p->answer, UNTOUCHED);
    expect_bytes(p, p->reached, sizeof p->reached, UNTOUCHED);
    if (call->kind == PROOF_CREATES &&
        p->options.parallel_for.run == NULL) /* its marks stay in the context */
        assert_int_equal(p->counter.bytes, held);
    if (memory)
        p->failures++;
    else
        p->cancellations++;
}

static cscd_status make_once(proof *p, const proof_call *call) {
    memset(&p->answer, UNTOUCHED, sizeof p->answer);
    memset(p->reached, UNTOUCHED, sizeof p->reached);
    p->fraction = 0.0;
    p->armed = p->only < 0 || p->only == p->at_call;
    cscd_status status = call->make(p);
    p->armed = false;
    return status;
}

static void read_answer(proof *p, const proof_call *call) {
    p->digests[p->at_call].answer = p->digests[p->at_call].counters = empty_digest;
    if (call->read != NULL) call->read(p);
    if (p->detector != NULL) read_detector(p);
}

static void answer_again(proof *p, const proof_call *call) {
    const uint64_t expected = p->digests[p->at_call].answer;
    if (make_once(p, call) != CSCD_OK) fail_msg("%s fails when it is asked again", call->function);
    read_answer(p, call);
    if (p->digests[p->at_call].answer != expected)
        fail_msg("%s answered something else when it was asked again", call->function);
}

/* The last times find all lists long enough. */
static void ask_again(proof *p, const proof_call *call) {
    size_t allocations = 0;
    for (int i = 0; i < p->again; i++) {
        if (i == p->again - 2) allocations = p->counter.calls;
        answer_again(p, call);
    }
    if (p->again > 1 && p->counter.calls != allocations) p->allocates = call->function;
}

/* The same of all calls that ask, those behind the last one of another kind, in turns. */
static void ask_in_turns(proof *p) {
    const proof_call *const *calls = p->row->calls;
    size_t allocations = p->counter.calls;
    int end = 0, begin;
    while (calls[end] != NULL) end++;
    for (begin = end; begin > 0 && calls[begin - 1]->kind == PROOF_ASKS;) begin--;
    for (int i = 0; i < p->again; i++) {
        if (i == p->again - 2) allocations = p->counter.calls;
        for (p->at_call = begin; p->at_call < end; p->at_call++) answer_again(p, calls[p->at_call]);
    }
    if (p->counter.calls != allocations) p->allocates = "one of the calls in turns";
}

static void make_call(proof *p, const proof_call *call) {
    const size_t held = p->counter.bytes;
    cscd_status status = make_once(p, call);
    if (status != CSCD_OK) {
        expect_failure(p, call, status, held);
        if (p->skips) return;
        status = make_once(p, call);
        if (status != CSCD_OK)
            fail_msg("%s: %s (%s) when it was made after %s, number %zu", call->function,
                     cscd_status_string(status), p->context != NULL ? cscd_context_detail(p->context) : "",
                     source_names[p->source], p->at);
    }
    read_answer(p, call);
    if (call->kind == PROOF_ASKS) ask_again(p, call);
}

/* ---- a world -------------------------------------------------------------------------------------------- */

proof proof_world(const proof_row *row, uint32_t thread_count, proof_source source, size_t at) {
    proof p = {.row = row, .source = source, .at = at, .only = -1, .out = -1};
    p.options = cscd_context_defaults();
    p.options.thread_count = thread_count;
    return p;
}

void proof_need(proof *p, cscd_status status) {
    if (status != CSCD_OK) fail_msg("%s: %s", p->row->name, cscd_context_detail(p->context));
}

void proof_take_context(proof *p, cscd_context *context) {
    p->context = context;
    p->context->progress.interval_ms = 0.0; /* asks whenever it can */
    p->empty = p->counter.bytes;
}

static void open_context(proof *p) {
    p->counter = counting_allocator_start();
    p->thread = pthread_self();
    p->options.allocator = (cscd_allocator){allocate_block, release_block, p};
    if (!p->unwatched) p->options.progress = (cscd_progress){report_progress, p};
    cscd_context *context;
    if (p->row->without_context) return;
    assert_int_equal(cscd_context_create(&p->options, &context), CSCD_OK);
    proof_take_context(p, context);
}

void proof_host_loop(proof *p) {
    p->options.parallel_for = (cscd_parallel_for){run_backwards, p};
}

/* In a release a context frees whatever is left when it goes, so what its objects leave behind is looked for before. */
static void expect_nothing_left(const proof *p) {
    if (p->options.parallel_for.run == NULL && p->counter.bytes != p->empty)
        fail_msg("%s: %zu bytes are left after %s, number %zu", p->row->name, p->counter.bytes - p->empty,
                 source_names[p->source], p->at);
}

static void destroy_all(proof *p) {
    cscd_event_tracker_destroy(p->tracker);
    cscd_event_tracker_destroy(p->later);
    cscd_energy_destroy(p->energy);
    cscd_line_search_destroy(p->line);
    cscd_detector_destroy(p->clone);
    cscd_detector_destroy(p->detector);
    cscd_plan_destroy(p->plan);
    cscd_mesh_change_destroy(p->change);
    cscd_mesh_destroy(p->mesh);
    if (p->row->close != NULL) p->row->close(p);
    expect_nothing_left(p);
    cscd_context_destroy(p->context);
    assert_int_equal(p->counter.live, 0);
    assert_int_equal(p->counter.bytes, 0);
}

void proof_live(proof *p) {
    open_context(p);
    if (p->row->open != NULL) p->row->open(p);
    for (p->at_call = 0; p->row->calls[p->at_call] != NULL; p->at_call++)
        if (p->at_call != p->out) make_call(p, p->row->calls[p->at_call]);
    ask_in_turns(p);
    destroy_all(p);
}

/* ---- worlds compared ----------------------------------------------------------------------------------- */

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
