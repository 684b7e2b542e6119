/* Objects that go when Python lets go of them. A capsule keeps each one, and its destructor is in C: between the lines of a
 * __del__ Python may handle a signal, and what the handler raises there, as Ctrl-C does, would be lost. */
#include "python/native/exports.h"
#include "python/native/host.h"
#include "python/native/interpreter.h"

#include <stdlib.h>

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
