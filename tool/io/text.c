/* Tokens and numbers of the text formats, line by line. */
#include "tool/io/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}

/* Lines end with LF, CR LF or, on old machines, CR alone. The 0 behind the bytes makes at + 1 safe to
 * read. */
static size_t line_end_size(const file_reader *reader, size_t at) {
    if (!is_line_end(reader->bytes[at])) return 0;
    return reader->bytes[at] == '\r' && reader->bytes[at + 1] == '\n' ? 2 : 1;
}

static bool is_continuation(const file_reader *reader) {
    return reader->continuations && reader->bytes[reader->at] == '\\' &&
           is_line_end(reader->bytes[reader->at + 1]);
}

static void pass_continuation(file_reader *reader) {
    reader->at += 1 + line_end_size(reader, reader->at + 1);
    reader->line++;
}

static void skip_blanks(file_reader *reader) {
    for (;;) {
        if (is_blank(reader->bytes[reader->at])) {
            reader->at++;
        } else if (is_continuation(reader)) {
            pass_continuation(reader);
        } else {
            return;
        }
    }
}

static bool ends_word(const file_reader *reader) {
    char c = reader->bytes[reader->at];
    if (c > ' ' && c != '\\') return false;
    return reader->at == reader->size || is_blank(c) || is_line_end(c) || is_continuation(reader);
}

/* A # begins a comment where a word could begin. Within one it is of the word: programs of Windows write 1.#QNAN for what
 * is no number, and names may have it. */
static bool begins_comment(const file_reader *reader) {
    return reader->comments && reader->bytes[reader->at] == '#';
}

bool text_next_token(file_reader *reader, text_token *token) {
    skip_blanks(reader);
    size_t start = reader->at;
    if (!begins_comment(reader))
        while (!ends_word(reader)) reader->at++;
    *token = (text_token){reader->bytes + start, reader->at - start};
    return token->length > 0;
}

bool text_rest_of_line(file_reader *reader, text_token *rest) {
    skip_blanks(reader);
    const size_t start = reader->at;
    size_t end = start;
    for (; reader->at < reader->size && !is_line_end(reader->bytes[reader->at]) && !is_continuation(reader);
         reader->at++)
        if (!is_blank(reader->bytes[reader->at])) end = reader->at + 1;
    *rest = (text_token){reader->bytes + start, end - start};
    return rest->length > 0;
}

void text_skip_line(file_reader *reader) {
    bool in_comment = false, in_word = false;
    while (reader->at < reader->size) {
        char c = reader->bytes[reader->at];
        size_t end_size = line_end_size(reader, reader->at);
        if (end_size > 0) {
            reader->at += end_size;
            reader->line++;
            return;
        }
        if (!in_word && begins_comment(reader)) in_comment = true;
        in_word = !is_blank(c);
        /* A comment that ends in a backslash, as a folder's name may, must not swallow the next line. */
        if (!in_comment && is_continuation(reader)) {
            pass_continuation(reader);
            in_word = false;
        } else {
            reader->at++;
        }
    }
}

bool text_seek_token(file_reader *reader) {
    for (;;) {
        skip_blanks(reader);
        if (reader->at == reader->size) return false;
        if (!begins_comment(reader) && !ends_word(reader)) return true;
        text_skip_line(reader);
    }
}

const char *text_number_advice(text_token token) {
    const char *comma = memchr(token.text, ',', token.length);
    double whole, fraction;
    if (comma == NULL) return "";
    const text_token before = {token.text, (size_t)(comma - token.text)},
                     behind = {comma + 1, token.length - before.length - 1};
    const bool is_number = behind.length > 0 && *behind.text >= '0' && *behind.text <= '9' &&
                           (text_parse_number(before, &whole) || before.length == 0) &&
                           text_parse_number(behind, &fraction);
    return is_number ? "; this is a decimal comma: write numbers with a decimal point" : "";
}

