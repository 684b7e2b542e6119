/* The man pages have no warnings, and name every option of the tool and every function of the library, and
 * no others; its examples are those of --help, and none is refused. */
#include "tests/support/install/api_names.h"
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* Prints the text of cscd(1) without fonts, and a command's part of it. */
#define PLAIN_PAGE "sed -e 's/\\\\f.//g' -e 's/\\\\-/-/g' docs/man/cscd.1"
#define PART_OF    PLAIN_PAGE " | awk '/^\\.S[SH] / { in_part = $0 == \".SS cscd %s\" } in_part'"
/* Prints all names of options in a text, each once. */
#define NAMES "grep -oE '(^|[^-a-z])-(o\\b|-[a-z-]+)' | grep -oE -e '-.*' | LC_ALL=C sort -u"

/* Prints a command's examples as --help shows them: the command line, and below it what it does. */
#define EXAMPLES "\"$CSCD_TOOL\" %s --help | sed '/^$/,$d'"

static const char *const commands[] = {"preprocess", "replay", "report", "sense",
                                       "check",      "merge",  "info",   "render"};
enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

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
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
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
        shell_output(
            0,
            "{ \"$CSCD_TOOL\" --help; for command in preprocess replay report sense check merge info render; do "
            "\"$CSCD_TOOL\" $command --help; done; } | " NAMES));
}

static void examples_are_those_of_the_tool(void **state) {
    (void)state;
    char *page = shell_output(
        0,
        "sed -e 's/^\\.TP//' -e 's/\\\\(aq/'\\''/g' docs/man/cscd.1 | sed -e 's/\\\\f.//g' -e 's/\\\\-/-/g' | "
        "sed -n '/^\\.SH EXAMPLES/,/^\\.SH SEE/p' | grep -v -e '^\\.SH' -e '^$'");
    char *help = shell_output(0, "for command in preprocess replay report sense check merge info render; do "
                                 "\"$CSCD_TOOL\" $command --help | sed -e '/^$/,$d' -e 's/^ *//'; done");
    expect_equal("examples", page, help);
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        char *lines = shell_output(0, EXAMPLES " | grep -c '^  cscd %s '", commands[i], commands[i]);
        assert_string_equal(lines, "3\n");
        free(lines);
    }
}

/* In an empty folder an example ends with 1, because it finds no files; with 2, if its options do not exist, have
 * values that do not fit, or contradict each other. */
static void no_example_is_refused(void **state) {
    (void)state;
    temp_folder folder = temp_folder_make();
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        shell("tool=$(realpath \"$CSCD_TOOL\"); " EXAMPLES " | sed -n 's/^  cscd //p' | { cd '%s'; tried=0; "
              "while IFS= read -r line; do eval \"$tool $line\"; status=$?; "
              "[ $status = 1 ] || { echo \"cscd $line: ended with $status\"; exit 1; }; "
              "tried=$((tried + 1)); done; [ $tried = 3 ]; }",
              commands[i], folder.path);
    temp_folder_remove(&folder);
}

static void help_fits_a_terminal(void **state) {
    (void)state;
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        char *longer = shell_output(0, "\"$CSCD_TOOL\" %s --help | awk 'length > 110'", commands[i]);
        assert_string_equal(longer, "");
        free(longer);
    }
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
        cmocka_unit_test(examples_are_those_of_the_tool),
        cmocka_unit_test(no_example_is_refused),
        cmocka_unit_test(help_fits_a_terminal),
        cmocka_unit_test(functions_are_those_of_the_headers),
    };
    return cmocka_run_group_tests(tests, find_tool, NULL);
}
