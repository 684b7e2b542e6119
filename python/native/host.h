/* Inside the layer that Python calls: its marks, the functions of Python that it calls itself, and contexts as Python uses them.
 *
 * A call gives other threads of Python their turn, and looks for signals and at the callbacks of its caller every few milliseconds.
 * Python calls these functions with its lock (the GIL) and through ctypes.PyDLL, which raises the exception that is set when a call
 * returns. So what a signal's handler or a callback raises reaches the caller as if it had called it itself; the call has then ended
 * with CSCD_CANCELLED. */
#pragma once

#include "cscd/cscd.h"

#include <stdbool.h>
#include <stddef.h>

/* Marks the functions that Python calls; everything else stays within the library. */
#define PYTHON_API __attribute__((visibility("default")))

/* Python finds these functions by name, and no C file calls them, so there is nobody to declare them for. Their types
 * stand in python/cscd/_prototypes.py. */
#pragma GCC diagnostic ignored "-Wmissing-prototypes"

/* ---- functions of Python ------------------------------------------------------------------------------- */

/* The functions of Python's stable ABI that this layer calls. Python hands their addresses over when it loads the layer, so
 * nothing here needs its headers, and one library fits every version. */
typedef struct interpreter {
    void *(*save_thread)(void);                             /* PyEval_SaveThread */
    void (*restore_thread)(void *state);                    /* PyEval_RestoreThread */
    int (*check_signals)(void);                             /* PyErr_CheckSignals */
    void *(*call)(void *callable, const char *format, ...); /* PyObject_CallFunction */
    int (*is_true)(void *object);                           /* PyObject_IsTrue */
    void (*release)(void *object);                          /* Py_DecRef */
    void *(*new_capsule)(void *pointer, const char *name, void (*destroy)(void *capsule)); /* PyCapsule_New */
    void *(*capsule_pointer)(void *capsule, const char *name); /* PyCapsule_GetPointer */
} interpreter;

/* The functions that were handed over; all NULL before. */
extern interpreter python;

/* ---- contexts ------------------------------------------------------------------------------------------ */

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
