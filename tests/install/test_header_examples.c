/* The examples in the comments of the public headers compile without warnings, run, and print what they say. */
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static void examples_run(void **state) {
    (void)state;
    const char *tool = getenv("CSCD_TOOL");
    if (tool == NULL) fail_msg("CSCD_TOOL must name the built tool; run the tests through tests/run.sh");
    temp_folder folder = temp_folder_make();
    const char *gsl = strstr(tool, "-without-gsl") == NULL ? "-lgsl" : "";
    char *said = shell_output(
        0,
        "python3 tests/install/header_examples.py '%s' \"$(dirname '%s')/libcscd.a\" %s -llapacke -lopenblas -lm -pthread",
        folder.path, tool, gsl);
    assert_non_null(strstr(said, " 0 bad"));
    free(said);
    shell("rm -rf '%s'", folder.path);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(examples_run)};
    return cmocka_run_group_tests_name("header_examples", tests, NULL, NULL);
}
