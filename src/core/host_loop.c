/* The host's own parallel loop: see host_loop.h. */
#include "src/core/host_loop.h"

#include <sched.h>
#include <string.h>

enum { TASK_WAITING, TASK_RUNNING, TASK_DONE, TASK_LEFT };

host_loop host_loop_of(host_memory *memory, cscd_parallel_for host) {
    return (host_loop){.host = host, .memory = memory};
}

void host_loop_free(host_loop *loop) {
    memory_free(loop->memory, loop->marks);
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

/* ---- one task ------------------------------------------------------------------------------------------ */

/* On the host's thread, which has a floating-point environment of its own. */
typedef struct running_task {
    atomic_uchar *mark;
    float_environment before;
    unsigned char end;
} running_task;

/* An exception of the allocator may end a task, too: then the task has been left. */
static void end_task(running_task *task) {
    float_environment_set(task->before);
    atomic_store(task->mark, task->end);
}

static void run_marked_task(host_loop *loop, uint32_t index) {
    __attribute__((cleanup(end_task)))
    running_task task = {&loop->marks[index], float_environment_begin(), TASK_LEFT};
    loop->task(loop->data, index);
    task.end = TASK_DONE;
}

static bool take_task(host_loop *loop, uint32_t index) {
    unsigned char waiting = TASK_WAITING;
    return index < atomic_load(&loop->task_count) &&
           atomic_compare_exchange_strong(&loop->marks[index], &waiting, TASK_RUNNING);
}

static void run_host_task(void *data, uint32_t index) {
    host_loop *loop = data;
    if (take_task(loop, index))
        run_marked_task(loop, index);
    else
        atomic_fetch_add(&loop->repeated, 1);
}

/* ---- all tasks ----------------------------------------------------------------------------------------- */

static bool reserve_marks(host_loop *loop, uint32_t task_count) {
    if (task_count > loop->marks_count) {
        size_t count = (size_t)task_count + task_count / 2;
        atomic_uchar *marks = memory_allocate(loop->memory, count, sizeof *marks);
        if (marks == NULL) return false;
        memory_free(loop->memory, loop->marks);
        loop->marks = marks;
        loop->marks_count = count;
    }
    for (uint32_t i = 0; i < task_count; i++)
        atomic_store_explicit(&loop->marks[i], TASK_WAITING, memory_order_relaxed);
    return true;
}

/* Runs what the host has left out, and waits for what it still runs: that works on our caller's data. */
static void finish_tasks(host_loop *loop, uint32_t task_count) {
    for (uint32_t i = 0; i < task_count; i++) {
        loop->faults.unfinished += atomic_load(&loop->marks[i]) == TASK_RUNNING;
        if (!take_task(loop, i)) continue;
        loop->faults.left_out++;
        run_marked_task(loop, i);
    }
    for (uint32_t i = 0; i < task_count; i++) {
        while (atomic_load(&loop->marks[i]) == TASK_RUNNING) sched_yield();
    }
}

void host_loop_run(host_loop *loop, uint32_t task_count, parallel_task *task, void *data) {
    if (!reserve_marks(loop, task_count)) {
        for (uint32_t i = 0; i < task_count; i++) task(data, i);
        return;
    }
    loop->task = task;
    loop->data = data;
    loop->faults.tasks += task_count;
    atomic_store(&loop->task_count, task_count);
    HOST_CALL(call, loop->memory->entry, HOST_PARALLEL_FOR);
    loop->host.run(loop->host.user, task_count, run_host_task, loop);
    host_call_end(&call);
    finish_tasks(loop, task_count);
    atomic_store(&loop->task_count, 0);
}
