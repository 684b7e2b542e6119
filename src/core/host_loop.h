/* The host's own parallel loop, which is not trusted to run every task once.
 *
 * Each task has a mark, so that a task that comes a second time does nothing; tasks that the host has left out are run
 * here, because what follows relies on them. So nothing breaks and nothing is lost, but the call fails: a loop that
 * drops tasks today may corrupt something tomorrow. */
#pragma once

#include "src/core/entry.h"
#include "src/core/memory.h"

typedef void parallel_task(void *data, uint32_t task);

/* How often the loop has broken its contract in the present call. */
typedef struct loop_faults {
    uint32_t left_out,
        unfinished;    /* tasks that the loop has not run, or not to their ends when it returned */
    uint32_t repeated; /* calls of tasks that had been run before, or do not exist */
    uint64_t tasks;    /* all tasks of the call */
} loop_faults;

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

host_loop host_loop_of(host_memory *memory, cscd_parallel_for host);
void host_loop_free(host_loop *loop);

/* Runs the tasks, each once. */
void host_loop_run(host_loop *loop, uint32_t task_count, parallel_task *task, void *data);

/* Begins a call, whose faults are counted from 0. */
void host_loop_begin_call(host_loop *loop);
loop_faults host_loop_faults(const host_loop *loop);