static bool fail_expected(file_reader *reader, text_token token, const char *expected) {
    if (token.length > 0) {
        return file_reader_fail_here(reader, "found '%s', expected %s", text_show(token).text, expected);
    }
    const char *what = reader->at == reader->size ? "file" : "line";
    return file_reader_fail_here(reader, "the %s ends, expected %s", what, expected);
}

bool text_number(file_reader *reader, const char *expected, double *value) {
    text_token token;
    if (!text_next_token(reader, &token)) return fail_expected(reader, token, expected);
    return text_parse_number(token, value) ||
           file_reader_fail_here(reader, "found '%s', expected %s%s", text_show(token).text, expected,
                                 text_number_advice(token));
}

bool text_integer(file_reader *reader, const char *expected, int64_t *value) {
    text_token token;
    return (text_next_token(reader, &token) && text_parse_integer(token, value)) ||
           fail_expected(reader, token, expected);
}

bool text_expect_line_end(file_reader *reader) {
    text_token token;
    return !text_next_token(reader, &token) || fail_expected(reader, token, "the end of the line");
}

/* What the C library of Visual C++ printed before 2015 for what is no number: 1.#QNAN, -1.#IND00, 1.#INF, and, when it
 * rounded that as if it were digits, 1.#R and 1.#J. */
static bool parse_no_number(text_token token, double *value) {
    static const char mark[] = "1.#";
    const size_t sign = token.length > 0 && (*token.text == '-' || *token.text == '+') ? 1 : 0;
    const size_t start = sign + sizeof mark - 1;
    if (token.length <= start || memcmp(token.text + sign, mark, sizeof mark - 1) != 0) return false;
    size_t at = start;
    while (at < token.length && token.text[at] >= 'A' && token.text[at] <= 'Z') at++;
    const bool is_infinite = at - start == 3 && memcmp(token.text + start, "INF", 3) == 0;
    if (at == start) return false;
    while (at < token.length && token.text[at] == '0') at++;
    if (at < token.length) return false;
    *value = !is_infinite ? NAN : *token.text == '-' ? -INFINITY : INFINITY;
    return true;
}

/* strtod rounds correctly and reads the point of the C locale, in which the program stays: nothing in it
 * calls setlocale. It stops at the blank, line end or 0 behind the token. */
bool text_parse_number(text_token token, double *value) {
    size_t sign = *token.text == '-' || *token.text == '+' ? 1 : 0;
    bool is_hexadecimal =
        token.text[sign] == '0' && (token.text[sign + 1] == 'x' || token.text[sign + 1] == 'X');
    char *end;
    double number = strtod(token.text, &end);
    if (is_hexadecimal) return false;
    if (end != token.text + token.length) return parse_no_number(token, value);
    *value = number;
    return true;
}

size_t text_parse_integer_prefix(text_token token, int64_t *value) {
    enum { MOST_DIGITS = 18 }; /* 10^18 < 2^63 */
    size_t sign = token.length > 0 && (token.text[0] == '-' || token.text[0] == '+') ? 1 : 0;
    size_t i = sign;
    int64_t number = 0;
    for (; i < token.length && token.text[i] >= '0' && token.text[i] <= '9'; i++) {
        if (i - sign == MOST_DIGITS) return 0;
        number = 10 * number + (token.text[i] - '0');
    }
    if (i == sign) return 0;
    *value = token.text[0] == '-' ? -number : number;
    return i;
}

bool text_parse_integer(text_token token, int64_t *value) {
    return token.length > 0 && text_parse_integer_prefix(token, value) == token.length;
}

bool text_equals(text_token token, const char *word) {
    return strlen(word) == token.length && memcmp(token.text, word, token.length) == 0;
}

text_shown text_show(text_token token) {
    text_shown shown = {0};
    size_t most = sizeof shown.text - 1;
    size_t length = token.length < most ? token.length : most;
    for (size_t i = 0; i < length; i++) {
        char c = token.text[i];
        shown.text[i] = c >= ' ' && c <= '~' ? c : '?';
    }
    if (token.length > most) memcpy(shown.text + most - 3, "...", 3);
    return shown;
}
