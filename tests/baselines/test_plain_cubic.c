/* libcscd-baselines is opened and hands out what GSL finds of roots, and nothing that it does not have. */
#include "runtime/baselines/plain_cubic.h"
#include "src/core/baseline_library.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static cscd_context *context;

static int make_context(void **state) {
    (void)state;
    return cscd_context_create(NULL, &context) != CSCD_OK;
}

static int destroy_context(void **state) {
    (void)state;
    cscd_context_destroy(context);
    return 0;
}

static const plain_cubic_functions *find_functions(void) {
    const void *functions = NULL;
    expect_ok(baseline_library_find(context, PLAIN_CUBIC_ENTRY, PLAIN_CUBIC_INTERFACE, "a test", &functions));
    assert_non_null(functions);
    return functions;
}

/* (x - 1) (x - 2) (x - 4) */
TEST(three_roots_of_a_cubic) {
    double x[3];
    assert_int_equal(find_functions()->cubic(-7.0, 14.0, -8.0, &x[0], &x[1], &x[2]), 3);
    for (int i = 0; i < 3; i++) assert_true(fabs(x[i] - ldexp(1.0, i)) < 1e-12);
}

TEST(one_root_of_a_cubic) {
    double x[3];
    assert_int_equal(find_functions()->cubic(0.0, 0.0, -8.0, &x[0], &x[1], &x[2]), 1);
    assert_true(fabs(x[0] - 2.0) < 1e-12);
}

TEST(roots_of_lower_degrees) {
    double x[2];
    assert_int_equal(find_functions()->quadratic(1.0, -3.0, 2.0, &x[0], &x[1]), 2);
    assert_true(x[0] == 1.0 && x[1] == 2.0);
    assert_int_equal(find_functions()->quadratic(0.0, 2.0, -1.0, &x[0], &x[1]), 1);
    assert_true(x[0] == 0.5);
    assert_int_equal(find_functions()->quadratic(1.0, 0.0, 1.0, &x[0], &x[1]), 0);
}

static void expect_other_version(const char *entry_name, uint32_t interface) {
    const void *functions = context;
    assert_int_equal(baseline_library_find(context, entry_name, interface, "a test", &functions),
                     CSCD_SYSTEM_ERROR);
    assert_null(functions);
    const char *sentence = cscd_context_detail(context);
    assert_true(strncmp(sentence, "a test", 6) == 0 && strstr(sentence, "different versions") != NULL);
}

TEST(what_it_does_not_have_is_refused) {
    expect_other_version(PLAIN_CUBIC_ENTRY, PLAIN_CUBIC_INTERFACE + 1);
    expect_other_version("cscd_baseline_of_later", 1);
}

AROUND_EACH(make_context, destroy_context)
