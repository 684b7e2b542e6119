/* The functions of Python's stable ABI that this layer calls. Python hands their addresses over when it loads the
 * layer, so nothing here needs its headers, and one library fits every version. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

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

/* What was handed over; all NULL before. */
extern interpreter python;

/* functions: the addresses of all members, in their order. False: it is another number of them. */
bool cscdpy_set_interpreter(void *const *functions, size_t count);
