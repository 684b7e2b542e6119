/* One mesh for several contexts, on several threads at once: it never changes, each object works in its own context,
 * and the last one to let go gives the memory back. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { USERS = 4, STEPS = 4 };

static scene s;

/* ---- whose memory, whose sentence ---------------------------------------------------------------------- */

/* Objects allocate from their own context and fail into it; the mesh's context is left alone. */
TEST(objects_work_in_their_own_context) {
    counting_allocator of_home = counting_allocator_start(), of_guest = counting_allocator_start();
    scene_make(SCENE_TWO_SPHERES, 3, &s);
    cscd_context *home = context_of(1, &of_home), *guest = context_of(2, &of_guest);
    cscd_mesh *mesh = mesh_of_scene(home, &s);
    const size_t home_calls = of_home.calls;
    const cscd_view *x0 = CSCD_DOUBLES(s.x0, s.vertex_count), *x1 = CSCD_DOUBLES(s.x1, s.vertex_count);
    const cscd_view *too_short = CSCD_DOUBLES(s.x0, s.vertex_count - 1);
    cscd_plan_options by_kmeans = cscd_plan_defaults();
    by_kmeans.method = CSCD_METHOD_KMEANS;
    cscd_plan *plan;
    cscd_detector *detector;
    cscd_line_search *search;
    cscd_contacts contacts;
    expect_ok(cscd_plan_create(guest, mesh, x0, &by_kmeans, &plan));
    expect_ok(cscd_detector_create(guest, mesh, plan, NULL, &detector));
    assert_ptr_equal(cscd_detector_mesh(detector), mesh);
    assert_ptr_equal(cscd_mesh_context(cscd_detector_mesh(detector)), home);
    expect_ok(cscd_line_search_create(detector, &search));
    expect_ok(cscd_detector_step(detector, x0, x1, &contacts));
    expect_ok(cscd_line_search_begin(search, x0, x1, 0.1));
    expect_invalid(guest, cscd_detector_step(detector, x0, too_short, &contacts), "x1");
    assert_string_equal(cscd_context_detail(home), "");
    assert_int_equal(of_home.calls, home_calls);

    cscd_context_destroy(home);
    cscd_mesh_destroy(mesh);
    expect_ok(cscd_detector_step(detector, x0, x1, &contacts));
    assert_true(of_home.live > 0);
    cscd_plan_destroy(plan);
    cscd_detector_destroy(detector);
    assert_true(of_home.live > 0);
    cscd_line_search_destroy(search);
    assert_int_equal(of_home.live, 0);
    cscd_context_destroy(guest);
    assert_int_equal(of_guest.live, 0);
}

/* ---- several threads ----------------------------------------------------------------------------------- */

typedef struct mesh_user {
    pthread_t thread;
    pthread_barrier_t *all_made;
    const cscd_mesh *mesh;
    uint32_t thread_count;
    size_t contacts; /* of all steps */
    uint64_t digest; /* of what the mesh says of itself */
    bool failed;
} mesh_user;

/* Asks everything that a mesh can be asked. */
static uint64_t digest_of_mesh(const cscd_mesh *mesh) {
    uint64_t digest = cscd_mesh_hash(mesh);
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        uint32_t corners[3], edges[3], ends[2], count;
        cscd_mesh_triangle(mesh, t, corners);
        cscd_mesh_triangle_edges(mesh, t, edges);
        cscd_mesh_edge(mesh, edges[0], ends);
        const uint32_t *star = cscd_mesh_vertex_triangles(mesh, corners[1], &count);
        digest = digest * 31 + corners[2] + ends[1] + star[count - 1];
        star = cscd_mesh_edge_triangles(mesh, edges[2], &count);
        cscd_component component = cscd_mesh_component(mesh, cscd_mesh_triangle_component(mesh, t));
        cscd_object object = cscd_mesh_object(mesh, cscd_mesh_vertex_object(mesh, corners[0]));
        cscd_stencil stencil = cscd_mesh_stencil(mesh, CSCD_CONTACT_VF, corners[0], t, 0.25, 0.5);
        digest += star[0] + component.edge_count + object.edge_count + stencil.vertices[3];
    }
    return digest + cscd_mesh_edge_count(mesh) + cscd_mesh_component_count(mesh);
}

