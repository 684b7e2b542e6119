/* What the library asks of the system. */
#include "src/core/system.h"
#include "tests/support/test.h"

#include <stdint.h>

/* Every system of the tests tells. Plans are refused that do not fit, so it may be neither nothing nor all that numbers hold. */
TEST(memory_that_is_left) {
    const size_t left = system_memory_left();
    print_message("%.1f MiB are left\n", (double)left * 0x1p-20);
    assert_in_range(left, 16u << 20, SIZE_MAX - 1);
}

TEST(memory_is_aligned) {
    for (size_t alignment = 16; alignment <= 4096; alignment *= 2) {
        void *block = system_memory(alignment, alignment);
        assert_non_null(block);
        assert_int_equal((uintptr_t)block % alignment, 0);
        system_memory_free(block);
    }
    system_memory_free(NULL);
}

TEST(processors_are_counted) {
    assert_true(system_processors() >= 1);
    assert_in_range(system_processors_for_us(), 1, system_processors());
}
