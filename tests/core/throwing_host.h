/* C++ for tests in C: throws, catches, and has a pool of threads that passes on what its tasks throw. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

void throw_exception(void);

/* Calls work(data); true: it was left by an exception. */
bool call_catching(void (*work)(void *data), void *data);

/* A parallel loop on a few threads. What tasks throw is thrown again when all threads have ended, or dropped if
 * *(bool *)user. */
void run_on_pool(void *user, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);

#ifdef __cplusplus
}
#endif
