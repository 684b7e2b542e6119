/* The writer of JSON: what it makes of texts that are no UTF-8, of numbers that are none, and where its commas go. */
#include "tests/support/test.h"
#include "tool/io/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What the function writes. */
static void check_written(void (*put)(json *out), const char *expected) {
    char *text = NULL;
    size_t size = 0;
    json out = {.file = open_memstream(&text, &size)};
    assert_non_null(out.file);
    put(&out);
    assert_int_equal(fclose(out.file), 0);
    assert_string_equal(text, expected);
    free(text);
}

/* Cut off, alone, too long, a half of a pair, beyond the last character: a mark for each byte that is none. */
static void write_texts(json *out) {
    static const char *const texts[] = {"\"a\\b\"",     "\t\n\x1f",        "\xc3\xa4\xf0\x9f\x98\x80",
                                        "a\xc3",        "\x80z",           "\xc0\xaf",
                                        "\xed\xa0\x80", "\xf4\x90\x80\x80"};
    json_begin_array(out, NULL);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) json_string(out, NULL, texts[i]);
    json_end_array(out);
}

#define MARK "\xef\xbf\xbd"

TEST(texts_are_always_utf8) {
    check_written(write_texts,
                  "[\"\\\"a\\\\b\\\"\",\"\\u0009\\u000a\\u001f\",\"\xc3\xa4\xf0\x9f\x98\x80\",\"a" MARK
                  "\",\"" MARK "z\",\"" MARK MARK "\",\"" MARK MARK MARK "\",\"" MARK MARK MARK MARK "\"]");
}

static void write_numbers(json *out) {
    static const double numbers[] = {0.1, -0.0, 1e300, INFINITY, -INFINITY, NAN};
    json_begin_array(out, NULL);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) json_number(out, NULL, numbers[i]);
    json_integer(out, NULL, UINT64_MAX);
    json_signed(out, NULL, INT64_MIN);
    json_end_array(out);
}

TEST(numbers_are_finite_or_null) {
    check_written(write_numbers,
                  "[0.10000000000000001,-0,1.0000000000000001e+300,null,null,null,18446744073709551615,"
                  "-9223372036854775808]");
}

static void write_nested(json *out) {
    json_begin_object(out, NULL);
    json_begin_array(out, "none");
    json_end_array(out);
    json_begin_array(out, "some");
    json_boolean(out, NULL, true);
    json_break_line(out);
    json_begin_object(out, NULL);
    json_null(out, "a\"");
    json_end_object(out);
    json_end_array(out);
    json_verbatim(out, "last", "[1]");
    json_end_object(out);
}

TEST(commas_stand_between_items) {
    check_written(write_nested, "{\"none\":[],\"some\":[true,\n{\"a\\\"\":null}],\"last\":[1]}");
}
