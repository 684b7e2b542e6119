/* Base64, as data URIs and GIFTI files hold it. */
#include "tool/io/base64.h"

#include <stdint.h>

size_t base64_room(size_t length) {
    return length / 4 * 3 + 3;
}

/* The six bits of a character, or -1. */
static int character_bits(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    return c == '/' ? 63 : -1;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/* Behind the first '=' stand only blanks and '='. */
static bool only_padding(const char *text, size_t length, size_t *at) {
    while (*at < length && (text[*at] == '=' || is_blank(text[*at]))) (*at)++;
    return *at == length;
}

bool base64_decode(const char *text, size_t length, unsigned char *out, size_t *size, size_t *wrong) {
    uint32_t bits = 0;
    size_t characters = 0, written = 0, at = 0;
    for (; at < length && text[at] != '='; at++) {
        if (is_blank(text[at])) continue;
        const int six = character_bits(text[at]);
        if (six < 0) break;
        bits = bits << 6 | (uint32_t)six;
        if (++characters % 4 != 1) out[written++] = (unsigned char)(bits >> (6 - 2 * ((characters - 1) % 4)));
    }
    *wrong = at;
    if (!only_padding(text, length, wrong) || characters % 4 == 1) return false;
    *size = written;
    return true;
}
