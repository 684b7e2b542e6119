/* Changes of meshes: orders of destruction, readers in other threads. */
#include "tests/support/changing_mesh.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdatomic.h>

static changing_scene changing;
static scene_change change;

/* The change keeps both meshes, and each of the three contexts lives as long as it is needed. */
TEST(any_order_of_destruction) {
    random_stream random = stream_start(4);
    for (int order = 0; order < 6; order++) {
        counting_allocator counters[2] = {counting_allocator_start(), counting_allocator_start()};
        cscd_context *contexts[2] = {context_of(0, &counters[0]), context_of(0, &counters[1])};
        changing_scene_make(&random, false, &changing);
        cscd_mesh *old = changing_scene_mesh(contexts[0], &changing);
        changing_scene_change(&random, &changing, &change);
        cscd_mesh_change *made = NULL;
        assert_int_equal(cscd_mesh_change_create(contexts[1], old, change.list, change.count, &made),
                         CSCD_OK);
        assert_ptr_equal(cscd_mesh_context(cscd_mesh_change_mesh(made)), contexts[1]);
        cscd_detector *detector = NULL;
        assert_int_equal(
            cscd_detector_create(contexts[order % 2], cscd_mesh_change_mesh(made), NULL, NULL, &detector),
            CSCD_OK);
        for (int i = 0; i < 5; i++) {
            int what = (i * (order < 3 ? 1 : 2) + order) % 5;
            if (what == 0) cscd_mesh_destroy(old);
            if (what == 1) cscd_context_destroy(contexts[0]);
            if (what == 2) cscd_context_destroy(contexts[1]);
            if (what == 3) cscd_mesh_change_destroy(made);
            if (what == 4) {
                cscd_mesh *expected =
                    changing_scene_mesh(cscd_mesh_context(cscd_detector_mesh(detector)), &changing);
                check_same_mesh(cscd_detector_mesh(detector), expected);
                cscd_mesh_destroy(expected);
                cscd_detector_destroy(detector);
            }
        }
        assert_int_equal(counters[0].live + counters[1].live, 0);
    }
}

typedef struct mesh_reader {
    const cscd_mesh *mesh;
    atomic_bool stop;
    uint64_t hash;
} mesh_reader;

static void *read_mesh(void *data) {
    mesh_reader *r = data;
    while (!atomic_load(&r->stop)) {
        if (cscd_mesh_hash(r->mesh) != r->hash) return r;
        for (uint32_t v = 0; v < cscd_mesh_vertex_count(r->mesh); v++) {
            uint32_t count;
            cscd_mesh_vertex_triangles(r->mesh, v, &count);
            if (cscd_mesh_vertex_object(r->mesh, v) >= cscd_mesh_object_count(r->mesh)) return r;
        }
    }
    return NULL;
}

/* Both meshes are read from other threads while the next one is made. */
TEST(read_by_other_threads) {
    random_stream random = stream_start(5);
    counting_allocator counter = counting_allocator_start();
    cscd_context *context = context_of(0, &counter);
    changing_scene_make(&random, true, &changing);
    cscd_mesh *first = changing_scene_mesh(context, &changing);
    cscd_mesh_change *changes[20];
    mesh_reader readers[20];
    pthread_t threads[20];
    const cscd_mesh *old = first;
    for (int i = 0; i < 20; i++) {
        readers[i].mesh = old;
        readers[i].hash = cscd_mesh_hash(old);
        atomic_init(&readers[i].stop, false);
        assert_int_equal(pthread_create(&threads[i], NULL, read_mesh, &readers[i]), 0);
        changing_scene_change(&random, &changing, &change);
        assert_int_equal(cscd_mesh_change_create(context, old, change.list, change.count, &changes[i]),
                         CSCD_OK);
        old = cscd_mesh_change_mesh(changes[i]);
    }
    for (int i = 0; i < 20; i++) {
        void *wrong = NULL;
        atomic_store(&readers[i].stop, true);
        assert_int_equal(pthread_join(threads[i], &wrong), 0);
        assert_null(wrong);
        cscd_mesh_change_destroy(changes[i]);
    }
    cscd_mesh_destroy(first);
    cscd_context_destroy(context);
    assert_int_equal(counter.live, 0);
}
