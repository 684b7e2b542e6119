/* The scenes of the IPC solver, small: another detector finds no contact in any step, the energy falls,
 * links hold each other, and the motion is repeatable. */
#include "cscd/research.h"
#include "models/common/vec3.h"
#include "models/ipc/ipc.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* RING_TRIANGLES is the number of triangles of all rings. The other detectors check the lines of every
 * STRIDE-th time step. */
enum {
    RING_TRIANGLES = PACED(900, 480),
    RING_STEPS = PACED(90, 60),
    STRIDE = PACED(4, 25),
    REPEATED = PACED(30, 12)
};

/* The chain is taut after about 50 steps; the coil is compressed most after 75. */
static const struct extent {
    const char *name;
    uint32_t triangles, steps;
} extents[] = {{"rings", RING_TRIANGLES, RING_STEPS}, {"press", 1400, 75}};

enum { SCENE_COUNT = sizeof extents / sizeof *extents };

static cscd_context *open_context(uint32_t threads) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context;
    options.thread_count = threads;
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    return context;
}

static ipc_solver open_scene(const struct extent *e, cscd_context *context) {
    ipc_solver p;
    const ipc_scene *scene = ipc_scene_find(e->name);
    assert_non_null(scene);
    if (ipc_solver_make(scene, e->triangles, context, &p) != CSCD_OK)
        fail_msg("%s: %s", e->name, cscd_context_detail(context));
    return p;
}

/* Detectors other than the solver's: one without a line search, and one by brute force. */
typedef struct judges {
    cscd_detector *apart, *touching, *brute;
    uint32_t judged;
} judges;

static judges call_judges(const ipc_solver *p) {
    judges j = {.judged = 0};
    cscd_detector_options options = cscd_detector_defaults();
    assert_int_equal(detector_create_here(p->mesh, NULL, &options, &j.touching), CSCD_OK);
    options.method = CSCD_METHOD_BRUTE;
    assert_int_equal(detector_create_here(p->mesh, NULL, &options, &j.brute), CSCD_OK);
    options.method = CSCD_METHOD_NONE;
    options.min_separation = p->scene->min_separation;
    assert_int_equal(detector_create_here(p->mesh, NULL, &options, &j.apart), CSCD_OK);
    return j;
}

static void dismiss_judges(judges *j) {
    cscd_detector_destroy(j->apart);
    cscd_detector_destroy(j->touching);
    cscd_detector_destroy(j->brute);
}

static void expect_none(cscd_detector *detector, const double *from, const double *to) {
    cscd_contacts contacts;
    assert_int_equal(step_packed(detector, from, to, &contacts), CSCD_OK);
    if (contacts.count > 0)
        fail_msg("%zu contacts, the first %s %u %u at %g", contacts.count,
                 cscd_contact_kind_name(contacts.items[0].kind), contacts.items[0].a, contacts.items[0].b,
                 contacts.items[0].toi);
}

/* Checks that there is no contact on the way, no pair nearer than allowed, and no intersection at the end. */
static void judge_interval(judges *j, const double *from, const double *to) {
    cscd_intersections intersections;
    expect_none(j->touching, from, to);
    expect_none(j->apart, from, to);
    if (j->judged++ % 40 == 0) expect_none(j->brute, from, to);
    assert_int_equal(check_packed(j->touching, to, &intersections), CSCD_OK);
    assert_int_equal(intersections.count, 0);
}

/* Checks that the solver's energy is that of its positions and of the items that are near at these
 * positions, and that the energy of all pairs is the same. */
static void check_energy(const ipc_solver *p, cscd_detector *detector) {
    cscd_proximities near;
    cscd_energy_sum contacts, pairs;
    assert_int_equal(set_rest_packed(detector, p->shape.positions), CSCD_OK);
    assert_int_equal(find_unique_packed(detector, p->positions, p->scene->barrier.reach, &near), CSCD_OK);
    assert_int_equal(ipc_solver_barrier(p, p->positions, &near, NULL, &contacts), CSCD_OK);
    assert_int_equal(near.count, p->near.count);
    assert_true(contacts.least == p->contacts.least);
    assert_true(contacts.least > p->scene->min_separation);
    assert_true(ipc_solver_energy(p, p->positions, &contacts) == p->energy);
    assert_int_equal(find_near_packed(detector, p->positions, p->scene->barrier.reach, &near), CSCD_OK);
    assert_int_equal(ipc_solver_barrier(p, p->positions, &near, NULL, &pairs), CSCD_OK);
    assert_true(near.count >= p->near.count);
    assert_true(fabs(pairs.value - contacts.value) <= 1e-12 * contacts.value);
}

