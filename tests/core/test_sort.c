/* Sorts are stable, and agree with each other. */
#include "src/core/sort.h"
#include "tests/support/test.h"

enum { ITEMS_MAX = 20000 };

typedef struct sort_key {
    uint64_t key;
    const void *of;
} sort_key;

static int compare_keys(const void *left, const void *right) {
    uint64_t a = ((const sort_key *)left)->key, b = ((const sort_key *)right)->key;
    return a < b ? -1 : a > b;
}

static sort_key merged[ITEMS_MAX], by_digits[ITEMS_MAX], scratch[ITEMS_MAX];

/* Some inputs have few keys, so that stability shows, and some have keys that differ in high digits only. */
TEST(digits_as_merging) {
    for (uint32_t count = 0; count < ITEMS_MAX; count = 2 * count + 1) {
        for (uint64_t keys = 1; keys <= 1000000; keys *= 100) {
            for (int shift = 0; shift < 64; shift += 21) {
                for (uint64_t i = 0; i < count; i++) {
                    merged[i].key = (i * 2654435761u % 1000003 % keys) << shift;
                    merged[i].of = &merged[i];
                    by_digits[i] = merged[i];
                }
                sort_items(merged, scratch, count, sizeof *merged, compare_keys);
                sort_by_number(by_digits, scratch, count, sizeof *by_digits);
                for (uint32_t i = 0; i < count; i++) {
                    assert_true(by_digits[i].key == merged[i].key && by_digits[i].of == merged[i].of);
                    if (i == 0) continue;
                    assert_true(merged[i - 1].key <= merged[i].key);
                    if (merged[i - 1].key == merged[i].key) assert_true(merged[i - 1].of < merged[i].of);
                }
            }
        }
    }
}
