/* A context as Python uses it: a call gives other threads of Python their turn, and looks for signals and at the
 * callbacks of its caller every few milliseconds.
 *
 * Python calls these functions with its lock (the GIL) and through ctypes.PyDLL, which raises the exception that is set
 * when a call returns. So what a signal's handler or a callback raises reaches the caller as if it had called it itself;
 * the call has then ended with CSCD_CANCELLED. */
#pragma once

#include "cscd/cscd.h"

typedef struct host {
    cscd_context *context;
    void *progress;   /* a callable (stage, fraction), or NULL. Python keeps it alive */
    void *ignore;     /* a callable (kind, a, b) */
    void *thread;     /* of Python, which waits for the call; NULL: no call is running */
    double looked_ms; /* when signals were looked for last */
    size_t users;     /* one for who created it, and one for each keeper of an object of its context */
    bool raised;      /* an exception is set */
    bool lost;        /* by a fork, in the middle of a call. Nothing in it is destroyed any more */
} host;

/* Between these the lock is not ours. False: a call is running in the host, and a callback of it has made another one. */
bool host_begin(host *h);
void host_end(host *h);

/* Ends one use. The last one destroys the context. */
void host_release(host *h);
