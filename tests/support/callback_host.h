/* A host whose callbacks stop at one chosen call, for tests of what follows when a callback does not go on as it should:
 * an allocator, a parallel loop, a progress function and `ignore`, around two panels of which one passes through the other. */
#pragma once

#include "src/core/entry.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/panels.h"

#include <pthread.h>

/* The caller sets `from`, `stop` and what it needs besides, and keeps it where it is while it is open. */
typedef struct callback_host {
    host_callback from;       /* which callback stops */
    void (*stop)(void *host); /* what it does then; host is this struct */
    void (*run)(void *host, uint32_t task_count, void (*task)(void *data, uint32_t index), void *data);
    /* the parallel loop; NULL: one on this thread, if `from` asks for it */
    bool on_any_thread; /* else the callback stops on the thread alone that has opened the host */
    uint32_t at;        /* in which call of the callback, counted from 1; 0: it goes on */
    atomic_uint calls;  /* of that callback so far */
    pthread_t thread;
    panel_scene p;
    counting_allocator counter;
} callback_host;

/* Makes the scene with panels of side * side vertices. Progress is asked as often as can be. */
void callback_host_open(callback_host *h, uint32_t side, uint32_t thread_count);

/* Destroys all of it; everything must be freed then. */
void callback_host_close(callback_host *h);

/* Every word of the sentence by which a broken context names the callback. */
const char *callback_host_name(host_callback callback);
