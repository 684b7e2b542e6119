/* Reads the frames of a recording on a thread of its own, one ahead of those that are asked for. */
#include "tool/replay/replay_source.h"

#include "tool/io/io.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct read_ahead {
    recording *recording;
    uint32_t next, last; /* frames that the thread has still to read */
    pthread_t thread;
    bool runs; /* else frames are read when they are asked for */

    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t changed;
    bool full, quits;
    bool good; /* what was read is a frame, else an error */
    double *positions;
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1];
    io_error error;
};

/* While this frame is parsed, the disk brings the next one. */
static void read_next(read_ahead *a) {
    if (a->next < a->last) recording_expect(a->recording, a->next + 1);
    a->good = recording_read(a->recording, a->next++, a->positions, &a->error);
    if (a->good) recording_hash_frame(a->recording, a->hashes);
}

/* While a frame is read the lock is free, and `full` says whose the place is: the thread's while it is
 * false. */
static void *read_on(void *user) {
    read_ahead *a = user;
    pthread_mutex_lock(&a->lock);
    while (!a->quits && a->next <= a->last) {
        pthread_mutex_unlock(&a->lock);
        read_next(a);
        pthread_mutex_lock(&a->lock);
        a->full = true;
        pthread_cond_broadcast(&a->changed);
        while (a->full && !a->quits) pthread_cond_wait(&a->changed, &a->lock);
    }
    pthread_mutex_unlock(&a->lock);
    return NULL;
}

bool read_ahead_open(recording *r, uint32_t first, uint32_t last, read_ahead **out, io_error *error) {
    read_ahead *a = io_zeroed(sizeof *a);
    *out = NULL;
    if (a != NULL)
        a->positions = io_zeroed(((size_t)cscd_mesh_vertex_count(r->mesh) + 1) * 3 * sizeof *a->positions);
    if (a == NULL || a->positions == NULL) {
        free(a);
        return io_fail(error, "out of memory");
    }
    a->recording = r;
    a->next = first;
    a->last = last;
    pthread_mutex_init(&a->lock, NULL);
    pthread_cond_init(&a->changed, NULL);
    a->runs = pthread_create(&a->thread, NULL, read_on, a) == 0;
    *out = a;
    return true;
}

void read_ahead_close(read_ahead *a) {
    if (a == NULL) return;
    if (a->runs) {
        pthread_mutex_lock(&a->lock);
        a->quits = true;
        pthread_cond_broadcast(&a->changed);
        pthread_mutex_unlock(&a->lock);
        pthread_join(a->thread, NULL);
    }
    pthread_cond_destroy(&a->changed);
    pthread_mutex_destroy(&a->lock);
    free(a->positions);
    free(a);
}

static bool hand_over(read_ahead *a, double **positions, uint64_t hashes[RECORDING_OBJECTS_MAX + 1],
                      io_error *error) {
    double *taken = a->positions;
    if (!a->good) return io_fail(error, "%s", a->error.text);
    a->positions = *positions;
    *positions = taken;
    memcpy(hashes, a->hashes, sizeof a->hashes);
    return true;
}

bool read_ahead_take(read_ahead *a, double **positions, uint64_t hashes[RECORDING_OBJECTS_MAX + 1],
                     io_error *error) {
    if (!a->runs) {
        read_next(a);
        return hand_over(a, positions, hashes, error);
    }
    pthread_mutex_lock(&a->lock);
    while (!a->full) pthread_cond_wait(&a->changed, &a->lock);
    const bool good = hand_over(a, positions, hashes, error);
    a->full = false;
    pthread_cond_broadcast(&a->changed);
    pthread_mutex_unlock(&a->lock);
    return good;
}