/* Takes one time step and checks its line searches. */
static void step_and_judge(ipc_solver *p, judges *j, double *from) {
    bool done = false;
    ipc_solver_begin_step(p);
    for (int i = 0; !done; i++) {
        double energy = p->energy;
        assert_true(i < 60);
        memcpy(from, p->positions, (size_t)p->shape.vertex_count * 3 * sizeof *from);
        assert_int_equal(ipc_solver_iterate(p, &done), CSCD_OK);
        judge_interval(j, from, p->positions);
        if (p->arrived) assert_true(p->energy < energy);
        if (i == 0) check_energy(p, j->touching);
    }
    ipc_solver_end_step(p);
}

static ipc_solver run_and_judge(const struct extent *e, cscd_context *context) {
    ipc_solver p = open_scene(e, context);
    judges j = call_judges(&p);
    double *from = body_allocate(p.shape.vertex_count, 3 * sizeof *from);
    for (uint32_t step = 0; step < e->steps; step++) {
        if (step % STRIDE == 0)
            step_and_judge(&p, &j, from);
        else
            assert_int_equal(ipc_solver_advance(&p), CSCD_OK);
    }
    assert_int_equal(p.statistics.steps, e->steps);
    assert_int_equal(p.statistics.unfinished, 0);
    assert_true(p.statistics.newton >= e->steps && p.statistics.trials >= p.statistics.newton);
    assert_true(p.statistics.cut > 0 && p.statistics.candidates > 0 && p.statistics.near > 0);
    assert_true(p.statistics.least_distance > p.scene->min_separation);
    free(from);
    dismiss_judges(&j);
    return p;
}

static void mean_of(const ipc_solver *p, uint32_t object, double out[3]) {
    cscd_object o = cscd_mesh_object(p->mesh, object);
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t v = 0; v < o.vertex_count; v++)
        vec3_add_scaled(out, 1.0 / o.vertex_count, p->positions + (size_t)(o.first_vertex + v) * 3);
}

/* Without contact the links would be 11 below the first by then. Two linked rings are at most two inner
 * radii of 0.78 apart, or somewhat more when they are stretched. */
TEST(links_bear_each_other) {
    cscd_context *context = open_context(1);
    ipc_solver p = run_and_judge(&extents[0], context);
    double above[3], below[3], between[3];
    uint32_t count = cscd_mesh_object_count(p.mesh), loaded = 0;
    mean_of(&p, 0, above);
    assert_true(fabs(above[0]) < 1e-6 && fabs(above[2]) < 1e-6); /* the first link has not moved */
    for (uint32_t i = 1; i < count; i++) {
        mean_of(&p, i, below);
        vec3_subtract(below, above, between);
        assert_true(vec3_norm(between) > 0.5 && vec3_norm(between) < 2.1);
        for (size_t c = 0; c < p.near.count; c++) {
            uint32_t a = cscd_mesh_vertex_object(p.mesh, p.near.items[c].vertices[0]);
            uint32_t b = cscd_mesh_vertex_object(p.mesh, p.near.items[c].vertices[3]);
            if ((a == i && b == i - 1) || (b == i && a == i - 1)) {
                loaded++;
                break;
            }
        }
        memcpy(above, below, sizeof above);
    }
    assert_true(above[2] < -3.0); /* it hangs */
    assert_true(loaded >= 3);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
}

/* Half way, the upper plate has arrived, and the coil has contacts with the plates and itself. */
TEST(the_press_arrives_and_the_coil_gives_way) {
    cscd_context *context = open_context(1);
    ipc_solver p = run_and_judge(&extents[1], context);
    cscd_object coil = cscd_mesh_object(p.mesh, 0), plate = cscd_mesh_object(p.mesh, 2);
    double share = ipc_scene_travelled(p.scene, p.time), low = INFINITY, lowest = INFINITY,
           highest = -INFINITY;
    assert_true(plate.obstacle && !coil.obstacle);
    for (uint32_t v = 0; v < plate.vertex_count; v++) {
        uint32_t z = (plate.first_vertex + v) * 3 + 2;
        assert_true(fabs(p.positions[z] - p.shape.positions[z] - share * p.travels[z]) < 1e-12);
        low = fmin(low, p.positions[z]);
    }
    for (uint32_t v = 0; v < coil.vertex_count; v++) {
        lowest = fmin(lowest, p.positions[v * 3 + 2]);
        highest = fmax(highest, p.positions[v * 3 + 2]);
    }
    assert_true(highest < low && low - highest < 2.0 * p.scene->barrier.reach);
    assert_true(highest - lowest < 2.6); /* 3.9 at rest */
    uint32_t own = 0;
    for (size_t c = 0; c < p.near.count; c++)
        own += p.near.items[c].vertices[0] < coil.vertex_count &&
               p.near.items[c].vertices[3] < coil.vertex_count;
    assert_true(own > 0);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
}

