/* Friction of near pairs: its derivatives against differences, its limits, its coefficients, and what is frozen. */
#include "cscd/cscd.h"
#include "tests/support/energy/energy_truth.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* A mesh of four points, and an energy of it, for items that tests make. */
typedef struct friction_rig {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_energy *energy;
} friction_rig;

static friction_rig make_rig(void) {
    const cscd_object_desc objects[2] = {cscd_object_of_points(2), cscd_object_of_points(2)};
    friction_rig r;
    r.context = context_of(1, NULL);
    expect_ok(cscd_mesh_create(r.context, objects, 2, &r.mesh));
    expect_ok(cscd_energy_create(r.context, r.mesh, &r.energy));
    return r;
}

static void free_rig(const friction_rig *r) {
    cscd_energy_destroy(r->energy);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static void freeze_case(const friction_rig *r, const energy_case *c) {
    const cscd_proximities one = {&c->item, 1};
    expect_ok(cscd_energy_freeze_friction(r->energy, &one, CSCD_DOUBLES(c->x, 4), &c->options));
}

static cscd_energy_sum rub_points(const friction_rig *r, const double *x0, const double *x1, double *gradient,
                                  double *hessian) {
    const cscd_energy_targets targets = {.gradient = gradient, .blocks = hessian, .project = true};
    cscd_energy_sum sum;
    expect_ok(
        cscd_energy_evaluate_friction(r->energy, CSCD_DOUBLES(x0, 4), CSCD_DOUBLES(x1, 4), &targets, &sum));
    return sum;
}

static energy_case make_case(random_stream *random, pair_shape shape) {
    energy_case c = energy_case_make(random, shape, 0.2);
    c.options.reach = 0.5;
    c.options.stiffness = 3.0;
    c.options.friction = 0.7;
    c.options.slip = 0.1;
    return c;
}

/* Displacements well below and above the static threshold, and across it. */
TEST(friction_has_its_derivatives) {
    random_stream random = stream_start(1);
    friction_rig r = make_rig();
    for (int i = 0; i < 300; i++) {
        energy_case c = make_case(&random, i % SHAPE_COUNT);
        double x1[12], gradient[12], hessian[144], far = i % 3 == 0 ? 0.03 : i % 3 == 1 ? 0.1 : 1.0;
        freeze_case(&r, &c);
        for (int k = 0; k < 12; k++) x1[k] = c.x[k] + stream_between(&random, -far, far);
        if (c.item.vertices[3] != 3) memcpy(x1 + 9, c.x + 9, 3 * sizeof *x1);
        cscd_energy_sum sum = rub_points(&r, c.x, x1, gradient, hessian);
        assert_true(sum.value > 0.0 && sum.active == 1);
        if (fabs(sum.least - c.options.slip) < 1e-4) continue; /* the third derivative jumps */
        for (int k = 0; k < 12; k++) {
            double there[12], ends[2], slopes[2][12], h = 1e-6;
            for (int side = 0; side < 2; side++) {
                memcpy(there, x1, sizeof there);
                there[k] += side == 0 ? -h : h;
                ends[side] = rub_points(&r, c.x, there, slopes[side], NULL).value;
            }
            assert_true(fabs((ends[1] - ends[0]) / (2.0 * h) - gradient[k]) < 1e-7);
            for (int l = 0; l < 12; l++)
                assert_true(fabs((slopes[1][l] - slopes[0][l]) / (2.0 * h) - hessian[12 * k + l]) < 1e-6);
        }
    }
    free_rig(&r);
}

/* A vertex beside a face of normal z: beyond the threshold the force is coefficient times normal force, against the sliding, and
 * below it falls to 0; along the normal there is none. */
TEST(friction_is_that_of_coulomb) {
    friction_rig r = make_rig();
    energy_case c;
    memset(&c, 0, sizeof c);
    c.options = cscd_energy_defaults();
    c.options.law = CSCD_ENERGY_QUADRATIC;
    c.options.reach = 1.0;
    c.options.stiffness = 2.0;
    c.options.friction = 0.25;
    c.options.slip = 0.01;
    c.item.kind = CSCD_CONTACT_VF;
    c.item.count = 1;
    c.item.weight = 1.0;
    cscd_stencil_weights(CSCD_CONTACT_VF, 0.25, 0.25, c.item.weights);
    for (uint32_t i = 0; i < 4; i++) c.item.vertices[i] = i;
    const double x[12] = {0.25, 0.25, 0.6, 0, 0, 0, 1, 0, 0, 0, 1, 0}; /* force 2 * (1 - 0.6) */
    double moved[12], gradient[12], hessian[144];
    memcpy(c.x, x, sizeof x);
    freeze_case(&r, &c);
    memcpy(moved, x, sizeof x);
    moved[0] += 0.3, moved[2] -= 5.0;
    cscd_energy_sum sum = rub_points(&r, x, moved, gradient, hessian);
    assert_true(fabs(gradient[0] - 0.25 * 0.8) < 1e-15 && fabs(gradient[1]) < 1e-15 && gradient[2] == 0.0);
    assert_true(fabs(gradient[3] + 0.5 * 0.2) < 1e-15 && fabs(gradient[6] + 0.25 * 0.2) < 1e-15);
    assert_true(fabs(sum.value - 0.2 * 0.3) < 1e-15 && fabs(sum.least - 0.3) < 1e-15);
    sum = rub_points(&r, x, x, gradient, hessian);
    assert_true(fabs(sum.value - 0.2 * 0.01 / 3.0) < 1e-17 && gradient[0] == 0.0);
    assert_true(fabs(hessian[0] - 0.2 * 2.0 / 0.01) < 1e-12);
    moved[0] = x[0] + 0.004, moved[2] = x[2];
    rub_points(&r, x, moved, gradient, hessian);
    assert_true(fabs(gradient[0] - 0.2 * (2.0 * 0.4 - 0.16)) < 1e-13);
    free_rig(&r);
}

TEST(coefficients_are_of_objects_or_items) {
    friction_rig r = make_rig();
    random_stream random = stream_start(3);
    energy_case c = make_case(&random, SHAPE_VF);
    const double of_objects[2] = {0.04, 0.09}, of_items[1] = {0.5}, zero[2] = {0.0, 0.9};
    double gradient[12], far[12];
    for (int k = 0; k < 12; k++) far[k] = c.x[k] + (k < 3 ? 1.0 : 0.0);
    freeze_case(&r, &c);
    double all = rub_points(&r, c.x, far, gradient, NULL).value / 0.7;
    c.item.vertices[0] = 0, c.item.vertices[1] = 2; /* of the other object */
    c.item.vertices[2] = 1;
    for (int k = 0; k < 3; k++) {
        double kept = c.x[3 + k];
        c.x[3 + k] = c.x[6 + k], c.x[6 + k] = kept;
        far[3 + k] = c.x[3 + k], far[6 + k] = c.x[6 + k];
    }
    c.options.object_friction = of_objects;
    freeze_case(&r, &c);
    assert_true(fabs(rub_points(&r, c.x, far, gradient, NULL).value - 0.06 * all) < 1e-12 * all);
    c.options.object_friction = zero;
    freeze_case(&r, &c);
    assert_true(rub_points(&r, c.x, far, gradient, NULL).value == 0.0);
    c.options.item_friction = of_items;
    freeze_case(&r, &c);
    assert_true(fabs(rub_points(&r, c.x, far, gradient, NULL).value - 0.5 * all) < 1e-12 * all);
    free_rig(&r);
}

/* Edges that fade have as little friction as they have normal force. */
TEST(friction_of_parallel_edges_fades) {
    friction_rig r = make_rig();
    random_stream random = stream_start(5);
    energy_case c = make_case(&random, SHAPE_EE);
    double x1[12], gradient[12], across[3], square = 0.0, a[3], b[3];
    for (int k = 0; k < 12; k++) x1[k] = c.x[k] + (k < 6 ? 0.3 : 0.0);
    freeze_case(&r, &c);
    double whole = rub_points(&r, c.x, x1, gradient, NULL).value;
    for (int k = 0; k < 3; k++) a[k] = c.x[3 + k] - c.x[k], b[k] = c.x[9 + k] - c.x[6 + k];
    for (int k = 0; k < 3; k++) {
        across[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        square += across[k] * across[k];
    }
    c.item.threshold = 4.0 * square; /* the mollifier is 1/4 (2 - 1/4) */
    freeze_case(&r, &c);
    assert_true(fabs(rub_points(&r, c.x, x1, gradient, NULL).value - 0.4375 * whole) < 1e-12 * whole);
    free_rig(&r);
}

/* What is frozen stays until the next time; an empty list frees all. */
TEST(friction_stays_frozen) {
    friction_rig r = make_rig();
    random_stream random = stream_start(4);
    energy_case c = make_case(&random, SHAPE_EE), other = make_case(&random, SHAPE_VF);
    const cscd_proximities none = {NULL, 0}, one = {&other.item, 1};
    double x1[12], gradient[12], again[12];
    cscd_energy_sum sum;
    for (int k = 0; k < 12; k++) x1[k] = c.x[k] + 0.1 * k;
    freeze_case(&r, &c);
    double before = rub_points(&r, c.x, x1, gradient, NULL).value;
    expect_ok(cscd_energy_evaluate(r.energy, &one, CSCD_DOUBLES(other.x, 4), &other.options, NULL, &sum));
    other.options.slip = 0.0;
    assert_int_equal(cscd_energy_freeze_friction(r.energy, &one, CSCD_DOUBLES(other.x, 4), &other.options),
                     CSCD_INVALID_ARGUMENT);
    assert_true(rub_points(&r, c.x, x1, again, NULL).value == before);
    assert_memory_equal(gradient, again, sizeof again);
    expect_ok(cscd_energy_freeze_friction(r.energy, &none, CSCD_DOUBLES(c.x, 4), &c.options));
    sum = rub_points(&r, c.x, x1, gradient, NULL);
    assert_true(sum.value == 0.0 && sum.least == INFINITY && sum.active == 0);
    free_rig(&r);
}
