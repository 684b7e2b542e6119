/* Version 2 of the API keeps what it promises: values of enumerators, places and types of members, functions and their
 * types. The public headers are compared with api_frozen.txt, which make freeze-api writes. */
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdlib.h>

/* How many lines of the command's output begin with this sign; prints them all. */
static int count_lines(const char *lines, char sign) {
    int count = 0;
    for (const char *line = lines; *line != '\0';) {
        count += *line == sign;
        while (*line != '\0' && *line != '\n') line++;
        line += *line == '\n';
    }
    return count;
}

/* Places and sizes are those of 64-bit pointers; other processors compare the rest. */
static void headers_are_as_frozen(void **state) {
    (void)state;
    const char *layout = sizeof(void *) == 8 ? "no line" : "^. (member|struct) ";
    temp_folder folder = temp_folder_make();
    temp_path now = temp_file_path(&folder, "now.txt");
    shell("tests/install/api_headers.py print >'%s'", now.text);
    char *lines = shell_output(
        0, "diff tests/install/api_frozen.txt '%s' | grep '^[<>]' | grep -vE '%s' || true", now.text, layout);
    temp_folder_remove(&folder);
    if (count_lines(lines, '<') > 0)
        fail_msg(
            "what was frozen (<) has changed:\n%s\nBefore 2.0.0 is released, run make freeze-api; after it, "
            "take the change back: callers were compiled with what was there",
            lines);
    if (count_lines(lines, '>') > 0)
        fail_msg("there is more than was frozen; run make freeze-api:\n%s", lines);
    free(lines);
}

/* No struct ends in padding, and the library is told the size of every one that may grow. */
static void structs_can_grow(void **state) {
    (void)state;
    shell("tests/install/api_headers.py rules");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(headers_are_as_frozen),
                                       cmocka_unit_test(structs_can_grow)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
