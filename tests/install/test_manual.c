/* The man pages have no warnings, and name every option of the tool and every function of the library, and
 * no others. */
#include "tests/support/install/api_names.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* Prints the text of cscd(1) without fonts, and a command's part of it. */
#define PLAIN_PAGE "sed -e 's/\\\\f.//g' -e 's/\\\\-/-/g' docs/man/cscd.1"
#define PART_OF    PLAIN_PAGE " | awk '/^\\.S[SH] / { in_part = $0 == \".SS cscd %s\" } in_part'"
/* Prints all names of options in a text, each once. */
#define NAMES "grep -oE '(^|[^-a-z])-(o\\b|-[a-z-]+)' | grep -oE -e '-.*' | LC_ALL=C sort -u"

static int find_tool(void **state) {
    (void)state;
    if (getenv("CSCD_TOOL") != NULL) return 0;
    print_error("CSCD_TOOL must name the built tool; run the tests through tests/run.sh\n");
    return -1;
}

static void expect_equal(const char *what, char *page, char *truth) {
    if (strcmp(page, truth) != 0) fail_msg("%s: the page has\n%s\nbut there are\n%s", what, page, truth);
    assert_true(page[0] != '\0');
    free(page);
    free(truth);
}

static void pages_have_no_warnings(void **state) {
    (void)state;
    char *warnings = shell_output(0, "groff -man -ww -z docs/man/cscd.1 docs/man/cscd.3");
    assert_string_equal(warnings, "");
    free(warnings);
}

static void commands_are_those_of_the_tool(void **state) {
    (void)state;
    expect_equal("commands", shell_output(0, "sed -n 's/^\\.SS cscd //p' docs/man/cscd.1"),
                 shell_output(0, "\"$CSCD_TOOL\" --help | sed -n 's/^  \\([a-z]*\\) .*/\\1/p'"));
    expect_equal(
        "exit codes",
        shell_output(0, "sed -n '/^\\.SH EXIT/,/^\\.SH EX[^I]/s/^\\.B \\([0-9]*\\)$/\\1/p' docs/man/cscd.1"),
        shell_output(0, "\"$CSCD_TOOL\" --help | sed -n 's/^exit: //p' | grep -oE '(^|, )[0-9]+' | "
                        "tr -d ', '"));
}

static void options_are_those_of_the_tool(void **state) {
    (void)state;
    static const char *const commands[] = {"preprocess", "replay", "sense", "check", "info", "render"};
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        const char *name = commands[i];
        expect_equal(name, shell_output(0, PART_OF " | " NAMES, name),
                     shell_output(0, "\"$CSCD_TOOL\" %s --help | " NAMES, name));
        /* Lists options with their arguments as --help does: two spaces end an option. */
        char *missing =
            shell_output(0,
                         "\"$CSCD_TOOL\" %s --help | sed -n 's/^  \\(-.*\\)/\\1/p' | sed 's/  .*//' | "
                         "while IFS= read -r option; do " PART_OF " | grep -qxFe \"$option\" || "
                         "echo \"$option\"; done",
                         name, name);
        if (missing[0] != '\0') fail_msg("cscd %s: not in its man page:\n%s", name, missing);
        free(missing);
    }
}

/* Options in examples exist, too. */
static void no_option_is_made_up(void **state) {
    (void)state;
    expect_equal(
        "options", shell_output(0, PLAIN_PAGE " | " NAMES),
        shell_output(0,
                     "{ \"$CSCD_TOOL\" --help; for command in preprocess replay sense check info render; do "
                     "\"$CSCD_TOOL\" $command --help; done; } | " NAMES));
}

static void functions_are_those_of_the_headers(void **state) {
    (void)state;
    static const char *const headers[] = {"context.h", "mesh.h",     "plan.h",    "detector.h",
                                          "solver.h",  "research.h", "sensors.h", "cscd.h"};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        expect_equal(headers[i],
                     shell_output(0,
                                  "awk '/^\\.S[SH] / { in_part = $0 == \".SS <cscd/%s>\" } in_part' "
                                  "docs/man/cscd.3 | "
                                  "sed -n 's/^\\\\fB\\(cscd_[a-z_0-9]*\\)\\\\fR(.*/\\1/p' | LC_ALL=C sort",
                                  headers[i]),
                     api_functions(headers[i]));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_have_no_warnings),
        cmocka_unit_test(commands_are_those_of_the_tool),
        cmocka_unit_test(options_are_those_of_the_tool),
        cmocka_unit_test(no_option_is_made_up),
        cmocka_unit_test(functions_are_those_of_the_headers),
    };
    return cmocka_run_group_tests(tests, find_tool, NULL);
}
