/* Why a run could not finish is said once, whether its two outputs go to one place or to two. */
#include "tests/support/own_folder.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static temp_path write_triangle(const char *name, const char *spoilt) {
    temp_path path = temp_file_path(&folder, name);
    FILE *file = fopen(path.text, "w");
    assert_non_null(file);
    fprintf(file, "v 0 0 0\nv 1 0 0\nv 0 1 0\n%sf 1 2 3\n", spoilt);
    assert_int_equal(fclose(file), 0);
    return path;
}

static size_t times_in(const char *text, const char *part) {
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at += strlen(part)) count++;
    return count;
}

/* Where both outputs go to one place, the first line gives the reason and that is enough; it is not lost where only one is kept. */
static void the_reason_is_said_once(void **state) {
    (void)state;
    static const char *const runs[] = {"", "--fail-on crossing", "--quiet", "2>/dev/null", ">/dev/null"};
    const temp_path good = write_triangle("f_1.obj", ""), bad = write_triangle("f_2.obj", "v 1 2 3\n");
    for (size_t i = 0; i < 2 * sizeof runs / sizeof *runs; i++) {
        char *text = shell_output(1, "{ \"$CSCD_TOOL\" %s '%s' '%s' '%s' %s; } 2>&1",
                                  i % 2 ? "replay" : "check", good.text, good.text, bad.text, runs[i / 2]);
        if (times_in(text, "holds 4 vertices") != 1) fail_msg("%s: %s", runs[i / 2], text);
        free(text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_reason_is_said_once)};
    return cmocka_run_group_tests(tests, own_folder_make, own_folder_remove);
}
