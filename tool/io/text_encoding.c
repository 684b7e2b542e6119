/* The encodings of texts: quotes and escapes of formats that are written, and Base64. */
#include "tool/io/text_encoding.h"

#include <stdbool.h>
#include <stdint.h>

/* RFC 3629. */
size_t text_utf8_length(const unsigned char *s) {
    if (s[0] < 0x80) return 1;
    size_t length = s[0] >= 0xc2 && s[0] <= 0xdf   ? 2
                    : s[0] >= 0xe0 && s[0] <= 0xef ? 3
                    : s[0] >= 0xf0 && s[0] <= 0xf4 ? 4
                                                   : 0;
    for (size_t i = 1; i < length; i++) {
        if ((s[i] & 0xc0) != 0x80) return 0;
    }
    bool overlong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xf0 && s[1] < 0x90);
    bool surrogate_or_beyond = (s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf4 && s[1] > 0x8f);
    return overlong || surrogate_or_beyond ? 0 : length;
}

int text_cut_length(const char *text, int most) {
    int length = 0;
    while (text[length] != '\0') {
        const int next = (int)text_utf8_length((const unsigned char *)text + length);
        if (length + (next > 0 ? next : 1) > most) break;
        length += next > 0 ? next : 1;
    }
    return length;
}

void text_write_csv(FILE *file, const char *text) {
    fputc('"', file);
    for (; *text != '\0'; text++) {
        if (*text == '"') fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

/* Control characters but tab and line ends, U+FFFE and U+FFFF are no characters of XML 1.0. */
static bool xml_allows(const unsigned char *s) {
    if (s[0] < 0x20) return s[0] == '\t' || s[0] == '\n' || s[0] == '\r';
    return !(s[0] == 0xef && s[1] == 0xbf && s[2] >= 0xbe);
}

void text_write_xml(FILE *file, const char *text) {
    for (const unsigned char *s = (const unsigned char *)text; *s != '\0';) {
        size_t length = text_utf8_length(s);
        if (length == 0 || !xml_allows(s))
            fputs("\xef\xbf\xbd", file);
        else if (*s == '&' || *s == '<' || *s == '>' || *s == '"' || *s < 0x20)
            fprintf(file, "&#%d;", *s);
        else
            fwrite(s, 1, length, file);
        s += length > 0 ? length : 1;
    }
}

/* ---- Base64 -------------------------------------------------------------------------------------------- */

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
