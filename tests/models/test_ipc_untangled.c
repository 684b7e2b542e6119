/* A start in which bodies cross: the IPC solver refuses it, as no step leads out, and runs from the positions that
 * untangling finds near it. */
#include "cscd/untangle.h"
#include "models/ipc/ipc.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TRIANGLES = 900, STEPS = 5, LINKS = 6, PUSHED = 3 };

static size_t count_pairs(const ipc_solver *p) {
    cscd_intersection_options options = cscd_intersection_defaults();
    cscd_intersections found;
    options.answer = CSCD_ANSWER_COUNT;
    assert_int_equal(cscd_detector_find_intersections(
                         p->detector, CSCD_DOUBLES(p->positions, p->shape.vertex_count), &options, &found),
                     CSCD_OK);
    return found.count;
}

/* The chain with a link moved along it, into its neighbour; to be freed. */
static double *tangled_chain(const ipc_solver *p) {
    const uint32_t n = p->shape.vertex_count, of_link = n / LINKS;
    double *x = malloc(n * sizeof(double[3]));
    assert_non_null(x);
    memcpy(x, p->positions, n * sizeof(double[3]));
    for (uint32_t v = PUSHED * of_link; v < (PUSHED + 1) * of_link; v++) x[3 * v] += 0.3;
    return x;
}

/* Obstacles stay. */
static void untangle_chain(const ipc_solver *p, double *x) {
    const uint32_t n = p->shape.vertex_count;
    cscd_untangle_options options = cscd_untangle_defaults();
    double *weights = malloc(n * sizeof *weights);
    cscd_untangled found;
    assert_non_null(weights);
    for (uint32_t v = 0; v < n; v++) weights[v] = p->inertia[v] > 0.0 ? 1.0 : (double)INFINITY;
    options.weights = weights;
    assert_int_equal(
        cscd_detector_untangle(p->detector, CSCD_DOUBLES(x, n), &options, CSCD_MUTABLE_DOUBLES(x, n), &found),
        CSCD_OK);
    free(weights);
    assert_true(found.clean && found.moved && found.pairs_before > 10);
}

TEST(a_start_that_crosses_is_refused_until_it_is_untangled) {
    const cscd_context_options defaults = cscd_context_defaults();
    const ipc_scene *scene = ipc_scene_find("rings");
    cscd_context *context;
    ipc_solver p;
    bool clean = true;
    assert_int_equal(cscd_context_create(&defaults, &context), CSCD_OK);
    assert_non_null(scene);
    assert_int_equal(ipc_solver_make(scene, TRIANGLES, context, &p), CSCD_OK);
    double *x = tangled_chain(&p);
    assert_int_equal(ipc_solver_start(&p, x, &clean), CSCD_OK);
    assert_false(clean);
    assert_int_equal(count_pairs(&p), 0); /* it is where it was */
    untangle_chain(&p, x);
    assert_int_equal(ipc_solver_start(&p, x, &clean), CSCD_OK);
    assert_true(clean);
    assert_memory_equal(p.positions, x, p.shape.vertex_count * sizeof(double[3]));
    for (int step = 0; step < STEPS; step++) {
        assert_int_equal(ipc_solver_advance(&p), CSCD_OK);
        assert_int_equal(count_pairs(&p), 0);
    }
    assert_int_equal(p.statistics.unfinished, 0);
    free(x);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
}

/* As IPC does by itself, if nobody refuses: the energy falls, and links that cross go on crossing. */
TEST(steps_do_not_lead_out_of_what_crosses) {
    const cscd_context_options defaults = cscd_context_defaults();
    cscd_context *context;
    ipc_solver p;
    assert_int_equal(cscd_context_create(&defaults, &context), CSCD_OK);
    assert_int_equal(ipc_solver_make(ipc_scene_find("rings"), TRIANGLES, context, &p), CSCD_OK);
    double *x = tangled_chain(&p);
    memcpy(p.positions, x, p.shape.vertex_count * sizeof(double[3]));
    assert_int_equal(cscd_detector_find_near(p.detector, CSCD_DOUBLES(p.positions, p.shape.vertex_count),
                                             p.scene->barrier.reach, CSCD_NEAR_UNIQUE, &p.near),
                     CSCD_OK);
    assert_int_equal(ipc_solver_barrier(&p, p.positions, &p.near, NULL, &p.contacts), CSCD_OK);
    for (int step = 0; step < STEPS; step++) {
        assert_int_equal(ipc_solver_advance(&p), CSCD_OK);
        assert_true(count_pairs(&p) > 10);
    }
    free(x);
    ipc_solver_free(&p);
    cscd_context_destroy(context);
}
