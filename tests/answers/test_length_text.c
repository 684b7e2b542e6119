/* Lengths for people: three digits, in the unit that suits, and read back from the command line. */
#include "tests/support/test.h"
#include "tool/answers/answers.h"

#include <math.h>
#include <stddef.h>

static void check_text(const char *unit, double length, const char *expected) {
    char text[LENGTH_TEXT_SIZE];
    length_unit files = {.name = NULL};
    if (unit != NULL) assert_true(length_unit_from_name(unit, &files));
    assert_string_equal(length_text(length, &files, text), expected);
}

TEST(lengths_have_the_unit_that_suits) {
    check_text(NULL, 0.01239, "0.0124");
    check_text("m", 0.01239, "12.4 mm");
    check_text("mm", 0.0124, "12.4 um");
    check_text("mm", 999.4, "999 mm");
    check_text("mm", 999.6, "1 m"); /* not 1e+03 mm, as three digits would have it */
    check_text("cm", 123456.0, "1.23 km");
    check_text("km", 5000.0, "5e+03 km");
    check_text("m", 0.0, "0 um");
    check_text("m", -0.25, "-250 mm");
    check_text("in", 1500.0, "1.5e+03 in");
    check_text("ft", 0.5, "0.5 ft");
}

/* Given in one unit for files of another one. */
TEST(lengths_are_converted) {
    static const struct {
        const char *text, *unit;
        double expected;
    } cases[] = {{"2", "mm", 2.0},     {"2", NULL, 2.0},      {"2mm", "m", 0.002},
                 {"2 mm", "m", 0.002}, {"3m", "mm", 3e3},     {"1in", "cm", 2.54},
                 {"1ft", "in", 12.0},  {"0.5km", "m", 500.0}, {"250um", "dm", 2.5e-3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        length_given given;
        length_unit files = {.name = NULL};
        io_error error;
        double length;
        assert_true(length_given_parse(cases[i].text, &given));
        if (cases[i].unit != NULL) assert_true(length_unit_from_name(cases[i].unit, &files));
        assert_true(length_given_convert(&given, &files, &length, &error));
        assert_true(fabs(length - cases[i].expected) <= 1e-12 * cases[i].expected);
    }
}

TEST(other_texts_are_no_lengths) {
    static const char *const texts[] = {"", "-1", "2 yd", "mm", "2mm ", "1e999", "nan"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        length_given given;
        assert_false(length_given_parse(texts[i], &given));
    }
}
