/* Independent tasks, run by a fixed crew of threads or by the host; results never depend on who ran which. */
#include "src/core/parallel.h"

#include "src/core/entry.h"
#include "src/core/system.h"
#include "src/core/timer.h"

#include <assert.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>

/* ---- the host's loop ----------------------------------------------------------------------------------- */

/* The host's own parallel loop, which is not trusted to run every task once.
 *
 * Each task has a mark, so that a task that comes a second time does nothing; tasks that the host has left out are run
 * here, because what follows relies on them. So nothing breaks and nothing is lost, but the call fails: a loop that
 * drops tasks today may corrupt something tomorrow. */
enum { MARK_BLOCKS = 25 }; /* enough for every 32-bit number of tasks */

typedef struct host_loop {
    cscd_parallel_for host; /* run NULL: there is none */
    host_memory *memory;
    parallel_task *task;
    void *data;
    atomic_uchar *marks[MARK_BLOCKS]; /* per task; what has been allocated stays to the end of the context */
    atomic_uint task_count, repeated;
    loop_faults faults; /* without those that `repeated` counts */
} host_loop;

/* New memory says that no task waits. */
enum { TASK_DONE, TASK_WAITING, TASK_RUNNING };

static host_loop host_loop_of(host_memory *memory, cscd_parallel_for host) {
    return (host_loop){.host = host, .memory = memory};
}

static void host_loop_free(host_loop *loop) {
    for (int i = 0; i < MARK_BLOCKS; i++) memory_free(loop->memory, loop->marks[i]);
}

/* Begins a call, whose faults are counted from 0. */
static void host_loop_begin_call(host_loop *loop) {
    atomic_store_explicit(&loop->repeated, 0, memory_order_relaxed);
    loop->faults = (loop_faults){.tasks = 0};
}

static loop_faults host_loop_faults(const host_loop *loop) {
    loop_faults faults = loop->faults;
    faults.repeated = atomic_load(&loop->repeated);
    return faults;
}

/* The first block has marks of 256 tasks, the second one those of the next 256, and each further one as many as all before it. */
enum { FIRST_MARKS_SHIFT = 8 };

static int block_of_task(uint32_t index) {
    uint32_t doublings = index >> FIRST_MARKS_SHIFT;
    return doublings == 0 ? 0 : 32 - __builtin_clz(doublings);
}

static uint32_t block_begin(int block) {
    return block == 0 ? 0 : UINT32_C(1) << (FIRST_MARKS_SHIFT - 1 + block);
}

static size_t block_size(int block) {
    return block == 0 ? 1u << FIRST_MARKS_SHIFT : block_begin(block);
}

static atomic_uchar *mark_of(host_loop *loop, uint32_t index) {
    int block = block_of_task(index);
    return &loop->marks[block][index - block_begin(block)];
}

static bool reserve_marks(host_loop *loop, uint32_t task_count) {
    for (int block = 0; block <= block_of_task(task_count - 1); block++) {
        if (loop->marks[block] != NULL) continue;
        loop->marks[block] = memory_allocate(loop->memory, block_size(block), sizeof *loop->marks[block]);
        if (loop->marks[block] == NULL) return false;
    }
    return true;
}

/* On a thread of the host, which has a floating-point environment of its own. */
static void run_marked_task(host_loop *loop, uint32_t index) {
    float_environment before = float_environment_begin();
    loop->task(loop->data, index);
    float_environment_set(before);
    atomic_store(mark_of(loop, index), TASK_DONE);
}

/* A thread of the host that was late for an earlier loop may come at any time, even between two of these lines. It finds
 * a mark, since these stay where they are, and takes only a task that waits, whose function and data it then sees. */
static bool take_task(host_loop *loop, uint32_t index) {
    unsigned char waiting = TASK_WAITING;
    return index < atomic_load(&loop->task_count) &&
           atomic_compare_exchange_strong(mark_of(loop, index), &waiting, TASK_RUNNING);
}

static void run_host_task(void *data, uint32_t index) {
    host_loop *loop = data;
    if (take_task(loop, index))
        run_marked_task(loop, index);
    else
        atomic_fetch_add(&loop->repeated, 1);
}

