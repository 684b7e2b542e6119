/* The objects of a context that are whole: see live_objects.h. */
#include "src/core/live_objects.h"

#include <stddef.h>

bool live_objects_begin(live_objects *list) {
    list->first = NULL;
    return pthread_mutex_init(&list->mutex, NULL) == 0;
}

void live_objects_end(live_objects *list) {
    pthread_mutex_destroy(&list->mutex);
}

void live_objects_add(live_objects *list, reference_count *object,
                      const char *(*validate)(const reference_count *object)) {
    pthread_mutex_lock(&list->mutex);
    object->validate = validate;
    object->older = list->first;
    object->younger = NULL;
    if (list->first != NULL) list->first->younger = object;
    list->first = object;
    pthread_mutex_unlock(&list->mutex);
}

void live_objects_remove(live_objects *list, reference_count *object) {
    pthread_mutex_lock(&list->mutex);
    if (object->validate != NULL) {
        if (object->older != NULL) object->older->younger = object->younger;
        if (object->younger != NULL) object->younger->older = object->older;
        if (list->first == object) list->first = object->older;
        object->validate = NULL;
    }
    pthread_mutex_unlock(&list->mutex);
}

const char *live_objects_fault(live_objects *list) {
    const char *fault = NULL;
    pthread_mutex_lock(&list->mutex);
    for (reference_count *o = list->first; fault == NULL && o != NULL; o = o->older)
        fault = o->alive == REFERENCE_ALIVE ? o->validate(o) : "an object was freed that is still in use";
    pthread_mutex_unlock(&list->mutex);
    return fault;
}
