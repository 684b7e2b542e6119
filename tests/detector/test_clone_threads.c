/* Clones of one detector in contexts of their own, each on a thread of its own at the same time; the scenes have triangles,
 * wires, points and half-spaces, and the contexts several threads. */
#include "cscd/cscd.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <string.h>

enum { USERS = 3, SCENES = 6, STEPS = 2 };

static loose_scene scene;

/* What one thread does with its clone, and what it found. */
typedef struct clone_user {
    pthread_t thread;
    pthread_barrier_t *all_made;
    const cscd_detector *first;
    uint32_t thread_count;
    uint64_t digest;
    size_t found; /* contacts and near pairs */
    bool failed;
} clone_user;

static void add_bytes(clone_user *u, const void *items, size_t size) {
    const unsigned char *bytes = items;
    for (size_t i = 0; i < size; i++) u->digest = (u->digest ^ bytes[i]) * 0x100000001b3u;
}

static void find_all(clone_user *u, cscd_detector *detector) {
    const cscd_view *x0 = CSCD_DOUBLES(scene.x0, scene.vertex_count);
    const cscd_view *x1 = CSCD_DOUBLES(scene.x1, scene.vertex_count);
    for (int i = 0; i < STEPS && !u->failed; i++) {
        cscd_contacts contacts;
        cscd_proximities near;
        cscd_free_step step;
        u->failed |= cscd_detector_step(detector, x0, x1, &contacts) != CSCD_OK;
        if (u->failed) return;
        add_bytes(u, contacts.items, contacts.count * sizeof *contacts.items);
        u->found += contacts.count;
        u->failed |= cscd_detector_find_near(detector, x1, 0.1, CSCD_NEAR_UNIQUE, &near) != CSCD_OK;
        if (u->failed) return;
        add_bytes(u, near.items, near.count * sizeof *near.items);
        u->found += near.count;
        cscd_status status = cscd_detector_max_step(detector, x0, x1, NULL, &step);
        u->failed |= status != CSCD_OK && status != CSCD_IN_CONTACT;
        add_bytes(u, &step.fraction, sizeof step.fraction);
    }
}

/* All clone in the beginning, one after the other: a detector is used by one thread at a time. */
static void *use_clone(void *argument) {
    clone_user *u = argument;
    static pthread_mutex_t cloning = PTHREAD_MUTEX_INITIALIZER;
    cscd_context *context = NULL;
    cscd_detector *clone = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = u->thread_count;
    pthread_mutex_lock(&cloning);
    u->failed = cscd_context_create(&options, &context) != CSCD_OK ||
                cscd_detector_clone(context, u->first, &clone) != CSCD_OK;
    pthread_mutex_unlock(&cloning);
    pthread_barrier_wait(u->all_made);
    if (!u->failed) find_all(u, clone);
    cscd_detector_destroy(clone);
    cscd_context_destroy(context);
    return NULL;
}

/* The first detector works on, on its own thread, as its clones do on theirs; all find the same. */
static size_t use_at_once(cscd_detector *detector) {
    clone_user users[USERS], creator = {.first = detector};
    pthread_barrier_t all_made;
    assert_int_equal(pthread_barrier_init(&all_made, NULL, USERS + 1), 0);
    for (int i = 0; i < USERS; i++) {
        users[i] = (clone_user){.all_made = &all_made, .first = detector, .thread_count = 1 + (uint32_t)i};
        assert_int_equal(pthread_create(&users[i].thread, NULL, use_clone, &users[i]), 0);
    }
    pthread_barrier_wait(&all_made);
    find_all(&creator, detector);
    for (int i = 0; i < USERS; i++) assert_int_equal(pthread_join(users[i].thread, NULL), 0);
    pthread_barrier_destroy(&all_made);
    assert_false(creator.failed);
    for (int i = 0; i < USERS; i++) {
        assert_false(users[i].failed);
        assert_int_equal(users[i].found, creator.found);
        assert_int_equal(users[i].digest, creator.digest);
    }
    return creator.found;
}

TEST(clones_work_at_the_same_time) {
    size_t found = 0;
    for (uint64_t seed = 0; seed < SCENES; seed++) {
        random_stream random = stream_start(seed);
        const loose_recipe recipe = {.triangles = true,
                                     .wires = true,
                                     .points = true,
                                     .half_spaces = true,
                                     .rules = seed % 3 == 1,
                                     .thickness = seed % 2 == 0,
                                     .motion = 0.5};
        loose_scene_make(&scene, &recipe, &random, 2, CSCD_SIMD_AUTO);
        cscd_detector_options options = loose_scene_options(&scene);
        options.method = seed % 2 == 0 ? CSCD_METHOD_SINGLE : CSCD_METHOD_NONE;
        cscd_detector *detector = loose_scene_detector(&scene, &options);
        found += use_at_once(detector);
        cscd_detector_destroy(detector);
        loose_scene_free(&scene);
    }
    print_message("  %zu contacts and near pairs\n", found);
    assert_true(found > 300);
}
