/* Energies of single pairs: values and derivatives against formulas in long doubles, and projections against an eigenvalue
 * solver of twelve rows. */
#include "runtime/energy/energy.h"
#include "tests/support/energy/energy_truth.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* ---- the logarithm --------------------------------------------------------------------------------------- */

TEST(logarithm_is_that_of_libm) {
    random_stream random = stream_start(1);
    for (int i = 0; i < 100000; i++) {
        double x = exp(stream_between(&random, i % 2 == 0 ? -700.0 : -0.1, i % 2 == 0 ? 700.0 : 0.1));
        long double truth = logl((long double)x);
        assert_true(fabsl(natural_logarithm(x) - truth) <= 3e-16L * fabsl(truth));
    }
    assert_true(natural_logarithm(1.0) == 0.0);
    assert_true(natural_logarithm(0x1p-1022) == -1022.0 * 0x1.62e42fefa39efp-1);
    assert_true(natural_logarithm(1.0 - 0x1p-53) == -0x1p-53);
}

/* ---- derivatives ------------------------------------------------------------------------------------------- */

/* The largest differences from the truth, as shares of the largest entry. */
typedef struct pair_errors {
    double value, gradient, hessian;
} pair_errors;

static pair_errors errors_of(const energy_case *c, long double step) {
    long double gradient[12], hessian[12][12], x[12], largest = 0.0L, steepest = 0.0L;
    double found[4][3], second[12][12];
    pair_errors e = {0.0, 0.0, 0.0};
    energy_term term = {.gradient = found, .hessian = second};
    for (int i = 0; i < 12; i++) x[i] = c->x[i];
    energy_pair_evaluate(&c->options, &c->item, c->x, &term);
    energy_truth_derivatives(c, step, gradient, hessian);
    e.value = (double)fabsl(term.value / energy_truth(c, x) - 1.0L);
    for (int i = 0; i < 144; i++) {
        largest = fmaxl(largest, fabsl(hessian[i / 12][i % 12]));
        steepest = fmaxl(steepest, fabsl(gradient[i % 12]));
    }
    for (int i = 0; i < 144; i++) {
        long double off = fabsl(second[i / 12][i % 12] - hessian[i / 12][i % 12]) / largest;
        e.hessian = fmax(e.hessian, (double)off);
        e.gradient =
            fmax(e.gradient, (double)(fabsl(found[i % 12 / 3][i % 3] - gradient[i % 12]) / steepest));
        assert_true(second[i / 12][i % 12] == second[i % 12][i / 12]);
    }
    return e;
}

/* Cases of all laws, near and far within the reach, with half of the pairs of edges below the mollifier's threshold. */
static energy_case make_any(random_stream *random, pair_shape shape) {
    double reach = exp(stream_between(random, -6.0, 0.0)), share = exp(stream_between(random, -5.0, -0.05));
    bool beyond = stream_below(random, 2) == 1;
    double keep = beyond ? stream_between(random, 0.0, 2.0) * reach : 0.0;
    energy_case c = energy_case_make(random, shape, keep + share * reach);
    c.options.beyond = beyond;
    c.item.separation = beyond ? keep : 4711.0;
    c.options.by_count = stream_below(random, 2) == 1;
    c.options.reach = reach;
    c.options.law = stream_below(random, 4);
    c.options.physical = stream_below(random, 2) == 1;
    c.options.stiffness = exp(stream_between(random, -9.0, 9.0));
    if (c.item.kind == CSCD_CONTACT_EE && stream_below(random, 2) == 1)
        c.item.threshold = stream_between(random, 0.1, 30.0);
    return c;
}

TEST(derivatives_are_those_of_the_formulas) {
    random_stream random = stream_start(2);
    for (int shape = 0; shape < SHAPE_COUNT; shape++) {
        pair_errors most = {0.0, 0.0, 0.0};
        for (int i = 0; i < NIGHTLY(60, 2000); i++) {
            energy_case c = make_any(&random, shape);
            pair_frame f;
            pair_frame_find(&c.item, c.x, &f);
            double gap = fabs(f.distance) - CASE_SEPARATION(&c), left = c.options.reach - gap;
            pair_errors e = errors_of(&c, 0.02L * fminl(gap, left));
            most.value = fmax(most.value, e.value);
            most.gradient = fmax(most.gradient, e.gradient);
            most.hessian = fmax(most.hessian, e.hessian);
        }
        print_message("  shape %d: value %.2g, gradient %.2g, Hessian %.2g\n", shape, most.value,
                      most.gradient, most.hessian);
        assert_true(most.value < 1e-9 && most.gradient < 1e-6 && most.hessian < 1e-6);
    }
}

/* ---- projections ------------------------------------------------------------------------------------------- */

TEST(projections_are_the_nearest_semidefinite) {
    random_stream random = stream_start(3);
    for (int i = 0; i < NIGHTLY(600, 20000); i++) {
        energy_case c = make_any(&random, i % SHAPE_COUNT);
        double plain[12][12], projected[12][12];
        long double truth[12][12], largest = 0.0L;
        energy_term term = {.hessian = plain};
        energy_pair_evaluate(&c.options, &c.item, c.x, &term);
        term = (energy_term){.hessian = projected, .project = true};
        energy_pair_evaluate(&c.options, &c.item, c.x, &term);
        project_plainly(plain, truth);
        for (int j = 0; j < 144; j++) largest = fmaxl(largest, fabsl(plain[j / 12][j % 12]));
        for (int j = 0; j < 144; j++) {
            double off = (double)(fabsl(projected[j / 12][j % 12] - truth[j / 12][j % 12]) / largest);
            if (off > 1e-12) fail_msg("shape %d: off by %g", i % SHAPE_COUNT, off);
        }
    }
}
