/* What the library asks of the system. */
#include "src/core/system.h"
#include "tests/support/files.h"
#include "tests/support/test.h"

#include <stdint.h>
#include <string.h>

/* Every system of the tests tells. Plans are refused that do not fit, so it may be neither nothing nor all that numbers hold. */
TEST(memory_that_is_left) {
    const size_t left = system_memory_left();
    print_message("%.1f MiB are left\n", (double)left * 0x1p-20);
    assert_in_range(left, 16u << 20, SIZE_MAX - 1);
}

/* What a file cache holds can be dropped, but no more than is in use; a group that says "max" has no limit. */
TEST(groups_have_limits) {
#ifdef __linux__
    static const struct {
        const char *limit, *usage, *cache;
        uint64_t left;
    } groups[] = {
        {"1000\n", "700\n", "anon 300\ninactive_file 400\n", 700}, {"1000\n", "700\n", "anon 700\n", 300},
        {"1000\n", "700\n", "inactive_file 900\n", 1000},          {"1000\n", "1200\n", "anon 1200\n", 0},
        {"max\n", "700\n", "inactive_file 400\n", UINT64_MAX},     {"1000\n", "", "anon 700\n", UINT64_MAX},
    };
    const temp_folder folder = temp_folder_make();
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        const temp_path limit = temp_file_write(&folder, "limit", groups[i].limit, strlen(groups[i].limit)),
                        usage = temp_file_write(&folder, "usage", groups[i].usage, strlen(groups[i].usage)),
                        cache = temp_file_write(&folder, "cache", groups[i].cache, strlen(groups[i].cache));
        assert_int_equal(system_group_memory_left(limit.text, usage.text, cache.text), groups[i].left);
    }
    assert_int_equal(system_group_memory_left("/nowhere/limit", "/nowhere/usage", "/nowhere/stat"),
                     UINT64_MAX);
    temp_folder_remove(&folder);
#endif
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
