/* Independent tasks, run by a fixed crew of threads or by the host; results never depend on who ran which. */
#pragma once

#include "src/core/memory.h"

/* Data that a thread writes often starts on a cache line of its own: two threads on one line halve the speed
 * of both (measured: traversal took twice as long with two threads as with one). */
enum { CACHE_LINE_SIZE = 64 };

typedef struct parallel parallel;
typedef void parallel_task(void *data, uint32_t task);

/* thread_count includes the caller; 0 means one per processor. With host.run no thread is started. */
cscd_status parallel_create(host_memory *m, uint32_t thread_count, cscd_parallel_for host, parallel **out);
void parallel_destroy(host_memory *m, parallel *threads);

/* The number of threads, the caller included: work that keeps data per lane has as many lanes. */
uint32_t parallel_thread_count(const parallel *threads);

/* Calls task(data, 0 .. task_count - 1), each once, in any order, and returns when all are done. The host may
 * run them one after the other, so a task never waits for another one, and never calls this. */
void parallel_run(parallel *threads, uint32_t task_count, parallel_task *task, void *data);
