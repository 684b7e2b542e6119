/* When a frame fails by a depth: it passes only if no point can be deeper than is allowed. */
#include "tests/support/test.h"
#include "tool/answers/answers.h"

static void check_depth(double depth, double bound, const char *expected) {
    const fail_rules rules = {.options.depth.given = true, .depth = 1.0};
    const frame_answer frame = {
        .checked = true, .depth = depth, .bound = bound, .worst_parts = {NO_PART, NO_PART}};
    char text[FAIL_TEXT_SIZE];
    assert_int_equal(fail_rules_meet(&rules, NULL, &frame, text), expected != NULL);
    if (expected != NULL) assert_string_equal(text, expected);
}

TEST(what_may_be_deeper_fails) {
    check_depth(0.5, 0.75, NULL);
    check_depth(1.0, 1.0, NULL);
    check_depth(0.5, 1.25, "up to 1.25 deep");
    check_depth(1.0, 1.0 + 0x1p-52, "up to 1 deep");
    check_depth(1.5, 1.75, "1.5 deep");
}
