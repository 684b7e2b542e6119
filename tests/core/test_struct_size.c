/* Structs that callers fill, between a caller and a library of different ages. */
#include "src/core/context.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

enum { KNOWN = 16, LEAST = 8, LARGEST = 40 };

static uint8_t known[KNOWN], other[LARGEST + 8];

static void fill_bytes(void) {
    for (int i = 0; i < KNOWN; i++) known[i] = (uint8_t)(i + 1);
    memset(other, 0xee, sizeof other);
}

/* A newer caller gets zeros for what the library does not know, an older one no more than it has room for. */
TEST(options_begin_with_the_size_of_the_caller) {
    for (size_t size = sizeof(uint32_t); size <= LARGEST; size++) {
        uint32_t own;
        fill_bytes();
        struct_give_options(other, size, known, KNOWN);
        memcpy(&own, other, sizeof own);
        assert_int_equal(own, size);
        for (size_t i = sizeof own; i < sizeof other; i++)
            assert_int_equal(other[i], i >= size ? 0xee : i < KNOWN ? known[i] : 0);
    }
}

/* What an older caller does not have keeps its default; what the library does not know has to be 0, at each byte. */
TEST(what_is_taken_is_known) {
    char expected[64];
    cscd_context explained = {.detail = ""};
    for (size_t size = 0; size <= LARGEST; size++) {
        uint8_t into[KNOWN];
        fill_bytes();
        memset(other + KNOWN, 0, LARGEST - KNOWN);
        memcpy(into, known, KNOWN);
        cscd_status status = struct_take(&explained, into, KNOWN, LEAST, other, size, "things");
        assert_int_equal(status, size < LEAST ? CSCD_INVALID_ARGUMENT : CSCD_OK);
        for (size_t i = 0; i < KNOWN; i++)
            assert_int_equal(into[i], size >= LEAST && i < size ? other[i] : known[i]);
        if (size < LEAST) assert_non_null(strstr(explained.detail, "expected at least 8"));
        for (size_t i = KNOWN; i < size; i++) {
            other[i] = 1;
            assert_int_equal(struct_take(&explained, into, KNOWN, LEAST, other, size, "things"),
                             CSCD_INVALID_ARGUMENT);
            snprintf(expected, sizeof expected, "things: the member at byte %zu is not 0", i);
            assert_non_null(strstr(explained.detail, expected));
            other[i] = 0;
        }
    }
}