static void take_steps(mesh_user *u, cscd_detector *detector) {
    const cscd_view *x0 = CSCD_DOUBLES(s.x0, s.vertex_count), *x1 = CSCD_DOUBLES(s.x1, s.vertex_count);
    for (int i = 0; i < STEPS; i++) {
        cscd_contacts found;
        u->failed |= cscd_detector_step(detector, x0, x1, &found) != CSCD_OK;
        u->contacts += u->failed ? 0 : found.count;
    }
    u->digest = digest_of_mesh(cscd_detector_mesh(detector));
}

/* Works with a detector, a context and a plan of its own on the mesh, whose creator has let go of it meanwhile. */
static void *use_mesh(void *argument) {
    mesh_user *u = argument;
    cscd_context *context = NULL;
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_context_options options = cscd_context_defaults();
    cscd_plan_options by_single = cscd_plan_defaults();
    options.thread_count = u->thread_count;
    by_single.method = CSCD_METHOD_SINGLE;
    u->failed = cscd_context_create(&options, &context) != CSCD_OK ||
                cscd_plan_create(context, u->mesh, CSCD_DOUBLES(s.x0, s.vertex_count), &by_single, &plan) !=
                    CSCD_OK ||
                cscd_detector_create(context, u->mesh, plan, NULL, &detector) != CSCD_OK;
    pthread_barrier_wait(u->all_made);
    cscd_plan_destroy(plan);
    cscd_context_destroy(context);
    if (!u->failed) take_steps(u, detector);
    cscd_detector_destroy(detector);
    return NULL;
}

static void compare_users(const mesh_user users[USERS]) {
    for (int i = 0; i < USERS; i++) {
        assert_false(users[i].failed);
        assert_int_equal(users[i].contacts, users[0].contacts);
        assert_int_equal(users[i].digest, users[0].digest);
    }
}

/* The creator of the mesh works in its own context while others use the mesh, and lets go of all that it has. */
static size_t share_once(scene_family family) {
    mesh_user users[USERS];
    counting_allocator counter = counting_allocator_start();
    pthread_barrier_t all_made;
    scene_make(family, 5, &s);
    cscd_context *home = context_of(2, &counter);
    cscd_mesh *mesh = mesh_of_scene(home, &s);
    cscd_detector *detector = NULL;
    expect_ok(cscd_detector_create(home, mesh, NULL, NULL, &detector));
    assert_int_equal(pthread_barrier_init(&all_made, NULL, USERS + 1), 0);
    for (int i = 0; i < USERS; i++) {
        users[i] = (mesh_user){.all_made = &all_made, .mesh = mesh, .thread_count = 1 + (uint32_t)i % 2};
        assert_int_equal(pthread_create(&users[i].thread, NULL, use_mesh, &users[i]), 0);
    }
    pthread_barrier_wait(&all_made);
    cscd_mesh_destroy(mesh);
    mesh_user creator = {.failed = false};
    take_steps(&creator, detector);
    assert_true(cscd_context_describe(home).bytes > 0);
    cscd_context_destroy(home);
    cscd_detector_destroy(detector);
    for (int i = 0; i < USERS; i++) assert_int_equal(pthread_join(users[i].thread, NULL), 0);
    pthread_barrier_destroy(&all_made);
    compare_users(users);
    assert_int_equal(creator.contacts, users[0].contacts);
    assert_int_equal(counter.live, 0);
    assert_int_equal(counter.bytes, 0);
    return creator.contacts;
}

TEST(many_threads_use_one_mesh) {
    size_t contacts = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) contacts += share_once((scene_family)family);
    print_message("  %zu contacts\n", contacts);
    assert_true(contacts > 100);
}
