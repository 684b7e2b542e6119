/* A parallel loop of the host that leaves tasks out, repeats them or returns too early: the call fails and says so, nothing
 * is lost or invented, and the next call with an honest loop is right. */
#include "tests/support/panels.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef void task_function(void *data, uint32_t index);

typedef struct dishonest_host {
    int trick;
    uint32_t runs, only_run; /* the tricks are played in this run alone, counted from 1; 0: in every one */
} dishonest_host;

enum { HONEST, DROP_LAST, DROP_ALL, REPEAT_ALL, REPEAT_AT_ONCE, BEYOND_END, RETURN_EARLY, TRICKS };

typedef struct late_task {
    task_function *task;
    void *data;
    uint32_t index;
    atomic_bool begun;
    pthread_t thread;
} late_task;

static void *run_on_thread(void *argument) {
    late_task *late = argument;
    atomic_store(&late->begun, true);
    late->task(late->data, late->index);
    return NULL;
}

static void start_thread(late_task *late, task_function *task, void *data, uint32_t index) {
    *late = (late_task){.task = task, .data = data, .index = index};
    assert_int_equal(pthread_create(&late->thread, NULL, run_on_thread, late), 0);
}

/* Two threads run the same tasks at the same time. */
static void run_at_once(uint32_t task_count, task_function *task, void *data) {
    for (uint32_t i = 0; i < task_count; i++) {
        late_task late;
        start_thread(&late, task, data, i);
        task(data, i);
        pthread_join(late.thread, NULL);
    }
}

static late_task left_behind;
static bool is_left_behind;

static void join_left_behind(void) {
    if (is_left_behind) pthread_join(left_behind.thread, NULL);
    is_left_behind = false;
}

/* The thread of the last task runs on. Most often it has begun the task by then, but the system may also stop it just
 * before; nothing that the host can see tells the two apart. */
static void run_and_return_early(uint32_t task_count, task_function *task, void *data) {
    join_left_behind();
    for (uint32_t i = 0; i + 1 < task_count; i++) task(data, i);
    start_thread(&left_behind, task, data, task_count - 1);
    while (!atomic_load(&left_behind.begun)) usleep(1);
    is_left_behind = true;
}

static void run_dishonestly(void *user, uint32_t task_count, task_function *task, void *data) {
    dishonest_host *h = user;
    h->runs++;
    int trick = h->only_run == 0 || h->runs == h->only_run ? h->trick : HONEST;
    if (trick == REPEAT_AT_ONCE) {
        run_at_once(task_count, task, data);
        return;
    }
    if (trick == RETURN_EARLY) {
        run_and_return_early(task_count, task, data);
        return;
    }
    uint32_t end = trick == DROP_ALL ? 0 : trick == DROP_LAST ? task_count - 1 : task_count;
    for (uint32_t i = 0; i < end; i++) {
        task(data, i);
        if (trick == REPEAT_ALL) task(data, i);
    }
    if (trick == BEYOND_END) task(data, task_count);
}

static panel_scene make_panels(dishonest_host *host) {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 4;
    options.parallel_for = (cscd_parallel_for){run_dishonestly, host};
    return panels_create(40, &options, NULL);
}

/* ---- one step ------------------------------------------------------------------------------------------ */

static cscd_contact *copy_contacts(cscd_contacts found) {
    cscd_contact *copy = malloc(found.count * sizeof *copy);
    assert_non_null(copy);
    return memcpy(copy, found.items, found.count * sizeof *copy);
}

/* Returns the contacts of an honest step, and how many runs it took. */
static cscd_contact *honest_contacts(size_t *count, uint32_t *runs) {
    dishonest_host host = {HONEST, 0, 0};
    panel_scene p = make_panels(&host);
    cscd_contacts found;
    host.runs = 0;
    assert_int_equal(panels_step(&p, &found), CSCD_OK);
    *count = found.count;
    *runs = host.runs;
    cscd_contact *copy = copy_contacts(found);
    panels_destroy(&p);
    return copy;
}

/* In one run the tricks with one task count 1. A thread that begins its task after the loop's return has left it out, and
 * may repeat one of a later loop. */
static void check_sentence(const char *sentence, int trick, bool one_run) {
    unsigned tasks, left_out, repeated, unfinished;
    assert_int_equal(sscanf(sentence,
                            "of %u tasks, parallel_for left out %u, ran %u again, and returned before %u had",
                            &tasks, &left_out, &repeated, &unfinished),
                     4);
    if (trick == RETURN_EARLY) {
        assert_true(left_out + unfinished > 0);
        return;
    }
    bool one = one_run && trick != DROP_ALL && trick != REPEAT_ALL && trick != REPEAT_AT_ONCE;
    unsigned faults[] = {left_out, repeated, unfinished};
    int of = trick <= DROP_ALL ? 0 : 1;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(faults[i] > 0, i == of);
        if (one && i == of) assert_int_equal(faults[i], 1);
    }
    assert_true(tasks >= faults[of] || trick == BEYOND_END);
}

static void check_honest_step(const panel_scene *p, const cscd_contact *expected, size_t count) {
    cscd_contacts found;
    assert_int_equal(panels_step(p, &found), CSCD_OK);
    assert_int_equal(found.count, count);
    assert_memory_equal(found.items, expected, count * sizeof *expected);
}

