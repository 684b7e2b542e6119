/* Contexts for Python: the lock, signals and callbacks during a call, and objects that go when Python lets go of them. */
#include "python/native/host.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

interpreter python;

/* functions: the addresses of all members, in their order. False: it is another number of them. */
PYTHON_API bool cscdpy_set_interpreter(void *const *functions, size_t count) {
    if (count * sizeof *functions != sizeof python) return false;
    memcpy(&python, functions, sizeof python);
    return true;
}

/* Copies what a list of the library has into an array of Python's. */
PYTHON_API void cscdpy_copy(void *to, const void *from, size_t size) {
    if (size > 0) memcpy(to, from, size);
}

/* ---- contexts ------------------------------------------------------------------------------------------ */

/* Callbacks and signals have their turn once in this number of milliseconds. */
enum { LOOK_EVERY_MS = 5 };

static double clock_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

bool host_begin(host *h) {
    if (h->thread != NULL) return false;
    h->raised = false;
    h->looked_ms = 0.0;
    h->thread = python.save_thread();
    return true;
}

void host_end(host *h) {
    void *thread = h->thread;
    h->thread = NULL;
    python.restore_thread(thread);
}

/* Returns the answer of a callable; -1: it has raised. Takes the result. */
static int answer_of(void *result) {
    if (result == NULL) return -1;
    int answer = python.is_true(result);
    python.release(result);
    return answer;
}

/* The callback of the context. The result of progress= does not matter: a function that wants to end the call
 * raises. */
static bool report_progress(void *user, const char *stage, double fraction) {
    host *h = user;
    if (h->thread == NULL) return true;
    if (h->raised) return false;
    double now = clock_ms();
    if (now - h->looked_ms < LOOK_EVERY_MS) return true;
    h->looked_ms = now;
    python.restore_thread(h->thread);
    h->raised = python.check_signals() != 0;
    if (!h->raised && h->progress != NULL)
        h->raised = answer_of(python.call(h->progress, "sd", stage, fraction)) < 0;
    h->thread = python.save_thread();
    return !h->raised;
}

/* The function `ignore` of detectors; its user is a host. Returns true for all pairs once it has raised. */
PYTHON_API bool cscdpy_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    host *h = user;
    if (h->raised || h->thread == NULL) return true;
    python.restore_thread(h->thread);
    int answer = answer_of(python.call(h->ignore, "sII", cscd_contact_kind_name(kind), a, b));
    h->raised = answer < 0;
    h->thread = python.save_thread();
    if (h->raised) cscd_context_cancel(h->context);
    return answer != 0;
}

PYTHON_API cscd_status cscdpy_host_create(uint32_t thread_count, uint32_t simd, void *progress, void *ignore,
                                          char *reason, size_t reason_size, host **out) {
    host *h = calloc(1, sizeof *h);
    if (h == NULL) return CSCD_OUT_OF_MEMORY;
    h->users = 1;
    h->progress = progress;
    h->ignore = ignore;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    options.simd = (cscd_simd)simd;
    options.progress = (cscd_progress){report_progress, h};
    options.reason = reason;
    options.reason_size = reason_size;
    cscd_status status = cscd_context_create(&options, &h->context);
    if (status != CSCD_OK) {
        free(h);
        return status;
    }
    *out = h;
    return CSCD_OK;
}

void host_release(host *h) {
    if (--h->users > 0 || h->lost) return;
    cscd_context_destroy(h->context);
    free(h);
}

PYTHON_API void cscdpy_host_release(host *h) {
    host_release(h);
}

/* In a child that has a copy of it, which is of no use there. */
PYTHON_API void cscdpy_host_lose(host *h) {
    h->lost = true;
}

PYTHON_API const char *cscdpy_host_detail(const host *h) {
    return cscd_context_detail(h->context);
}

PYTHON_API void cscdpy_host_cancel(const host *h) {
    cscd_context_cancel(h->context);
}

PYTHON_API size_t cscdpy_host_bytes(const host *h) {
    return cscd_context_describe(h->context).bytes;
}

PYTHON_API uint32_t cscdpy_host_thread_count(const host *h) {
    return cscd_context_describe(h->context).thread_count;
}

/* Is a call running? */
PYTHON_API bool cscdpy_host_is_busy(const host *h) {
    return h->thread != NULL;
}

/* ---- keepers ------------------------------------------------------------------------------------------- */

/* A capsule keeps an object that goes when Python lets go of it, and the capsule's destructor is in C: between the lines of a __del__
 * Python may handle a signal, and what the handler raises there, as Ctrl-C does, would be lost. */
static const char capsule_name[] = "cscd.keeper";

typedef struct keeper {
    void *object; /* NULL: none has been created */
    void (*destroy)(void *object);
    host *host; /* of the object's context, or NULL */
} keeper;

static void destroy_kept(void *capsule) {
    keeper *k = python.capsule_pointer(capsule, capsule_name);
    if (k->object != NULL && (k->host == NULL || !k->host->lost)) k->destroy(k->object);
    if (k->host != NULL) host_release(k->host);
    free(k);
}

/* A new capsule, which gives back by `destroy` what is at *place by then; h, or NULL, lives as long. NULL: no memory. */
PYTHON_API void *cscdpy_keep(host *h, void (*destroy)(void *object), void **place) {
    keeper *k = malloc(sizeof *k);
    if (k == NULL) return NULL;
    *k = (keeper){NULL, destroy, h};
    void *capsule = python.new_capsule(k, capsule_name, destroy_kept);
    if (capsule == NULL) {
        free(k);
        return NULL;
    }
    if (h != NULL) h->users++;
    *place = &k->object;
    return capsule;
}