/* The marks come last: from then on, any thread of the host may begin. */
static void offer_loop(host_loop *loop, uint32_t task_count, parallel_task *task, void *data) {
    loop->task = task;
    loop->data = data;
    loop->faults.tasks += task_count;
    atomic_store(&loop->task_count, task_count);
    for (uint32_t i = 0; i < task_count; i++)
        atomic_store_explicit(mark_of(loop, i), TASK_WAITING, memory_order_release);
}

/* Runs what the host has left out, and waits for what it still runs: that works on our caller's data. */
static void finish_tasks(host_loop *loop, uint32_t task_count) {
    for (uint32_t i = 0; i < task_count; i++) {
        loop->faults.unfinished += atomic_load(mark_of(loop, i)) == TASK_RUNNING;
        if (!take_task(loop, i)) continue;
        loop->faults.left_out++;
        run_marked_task(loop, i);
    }
    for (uint32_t i = 0; i < task_count; i++) {
        while (atomic_load(mark_of(loop, i)) == TASK_RUNNING) sched_yield();
    }
}

/* Runs the tasks, each once. */
static void host_loop_run(host_loop *loop, uint32_t task_count, parallel_task *task, void *data) {
    if (!reserve_marks(loop, task_count)) {
        for (uint32_t i = 0; i < task_count; i++) task(data, i);
        return;
    }
    offer_loop(loop, task_count, task, data);
    host_call call = host_call_begin(loop->memory->entry);
    loop->host.run(loop->host.user, task_count, run_host_task, loop);
    host_call_end(&call);
    finish_tasks(loop, task_count);
    atomic_store(&loop->task_count, 0);
}

/* ---- the crew ------------------------------------------------------------------------------------------ */

/* A waiting thread looks for work this often before it yields the processor, and for this long before it
 * sleeps: the stages of an interval follow each other more closely, and waking up takes about as long. */
enum { LOOKS_AT_ONCE = 32 };
static const double patience_ms = 0.05;

/* The gate: above the flags it holds the number of the work on offer, below them the number of helpers inside.
 * Helpers enter only while it is open, so the caller never waits for one that has not come by the time all is done. */
#define GATE_INSIDE  ((uint64_t)0xffff)
#define GATE_AWAITED ((uint64_t)1 << 30) /* the caller sleeps until nobody is inside */
#define GATE_OPEN    ((uint64_t)1 << 31)
enum { GATE_NUMBER_SHIFT = 32 };

/* The tasks from next to end - 1 are meant for one thread, which finds in its cache what it wrote in the
 * stage before; other threads take them when they have done their own. */
typedef struct task_range {
    _Alignas(CACHE_LINE_SIZE) atomic_uint next;
    uint32_t end;
} task_range;

typedef struct helper {
    struct parallel *threads;
    pthread_t thread;
    uint32_t index; /* the caller is 0 */
} helper;

struct parallel {
    uint32_t thread_count; /* the caller included */
    host_loop host;        /* run NULL: the crew's own threads */
    uint32_t started;      /* helpers that were really started */
    uint32_t forks;        /* of the process that has them: system_forks */
    helper *helpers;
    double patience_ms; /* 0: there are fewer processors than threads */

    pthread_mutex_t lock;
    pthread_cond_t work_ready, work_done;
    uint64_t calls;       /* how often sleepers were woken; under the lock */
    atomic_uint sleepers; /* helpers that wait for a call; changed under the lock */
    atomic_bool quit;

    /* The work on offer, which is written while the gate is closed and nobody is inside. */
    parallel_task *task;
    void *data;
    task_range *ranges; /* per thread */

    _Alignas(CACHE_LINE_SIZE) atomic_uint_fast64_t gate;
};

static void run_tasks(parallel *threads, uint32_t self) {
    for (uint32_t i = 0; i < threads->thread_count; i++) {
        task_range *range = &threads->ranges[(self + i) % threads->thread_count];
        while (atomic_load(&range->next) < range->end) {
            uint32_t task = atomic_fetch_add(&range->next, 1);
            if (task < range->end) threads->task(threads->data, task);
        }
    }
}

static void offer_tasks(parallel *threads, uint32_t task_count, parallel_task *task, void *data) {
    threads->task = task;
    threads->data = data;
    for (uint32_t i = 0; i < threads->thread_count; i++) {
        atomic_store(&threads->ranges[i].next, (uint32_t)((uint64_t)task_count * i / threads->thread_count));
        threads->ranges[i].end = (uint32_t)((uint64_t)task_count * (i + 1) / threads->thread_count);
    }
}