/* Plays the trick in one run of the first step; the step is then repeated. */
static void step_fails_and_recovers(int trick, uint32_t run, const cscd_contact *expected, size_t count) {
    dishonest_host host = {HONEST, 0, 0};
    panel_scene p = make_panels(&host);
    cscd_contacts found = {.count = 77};
    host = (dishonest_host){trick, 0, run};
    cscd_status status = panels_step(&p, &found);
    join_left_behind();
    if (trick != RETURN_EARLY || status != CSCD_OK) { /* a task may end just before the loop returns */
        assert_int_equal(status, CSCD_INVALID_ARGUMENT);
        assert_int_equal(found.count, 77);
        check_sentence(cscd_context_detail(p.context), trick, run > 0);
    }
    host.trick = HONEST;
    check_honest_step(&p, expected, count);
    panels_destroy(&p);
}

TEST(faults_fail_the_call) {
    size_t count;
    uint32_t runs;
    cscd_contact *expected = honest_contacts(&count, &runs);
    assert_true(count > 900 && runs > 1);
    for (int trick = DROP_LAST; trick < TRICKS; trick++) {
        for (uint32_t run = 0; run <= runs; run += PACED(1, 4))
            step_fails_and_recovers(trick, run, expected, count);
    }
    free(expected);
}

/* ---- every call ---------------------------------------------------------------------------------------- */

enum { CALLS = 5 };

static cscd_status make_call(const panel_scene *p, int call) {
    cscd_contacts contacts;
    cscd_intersections intersections;
    cscd_proximities proximities;
    cscd_free_step step;
    cscd_plan *plan = NULL;
    cscd_status status = call == 0   ? panels_step(p, &contacts)
                         : call == 1 ? panels_check(p, &intersections)
                         : call == 2 ? panels_near(p, &proximities)
                         : call == 3 ? panels_max_step(p, &step)
                                     : panels_plan(p, CSCD_METHOD_SINGLE, &plan);
    cscd_plan_destroy(plan);
    return status;
}

/* Plays the trick in one run of a call, or in all if that is 0; the call is then repeated. Returns how many runs it took. */
static uint32_t call_notices(int call, int trick, uint32_t run) {
    dishonest_host host = {HONEST, 0, 0};
    panel_scene p = make_panels(&host);
    host = (dishonest_host){trick, 0, run};
    cscd_status status = make_call(&p, call);
    const uint32_t runs = host.runs;
    assert_int_equal(status, trick != HONEST && runs > 0 ? CSCD_INVALID_ARGUMENT : CSCD_OK);
    host.trick = HONEST;
    assert_int_equal(make_call(&p, call), CSCD_OK);
    panels_destroy(&p);
    return runs;
}

/* Whichever run it is that leaves tasks out. A call that uses no loop, or only one task, has nothing to complain of. */
TEST(every_call_notices) {
    uint32_t noticed = 0;
    for (int call = 0; call < CALLS; call++) {
        const uint32_t runs = call_notices(call, HONEST, 0);
        noticed += runs > 0;
        for (int trick = DROP_LAST; trick <= REPEAT_ALL; trick++) {
            for (uint32_t run = 0; run <= (trick == DROP_LAST ? runs : 0); run += run == 0 ? 1 : PACED(1, 4))
                call_notices(call, trick, run);
        }
    }
    assert_true(noticed >= 5);
}

/* ---- a thread that is late again and again --------------------------------------------------------------- */

/* It calls tasks of all numbers from the first loop on, in loops and between them. */
typedef struct hammer {
    task_function *task;
    void *data;
    atomic_bool quit;
    bool begun;
    pthread_t thread;
} hammer;

static void *hammer_tasks(void *argument) {
    hammer *h = argument;
    for (uint32_t i = 0; !atomic_load(&h->quit); i++) {
        h->task(h->data, i % 1000);
        if (i % 1000 == 0) usleep(1);
    }
    return NULL;
}

static void run_beside_hammer(void *user, uint32_t task_count, task_function *task, void *data) {
    hammer *h = user;
    if (!h->begun) {
        h->task = task;
        h->data = data;
        h->begun = true;
        assert_int_equal(pthread_create(&h->thread, NULL, hammer_tasks, h), 0);
    }
    for (uint32_t i = 0; i < task_count; i++) task(data, i);
}

static void step_beside_hammer(const cscd_contact *expected, size_t count) {
    hammer h = {.begun = false};
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 4;
    options.parallel_for = (cscd_parallel_for){run_beside_hammer, &h};
    panel_scene p = panels_create(40, &options, NULL);
    cscd_contacts found;
    for (int i = 0; i < 5 || !h.begun; i++) {
        cscd_status status = panels_step(&p, &found);
        assert_true(status == CSCD_INVALID_ARGUMENT || status == CSCD_OK);
    }
    atomic_store(&h.quit, true);
    pthread_join(h.thread, NULL);
    check_honest_step(&p, expected, count);
    panels_destroy(&p);
}

/* The first loops of a context are those that need more marks than the ones before. */
TEST(late_threads_harm_nothing) {
    size_t count;
    uint32_t runs;
    cscd_contact *expected = honest_contacts(&count, &runs);
    for (int context = 0; context < 10; context++) step_beside_hammer(expected, count);
    free(expected);
}
