/* Which kernels of OpenBLAS are better than those that it has chosen. */
#include "preprocess/baselines/dense/blas_choice.h"
#include "tests/support/test.h"

TEST(the_processor_decides) {
    assert_string_equal(blas_better_core("Prescott", true, true), "SkylakeX");
    assert_string_equal(blas_better_core("Prescott", true, false), "Haswell");
    assert_string_equal(blas_better_core("Sandybridge", true, false), "Haswell");
    assert_string_equal(blas_better_core("Katmai", true, false), "Haswell");
    assert_string_equal(blas_better_core("Steamroller", true, true), "SkylakeX");
    assert_null(blas_better_core("Prescott", false, false));
    assert_null(blas_better_core("Haswell", true, true));
    assert_null(blas_better_core("Zen", true, true));
    assert_null(blas_better_core("Cooperlake", true, true));
    assert_null(blas_better_core("neoversen1", false, false));
    assert_null(blas_better_core("a core to come", true, true));
}
