/* Tests tests/run.sh itself: what it counts as passed and as failed, and how it treats recordings to
 * compare with. */
#include "tests/support/own_folder.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes a program that prints a text and ends with a status. */
static temp_path write_program(const char *name, const char *text, int status) {
    char script[512];
    int length = snprintf(script, sizeof script, "#!/bin/sh\necho '%s'\nexit %d\n", text, status);
    temp_path path = temp_file_write(&folder, name, script, (size_t)length);
    shell("chmod +x '%s'", path.text);
    return path;
}

/* Returns what the script prints for a program, with CSCD_DATA set by `data`; it must end with `code`. */
static char *run_script(int code, const char *data, const char *program) {
    return shell_output(code, "env -u CSCD_DATA %s BUILD='%s' tests/run.sh '%s'", data, folder.path, program);
}

static void expect_text(char *printed, const char *text) {
    if (strstr(printed, text) == NULL) fail_msg("printed\n%s\nwithout\n%s", printed, text);
    free(printed);
}

static void totals_are_added_up(void **state) {
    (void)state;
    temp_path good = write_program("good", "[  PASSED  ] 3 test(s).", 0);
    expect_text(run_script(0, "", good.text), "\n3 passed, 0 failed\n");
    temp_path bad = write_program("bad", "[  PASSED  ] 2 test(s).\n[  FAILED  ] 1 test(s), listed below:", 1);
    expect_text(run_script(1, "", bad.text), "/bad\n2 passed, 1 failed\n");
}

static void silence_is_a_failure(void **state) {
    (void)state;
    temp_path silent = write_program("silent", "", 0);
    expect_text(run_script(1, "", silent.text), "/silent\n0 passed, 1 failed\n");
    temp_path crashed = write_program("crashed", "[  PASSED  ] 3 test(s).", 134);
    expect_text(run_script(1, "", crashed.text), "/crashed\n3 passed, 1 failed\n");
    expect_text(run_script(1, "", "/no-such-program"), "0 passed, 1 failed\n");
}

static void no_program_is_a_failure(void **state) {
    (void)state;
    char *printed = shell_output(1, "BUILD='%s' tests/run.sh 2>&1", folder.path);
    expect_text(printed, "nothing is tested");
}

static void named_recordings_must_be_there(void **state) {
    (void)state;
    char data[512];
    temp_path good = write_program("good", "[  PASSED  ] 3 test(s).", 0);
    expect_text(run_script(0, "", good.text), "CSCD_DATA is not set, nothing to compare\n");
    snprintf(data, sizeof data, "CSCD_DATA='%s/no-such-folder'", folder.path);
    expect_text(run_script(1, data, good.text), "failed: check_recordings.py\n3 passed, 1 failed\n");
    snprintf(data, sizeof data, "CSCD_DATA='%s'", folder.path);
    expect_text(run_script(1, data, good.text), "failed: check_recordings.py\n3 passed, 1 failed\n");
}

static void slowest_programs_are_listed(void **state) {
    (void)state;
    static const char busy[] = "#!/bin/sh\ni=0\nwhile [ $i -lt 100000 ]; do i=$((i + 1)); done\n"
                               "echo '[  PASSED  ] 1 test(s).'\n";
    temp_path path = temp_file_write(&folder, "busy", busy, sizeof busy - 1);
    shell("chmod +x '%s'", path.text);
    char *printed = run_script(0, "", path.text), *list = strstr(printed, "slowest, in seconds"), name[300];
    double seconds;
    assert_non_null(list);
    assert_int_equal(sscanf(strchr(list, '\n'), "%lf %299s", &seconds, name), 2);
    assert_non_null(strstr(name, "/busy"));
    assert_true(seconds > 0.0);
    free(printed);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(totals_are_added_up, own_folder_make, own_folder_remove),
        cmocka_unit_test_setup_teardown(silence_is_a_failure, own_folder_make, own_folder_remove),
        cmocka_unit_test_setup_teardown(no_program_is_a_failure, own_folder_make, own_folder_remove),
        cmocka_unit_test_setup_teardown(named_recordings_must_be_there, own_folder_make, own_folder_remove),
        cmocka_unit_test_setup_teardown(slowest_programs_are_listed, own_folder_make, own_folder_remove),
    };
    return cmocka_run_group_tests_name("run script", tests, NULL, NULL);
}
