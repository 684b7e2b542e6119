/* Random damage to the bytes of a file. */
#include "tests/support/io/byte_damage.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

static const char *const extreme_numbers[] = {
    "0",          "-1",         "1e999", "-1e308", "nan",
    "2147483648", "4294967295", "-0.0",  "1e-400", "18446744073709551616"};

/* Puts text in the place of `dropped` bytes; returns the new size. */
static size_t replace_bytes(unsigned char *bytes, size_t size, size_t at, size_t dropped, const char *text) {
    const size_t length = strlen(text);
    memmove(bytes + at + length, bytes + at + dropped, size - at - dropped);
    memcpy(bytes + at, text, length);
    return size + length - dropped;
}

static bool is_number_byte(unsigned char byte) {
    return isdigit(byte) || byte == '.' || byte == '-' || byte == 'e';
}

/* Replaces the number that `at` is in, if there is one. */
static size_t make_extreme(random_stream *random, unsigned char *bytes, size_t size, size_t at) {
    size_t begin = at, end = at;
    while (begin > 0 && is_number_byte(bytes[begin - 1])) begin--;
    while (end < size && is_number_byte(bytes[end])) end++;
    if (begin == end) return size;
    const uint32_t count = sizeof extreme_numbers / sizeof *extreme_numbers;
    return replace_bytes(bytes, size, begin, end - begin, extreme_numbers[stream_below(random, count)]);
}

static void copy_piece(random_stream *random, unsigned char *bytes, size_t size, size_t at) {
    const size_t from = stream_below(random, (uint32_t)size), last = at > from ? at : from;
    size_t length = 1 + stream_below(random, 64);
    if (length > size - last) length = size - last;
    memmove(bytes + at, bytes + from, length);
}

size_t damage_bytes(random_stream *random, unsigned char *bytes, size_t size) {
    const size_t at = stream_below(random, (uint32_t)size);
    switch (stream_below(random, 10)) {
    case 0:
        return stream_below(random, 4) == 0 && at > 0 ? at : size;
    case 1:
        memmove(bytes + at + 1, bytes + at, size - at);
        return size + 1;
    case 2:
        memmove(bytes + at, bytes + at + 1, size - at - 1);
        return size > 1 ? size - 1 : size;
    case 3:
        bytes[at] = (unsigned char)stream_bits(random);
        return size;
    case 4: /* numbers stay numbers */
        if (isdigit(bytes[at])) bytes[at] = (unsigned char)('0' + stream_below(random, 10));
        return size;
    case 5:
        return make_extreme(random, bytes, size, at);
    case 6:
        copy_piece(random, bytes, size, at);
        return size;
    default:
        bytes[at] ^= (unsigned char)(1u << stream_below(random, 8));
        return size;
    }
}
