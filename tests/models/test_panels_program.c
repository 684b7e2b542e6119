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

/* In the row after `event` pairs wait, and in the one after that none. */
static void expect_waiting(const char *printed, const char *event) {
    size_t waiting = 0, then = 1;
    const char *rows = strstr(printed, event);
    assert_non_null(rows);
    assert_int_equal(sscanf(rows + strlen(event), "%*f %*f %% %*u %*f %zu %*u %*u %*f %*f %% %*u %*f %zu",
                            &waiting, &then),
                     2);
    assert_true(waiting > 0 && then == 0);
}

/* The last line of what a run prints has a number for all positions. */
static void the_run_is_good_and_repeatable(void **state) {
    (void)state;
    tool_run one = RUN_TOOL("--frames", "135", "--threads", "1"),
             three = RUN_TOOL("--frames", "135", "--threads", "3");
    assert_string_equal(one.error, "");
    assert_int_equal(one.code, 0);
    assert_int_equal(three.code, 0);
    expect_waiting(one.out, "the seam is opened\n");
    expect_waiting(one.out, "the right panel tears: 8 vertices more\n");
    const char *digest = strstr(one.out, "digest ");
    assert_non_null(digest);
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