static void pause_briefly(void) {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

/* ---- helpers ----------------------------------------------------------------------------------------- */

/* Does the gate offer work that this helper has not seen? */
static bool offers_work(uint64_t gate, uint32_t seen) {
    return (gate & GATE_OPEN) != 0 && (uint32_t)(gate >> GATE_NUMBER_SHIFT) != seen;
}

static bool enter_gate(parallel *threads, uint32_t *seen) {
    uint64_t gate = atomic_load(&threads->gate);
    while (offers_work(gate, *seen)) {
        if (!atomic_compare_exchange_weak(&threads->gate, &gate, gate + 1)) continue;
        *seen = (uint32_t)(gate >> GATE_NUMBER_SHIFT);
        return true;
    }
    return false;
}

static void leave_gate(parallel *threads) {
    uint64_t before = atomic_fetch_sub(&threads->gate, 1), gate = before - 1;
    assert((before & GATE_INSIDE) != 0);
    if ((gate & GATE_INSIDE) != 0 || (gate & GATE_AWAITED) == 0) return;
    pthread_mutex_lock(&threads->lock);
    pthread_cond_signal(&threads->work_done);
    pthread_mutex_unlock(&threads->lock);
}

static bool enter_soon(parallel *threads, uint32_t *seen) {
    double begin = timer_now_ms();
    do {
        for (int i = 0; i < LOOKS_AT_ONCE; i++) {
            if (enter_gate(threads, seen)) return true;
            pause_briefly();
        }
        sched_yield();
    } while (timer_now_ms() - begin < threads->patience_ms && !atomic_load(&threads->quit));
    return false;
}

/* Either the caller sees the sleeper after it has opened the gate (or told all to quit), or the sleeper sees what
 * the caller did. */
static void sleep_until_called(parallel *threads, uint32_t seen) {
    pthread_mutex_lock(&threads->lock);
    uint64_t calls = threads->calls;
    atomic_fetch_add(&threads->sleepers, 1);
    if (atomic_load(&threads->quit) || offers_work(atomic_load(&threads->gate), seen)) {
        atomic_fetch_sub(&threads->sleepers, 1);
    } else {
        while (threads->calls == calls) pthread_cond_wait(&threads->work_ready, &threads->lock);
    }
    pthread_mutex_unlock(&threads->lock);
}

static void call_sleepers(parallel *threads) {
    pthread_mutex_lock(&threads->lock);
    threads->calls++;
    atomic_store(&threads->sleepers, 0);
    pthread_cond_broadcast(&threads->work_ready);
    pthread_mutex_unlock(&threads->lock);
}

static void *helper_main(void *argument) {
    const helper *self = argument;
    parallel *threads = self->threads;
    uint32_t seen = 0;
    float_environment_begin();
    while (!atomic_load(&threads->quit)) {
        if (enter_soon(threads, &seen)) {
            run_tasks(threads, self->index);
            leave_gate(threads);
        } else {
            sleep_until_called(threads, seen);
        }
    }
    return NULL;
}

/* ---- the crew ---------------------------------------------------------------------------------------- */

static cscd_status start_helpers(parallel *threads) {
    for (uint32_t i = 0; i + 1 < threads->thread_count; i++) {
        helper *h = &threads->helpers[i];
        h->threads = threads;
        h->index = i + 1;
        if (pthread_create(&h->thread, NULL, helper_main, h) != 0) return CSCD_SYSTEM_ERROR;
        threads->started++;
    }
    return CSCD_OK;
}

cscd_status parallel_create(host_memory *m, uint32_t thread_count, cscd_parallel_for host, parallel **out) {
    if (thread_count == 0) {
        const uint32_t processors = system_processors();
        thread_count = processors > 256 ? 256 : processors;
    }
    parallel *threads = memory_allocate(m, 1, sizeof *threads);
    if (threads == NULL) return CSCD_OUT_OF_MEMORY;
    threads->thread_count = thread_count;
    threads->host = host_loop_of(m, host);
    threads->forks = system_forks();
    threads->patience_ms = thread_count <= system_processors_for_us() ? patience_ms : 0.0;
    pthread_mutex_init(&threads->lock, NULL);
    pthread_cond_init(&threads->work_ready, NULL);
    pthread_cond_init(&threads->work_done, NULL);
    threads->helpers = memory_allocate(m, thread_count, sizeof *threads->helpers);
    threads->ranges = memory_allocate(m, thread_count, sizeof *threads->ranges);
    bool allocated = threads->helpers != NULL && threads->ranges != NULL;
    cscd_status status = allocated ? CSCD_OK : CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK && host.run == NULL && system_has_threads()) status = start_helpers(threads);
    if (status != CSCD_OK) {
        parallel_destroy(m, threads);
        return status;
    }
    *out = threads;
    return CSCD_OK;
}

