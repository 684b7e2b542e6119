/* A whole file in memory, a position in it, errors that name the place, and the tokens and numbers of text
 * formats. */
#include "tool/io/file_reader.h"

#include "tool/io/io.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A longer path would leave no room for what is wrong, so only its end is shown. */
enum { SHOWN_PATH_LENGTH = 500, MESSAGE_SIZE = sizeof((io_error *)0)->text };

static size_t write_path(char *message, const char *path) {
    size_t length = strlen(path);
    bool cut = length > SHOWN_PATH_LENGTH;
    const char *shown = cut ? path + length - SHOWN_PATH_LENGTH : path;
    while (cut && ((unsigned char)*shown & 0xc0) == 0x80) shown++; /* within a character */
    return (size_t)snprintf(message, MESSAGE_SIZE, "%s%s", cut ? "..." : "", shown);
}

static void write_rest(char *message, size_t used, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

static void write_rest(char *message, size_t used, const char *format, va_list arguments) {
    vsnprintf(message + used, MESSAGE_SIZE - used, format, arguments);
}

bool file_reader_fail(file_reader *reader, const char *format, ...) {
    char message[MESSAGE_SIZE];
    size_t used = write_path(message, reader->path);
    used += (size_t)snprintf(message + used, MESSAGE_SIZE - used, ": ");
    va_list arguments;
    va_start(arguments, format);
    write_rest(message, used, format, arguments);
    va_end(arguments);
    return io_fail(reader->error, "%s", message);
}

bool file_reader_fail_here(file_reader *reader, const char *format, ...) {
    char message[MESSAGE_SIZE];
    size_t used = write_path(message, reader->path);
    const char *place = reader->binary ? ": byte %zu: " : ":%zu: ";
    size_t number = reader->binary ? reader->mark : reader->line;
    used += (size_t)snprintf(message + used, MESSAGE_SIZE - used, place, number);
    va_list arguments;
    va_start(arguments, format);
    write_rest(message, used, format, arguments);
    va_end(arguments);
    return io_fail(reader->error, "%s", message);
}

/* The size that fstat gives is only a hint: pipes have none, and a file may grow while it is read. */
static bool read_all(file_reader *reader, FILE *file, size_t expected_size, growable *bytes) {
    if (!growable_reserve(bytes, expected_size)) goto out_of_memory;
    for (;;) {
        size_t room = bytes->capacity - bytes->count - 1; /* one for the 0 */
        size_t got = fread((char *)bytes->data + bytes->count, 1, room, file);
        bytes->count += got;
        if (got < room) break;
        if (bytes->capacity > SIZE_MAX / 2 || !growable_reserve(bytes, 2 * bytes->capacity))
            goto out_of_memory;
    }
    if (ferror(file)) return file_reader_fail(reader, "cannot read: %s", strerror(errno));
    ((char *)bytes->data)[bytes->count] = '\0';
    return true;

out_of_memory:
    return file_reader_fail(reader, "out of memory for a file of %zu bytes or more",
                            bytes->count > expected_size ? bytes->count : expected_size);
}

static bool read_file(file_reader *reader, FILE *file) {
    struct stat status = {.st_mode = S_IFIFO};
    if (fileno(file) >= 0 && fstat(fileno(file), &status) != 0)
        return file_reader_fail(reader, "cannot open: %s", strerror(errno));
    if (S_ISDIR(status.st_mode)) return file_reader_fail(reader, "is a directory, expected a file");
    if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) {
        return file_reader_fail(reader, "is a device, expected a file");
    }
    /* One byte more than the file holds, so that the first read already meets its end, and one for the 0. */
    uintmax_t expected_size = (uintmax_t)(status.st_size > 0 ? status.st_size : 4096) + 2;
    growable bytes = growable_of(1);
    bool done = read_all(reader, file, expected_size > SIZE_MAX ? SIZE_MAX : (size_t)expected_size, &bytes);
    if (done) {
        reader->size = bytes.count;
        reader->bytes = bytes.data;
    } else {
        growable_free(&bytes);
    }
    return done;
}

bool file_reader_open(file_reader *reader, const char *path, io_error *error) {
    *reader = (file_reader){.path = path, .error = error, .line = 1};
    FILE *file = pipe_file_read(path);
    if (file == NULL)
        return file_reader_fail(reader, "cannot open: %s%s", strerror(errno),
                                errno == ENOENT ? path_missing_advice(path) : "");
    bool done = read_file(reader, file);
    fclose(file);
    return done;
}

void file_reader_close(file_reader *reader) {
    free(reader->bytes);
    *reader = (file_reader){0};
}

void file_reader_expect(const char *path) {
#ifdef POSIX_FADV_WILLNEED
    struct stat status;
    /* Whoever writes a pipe would take this for its reader. */
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return;
    posix_fadvise(file, 0, 0, POSIX_FADV_WILLNEED);
    close(file);
#else
    (void)path;
#endif
}

/* ---- text, line by line -------------------------------------------------------------------------------- */

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

/* A # begins a comment where a word could begin. Within one it is of the word: programs of Windows write
 * 1.#QNAN for what is no number, and names may have it. */
static bool begins_comment(const file_reader *reader) {
    return reader->comments && reader->bytes[reader->at] == '#';
}

bool text_next_token(file_reader *reader, text_token *token) {
    skip_blanks(reader);
    size_t start = reader->at;
    reader->mark = start;
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

bool text_coordinate(file_reader *reader, int axis, const char *expected, double *value) {
    if (!text_number(reader, expected, value)) return false;
    reader->coordinates[axis] = (coordinate_place){COORDINATE_TEXT, reader->mark, reader->at - reader->mark};
    return true;
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

/* Spellings of what is no number, as the C library of Visual C++ printed them before 2015: 1.#QNAN,
 * -1.#IND00, 1.#INF, and, when it rounded that as if it were digits, 1.#R and 1.#J. */
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
