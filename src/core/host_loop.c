/* The host's own parallel loop: see host_loop.h. */
#include "src/core/host_loop.h"

#include <sched.h>
#include <string.h>

/* New memory says that no task waits. */
enum { TASK_DONE, TASK_WAITING, TASK_RUNNING };

host_loop host_loop_of(host_memory *memory, cscd_parallel_for host) {
    return (host_loop){.host = host, .memory = memory};
}

void host_loop_free(host_loop *loop) {
    for (int i = 0; i < MARK_BLOCKS; i++) memory_free(loop->memory, loop->marks[i]);
}

void host_loop_begin_call(host_loop *loop) {
    atomic_store_explicit(&loop->repeated, 0, memory_order_relaxed);
    loop->faults = (loop_faults){.tasks = 0};
}

loop_faults host_loop_faults(const host_loop *loop) {
    loop_faults faults = loop->faults;
    faults.repeated = atomic_load(&loop->repeated);
    return faults;
}

/* ---- marks ---------------------------------------------------------------------------------------------- */

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

/* ---- one task ------------------------------------------------------------------------------------------ */

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

/* ---- all tasks ----------------------------------------------------------------------------------------- */

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

void host_loop_run(host_loop *loop, uint32_t task_count, parallel_task *task, void *data) {
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