/* In a child that fork made there are no helpers, only what they have left: a lock that one of them held, and conditions that
 * they still wait for, neither of which may be touched. The caller then does all work by itself. */
static bool has_crew(const parallel *threads) {
    return threads->forks == system_forks();
}

bool parallel_is_of_parent(const parallel *threads) {
    return threads != NULL && !has_crew(threads);
}

static void dismiss_crew(parallel *threads) {
    atomic_store(&threads->quit, true);
    call_sleepers(threads);
    for (uint32_t i = 0; i < threads->started; i++) pthread_join(threads->helpers[i].thread, NULL);
    pthread_cond_destroy(&threads->work_done);
    pthread_cond_destroy(&threads->work_ready);
    pthread_mutex_destroy(&threads->lock);
}

void parallel_destroy(host_memory *m, parallel *threads) {
    if (threads == NULL) return;
    if (has_crew(threads)) dismiss_crew(threads);
    host_loop_free(&threads->host);
    memory_free(m, threads->helpers);
    memory_free(m, threads->ranges);
    memory_free(m, threads);
}

uint32_t parallel_thread_count(const parallel *threads) {
    return threads->thread_count;
}

void parallel_begin_call(parallel *threads) {
    if (threads->host.host.run != NULL) host_loop_begin_call(&threads->host);
    if (threads->started > 0 && !has_crew(threads)) threads->started = 0;
}

loop_faults parallel_faults(const parallel *threads) {
    return host_loop_faults(&threads->host);
}

/* ---- one run ----------------------------------------------------------------------------------------- */

static bool nobody_inside(parallel *threads) {
    return (atomic_load(&threads->gate) & GATE_INSIDE) == 0;
}

static bool all_leave_soon(parallel *threads) {
    if (nobody_inside(threads)) return true;
    double begin = timer_now_ms();
    do {
        for (int i = 0; i < LOOKS_AT_ONCE; i++) {
            if (nobody_inside(threads)) return true;
            pause_briefly();
        }
        sched_yield();
    } while (timer_now_ms() - begin < threads->patience_ms);
    return false;
}

static void close_gate(parallel *threads) {
    atomic_fetch_and(&threads->gate, ~GATE_OPEN);
    if (all_leave_soon(threads)) return;
    pthread_mutex_lock(&threads->lock);
    atomic_fetch_or(&threads->gate, GATE_AWAITED);
    while (!nobody_inside(threads)) pthread_cond_wait(&threads->work_done, &threads->lock);
    atomic_fetch_and(&threads->gate, ~GATE_AWAITED);
    pthread_mutex_unlock(&threads->lock);
}

void parallel_run(parallel *threads, uint32_t task_count, parallel_task *task, void *data) {
    if (threads->host.host.run != NULL && task_count > 1) {
        host_loop_run(&threads->host, task_count, task, data);
        return;
    }
    if (threads->started == 0 || task_count < 2) {
        for (uint32_t i = 0; i < task_count; i++) task(data, i);
        return;
    }
    assert(nobody_inside(threads) && (atomic_load(&threads->gate) & GATE_OPEN) == 0);
    offer_tasks(threads, task_count, task, data);
    uint64_t number = (atomic_load(&threads->gate) >> GATE_NUMBER_SHIFT) + 1;
    atomic_store(&threads->gate, number << GATE_NUMBER_SHIFT | GATE_OPEN);
    if (atomic_load(&threads->sleepers) > 0) call_sleepers(threads);
    run_tasks(threads, 0);
    close_gate(threads);
}