/* Vertices fly apart in all directions, so fast that whole Newton steps go too far. */
TEST(the_energy_falls_however_wild_the_motion) {
    cscd_context *context = open_context(1);
    ipc_solver p = open_scene(&extents[1], context);
    judges j = call_judges(&p);
    random_stream random = stream_start(7);
    double *from = body_allocate(p.shape.vertex_count, 3 * sizeof *from);
    for (uint32_t i = 0; i < p.shape.vertex_count * 3; i++)
        p.velocities[i] = p.inertia[i / 3] > 0.0 ? stream_between(&random, -60.0, 60.0) : 0.0;
    for (int step = 0; step < 2; step++) step_and_judge(&p, &j, from);
    assert_true(p.statistics.trials > p.statistics.newton && p.statistics.cut > 0);
    free(from);
    dismiss_judges(&j);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
}

static double *positions_after(const struct extent *e, uint32_t threads, size_t *size) {
    cscd_context *context = open_context(threads);
    ipc_solver p = open_scene(e, context);
    for (uint32_t i = 0; i < REPEATED; i++) assert_int_equal(ipc_solver_advance(&p), CSCD_OK);
    *size = (size_t)p.shape.vertex_count * 3 * sizeof(double);
    double *out = memcpy(body_allocate(*size, 1), p.positions, *size);
    assert_true(p.statistics.detect_ms > 0.0 && p.statistics.total_ms > p.statistics.detect_ms);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
    return out;
}

TEST(motion_is_the_same_for_any_number_of_threads) {
    for (int i = 0; i < SCENE_COUNT; i++) {
        size_t size, again_size;
        double *once = positions_after(&extents[i], 1, &size),
               *again = positions_after(&extents[i], 3, &again_size);
        assert_int_equal(size, again_size);
        assert_memory_equal(once, again, size);
        free(once);
        free(again);
    }
}

/* Frame 0 is in single precision, without intersections and without pairs nearer than the least distance. */
TEST(scenes_begin_apart) {
    cscd_context *context = open_context(1);
    assert_int_equal(ipc_scene_count, SCENE_COUNT);
    assert_null(ipc_scene_find("ring"));
    for (uint32_t i = 0; i < ipc_scene_count; i++) {
        assert_string_equal(ipc_scenes[i].name, extents[i].name);
        struct extent full = {.name = extents[i].name};
        ipc_solver p = open_scene(&full, context);
        judges j = call_judges(&p);
        assert_true(p.shape.triangle_count > 3000 && p.springs.count > p.shape.vertex_count);
        for (uint32_t k = 0; k < p.shape.vertex_count * 3; k++) {
            volatile float rounded = (float)p.shape.positions[k];
            assert_true((double)rounded == p.shape.positions[k] && p.positions[k] == p.shape.positions[k]);
        }
        judge_interval(&j, p.positions, p.positions);
        for (uint32_t c = 0; c < cscd_mesh_component_count(p.mesh); c++)
            assert_true(cscd_mesh_component(p.mesh, c).closed_manifold);
        dismiss_judges(&j);
        ipc_solver_free(&p);
    }
    cscd_context_destroy(context);
}

TEST(obstacles_travel_there_and_back) {
    const ipc_scene *s = ipc_scene_find("press");
    double last = 0.0;
    assert_true(ipc_scene_travelled(s, 0.0) == 0.0 && ipc_scene_travelled(s, s->travel_seconds / 2.0) == 1.0);
    for (int i = 1; i <= 50; i++) {
        double share = ipc_scene_travelled(s, s->travel_seconds * i / 100.0);
        assert_true(share > last &&
                    fabs(share - ipc_scene_travelled(s, s->travel_seconds * (100 - i) / 100.0)) < 1e-9);
        last = share;
    }
}
