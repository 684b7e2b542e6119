/* Independent tasks, run by a fixed crew of threads or by the host; results never depend on who ran which. */
#pragma once

#include "src/core/memory.h"

/* Data that a thread writes often starts on a cache line of its own: two threads on one line halve the speed
 * of both (measured: traversal took twice as long with two threads as with one). */
enum { CACHE_LINE_SIZE = 64 };

typedef void parallel_task(void *data, uint32_t task);

/* The number of times that the loop has broken its contract in the present call. */
typedef struct loop_faults {
    uint32_t left_out,
        unfinished;    /* tasks that the loop has not run, or not to their ends when it returned */
    uint32_t repeated; /* calls of tasks that had been run before, or do not exist */
    uint64_t tasks;    /* all tasks of the call */
} loop_faults;

typedef struct parallel parallel;

/* thread_count includes the caller; 0 means one per processor. With host.run no thread is started, nor where
 * the system has none: then the caller runs all tasks. */
cscd_status parallel_create(host_memory *m, uint32_t thread_count, cscd_parallel_for host, parallel **out);
void parallel_destroy(host_memory *m, parallel *threads);

/* Is this a child that fork made after the crew was started? threads may be NULL. */
bool parallel_is_of_parent(const parallel *threads);

/* The number of threads, the caller included. Work that keeps data for each thread divides it into this
 * number of shares. */
uint32_t parallel_thread_count(const parallel *threads);

/* Calls task(data, 0 .. task_count - 1), each once, in any order, and returns when all are done. The host may
 * run them one after the other, so a task never waits for another one, and never calls this. */
void parallel_run(parallel *threads, uint32_t task_count, parallel_task *task, void *data);

/* Begins a call of the API; and what the host's loop has done wrong in it so far. */
void parallel_begin_call(parallel *threads);
loop_faults parallel_faults(const parallel *threads);

/* Returns the beginning of a share when count things are divided into share_count shares; that of share
 * share_count is count. The product would not fit into a size of 32 bits. */
static inline size_t parallel_share(size_t count, uint32_t share, uint32_t share_count) {
    return (size_t)((uint64_t)count * share / share_count);
}
