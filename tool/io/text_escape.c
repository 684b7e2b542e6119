/* Texts of users (names, paths) as parts of other formats. */
#include "tool/io/text_escape.h"

#include <stdbool.h>

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
