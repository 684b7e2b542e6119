/* The objects of a context that are whole. Debug builds check all of them whenever a call enters the context, so that a
 * stray write, or a fault of ours, is found by the next call, and not by a wrong result much later. */
#pragma once

#include "src/core/references.h"

#include <pthread.h>

/* Threads that drop the last reference of a shared mesh take it from the list while another one is in a call. */
typedef struct live_objects {
    pthread_mutex_t mutex;
    reference_count *first;
} live_objects;

/* False: the system refused a mutex. */
bool live_objects_begin(live_objects *list);
void live_objects_end(live_objects *list);

/* Adds an object, once all of its parts are made. validate returns the first fault of an object as a sentence, or NULL;
 * it reads only what no other thread writes while the context is entered. */
void live_objects_add(live_objects *list, reference_count *object,
                      const char *(*validate)(const reference_count *object));

/* Takes an object from the list before it is freed; does nothing if it is not in it. */
void live_objects_remove(live_objects *list, reference_count *object);

/* The first fault of an object in the list, or NULL. */
const char *live_objects_fault(live_objects *list);
