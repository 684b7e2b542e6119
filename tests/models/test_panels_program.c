/* Runs the program `panels`, which is a caller in C++: it goes through, gives the same bits on any number of threads, and
 * sees what goes wrong. */
#include "tests/support/models/model_program.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <string.h>

static int use_program(void **state) {
    (void)state;
    model_program_use("panels");
    return 0;
}

/* The last line of what a run prints has a number for all positions. The first row after the seam is opened counts pairs
 * that waited, and the last one none. */
static void the_run_is_good_and_repeatable(void **state) {
    (void)state;
    size_t waiting = 0, at_end = 1;
    tool_run one = RUN_TOOL("--frames", "90", "--threads", "1"),
             three = RUN_TOOL("--frames", "90", "--threads", "3");
    assert_string_equal(one.error, "");
    assert_int_equal(one.code, 0);
    assert_int_equal(three.code, 0);
    const char *digest = strstr(one.out, "digest "), *opened = strstr(one.out, "the seam is opened\n");
    assert_non_null(digest);
    assert_non_null(opened);
    assert_int_equal(sscanf(opened,
                            "the seam is opened %*f %*f %% %*u %*f %zu %*u %*u %*f %*f %% %*u %*f %zu",
                            &waiting, &at_end),
                     2);
    assert_true(waiting > 0 && at_end == 0);
    assert_non_null(strstr(three.out, digest));
    assert_non_null(strstr(three.out, "ran tasks of cscd"));
    tool_run_free(&one);
    tool_run_free(&three);
}

/* Without certificates the ball goes through the cloth, and the program says so. */
static void faults_are_seen(void **state) {
    (void)state;
    tool_run run = RUN_TOOL("--frames", "60", "--uncertified");
    assert_int_equal(run.code, 1);
    assert_non_null(strstr(run.error, "panels: after "));
    tool_run_free(&run);
}

static void usage_is_checked(void **state) {
    (void)state;
    EXPECT_TOOL(0, "--help");
    EXPECT_TOOL(2, "--frames");
    EXPECT_TOOL(2, "--frames", "0");
    EXPECT_TOOL(2, "--side", "1000");
    EXPECT_TOOL(2, "--unknown", "1");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_run_is_good_and_repeatable),
                                       cmocka_unit_test(faults_are_seen), cmocka_unit_test(usage_is_checked)};
    return cmocka_run_group_tests_name("panels_program", tests, use_program, NULL);
}
