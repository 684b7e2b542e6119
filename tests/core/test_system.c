/* What the library asks of the system. */
#include "src/core/system.h"
#include "tests/support/test.h"

#include <stdint.h>

/* Every system of the tests tells. Plans are refused that do not fit, so it may be neither nothing nor all that numbers hold. */
static void memory_that_is_left(void **state) {
    (void)state;
    const size_t left = system_memory_left();
    print_message("%.1f MiB are left\n", (double)left * 0x1p-20);
    assert_in_range(left, 16u << 20, SIZE_MAX - 1);
}

static void memory_is_aligned(void **state) {
    (void)state;
    for (size_t alignment = 16; alignment <= 4096; alignment *= 2) {
        void *block = system_memory(alignment, alignment);
        assert_non_null(block);
        assert_int_equal((uintptr_t)block % alignment, 0);
        system_memory_free(block);
    }
    system_memory_free(NULL);
}

static void processors_are_counted(void **state) {
    (void)state;
    assert_true(system_processors() >= 1);
    assert_in_range(system_processors_for_us(), 1, system_processors());
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_that_is_left),
        cmocka_unit_test(memory_is_aligned),
        cmocka_unit_test(processors_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
