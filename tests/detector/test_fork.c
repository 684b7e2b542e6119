/* A process that forks: the child goes on with a copy of every object, alone, because threads stay in the parent. */
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { REPEATS = 12, THREADS_MAX = 4, SECONDS = 60 };

/* In the child: the same contacts, and nothing hangs or crashes when all is given back. */
static int work_alone(rig *r, const scene *s, const cscd_contact *wanted, size_t count) {
    alarm(SECONDS);
    const cscd_contacts found = rig_step(r, s);
    const bool same = found.count == count && memcmp(found.items, wanted, count * sizeof *wanted) == 0;
    rig_destroy(r);
    return same ? 0 : 1;
}

/* Helpers still look for work, or sleep already. */
static void wait_a_little(int repeat) {
    if (repeat % 3 > 0) usleep((useconds_t)(repeat % 3) * 200);
}

TEST(children_work_alone) {
    static scene s;
    for (int i = 0; i < PACED(REPEATS, 4); i++) {
        scene_make(SCENE_SOUP, (uint64_t)i, &s);
        rig r = rig_create(&s, 1 + (uint32_t)i % THREADS_MAX, NULL);
        const cscd_contacts found = rig_step(&r, &s);
        cscd_contact *wanted = malloc(found.count * sizeof *wanted);
        assert_true(wanted != NULL && found.count > 0);
        memcpy(wanted, found.items, found.count * sizeof *wanted);
        wait_a_little(i);
        const pid_t child = fork();
        if (child == 0) _exit(work_alone(&r, &s, wanted, found.count));
        int outcome = 1;
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
        assert_int_equal(rig_step(&r, &s).count, found.count); /* the parent's threads are there */
        free(wanted);
        rig_destroy(&r);
    }
}

/* ---- in the midst of calls ----------------------------------------------------------------------------- */

typedef struct busy_rig {
    rig r;
    scene s;
    atomic_bool ends;
} busy_rig;

static void *step_on(void *data) {
    busy_rig *b = data;
    while (!atomic_load(&b->ends)) {
        cscd_contacts found;
        cscd_detector_step(b->r.detector, CSCD_DOUBLES(b->s.x0, b->s.vertex_count),
                           CSCD_DOUBLES(b->s.x1, b->s.vertex_count), &found);
    }
    return NULL;
}

/* In the child: what may be busy is given back, and a new rig with threads works. */
static int work_anew(busy_rig *b) {
    alarm(SECONDS);
    rig_destroy(&b->r);
    rig fresh = rig_create(&b->s, 2, NULL);
    const bool found = rig_step(&fresh, &b->s).count > 0;
    rig_destroy(&fresh);
    return found ? 0 : 1;
}

TEST(children_let_go_of_what_is_busy) {
    static busy_rig b;
    pthread_t thread;
    scene_make(SCENE_SOUP, 1, &b.s);
    b.r = rig_create(&b.s, 2, NULL);
    assert_int_equal(pthread_create(&thread, NULL, step_on, &b), 0);
    for (int i = 0; i < PACED(REPEATS, 4); i++) {
        wait_a_little(i);
        const pid_t child = fork();
        if (child == 0) _exit(work_anew(&b));
        int outcome = 1;
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
    }
    atomic_store(&b.ends, true);
    pthread_join(thread, NULL);
    rig_destroy(&b.r);
}
