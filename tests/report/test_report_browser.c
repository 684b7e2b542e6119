/* Runs the scenarios of tests/report: reports of recordings are decoded by other code and used in a real
 * browser, one test each. */
#include "tests/support/shell.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCENARIOS_MAX = 200 };

static const char runner[] = "/usr/bin/python3 tests/report/run.py";
static temp_folder folder;
static char *printed; /* the output of all scenarios */

/* Returns the length of the path of the tool's build folder. */
static int build_length(void) {
    const char *tool = getenv("CSCD_TOOL");
    if (tool == NULL) fail_msg("CSCD_TOOL must name the built tool; run the tests through tests/run.sh");
    return (int)(strrchr(tool, '/') - tool);
}

/* One browser serves all scenarios, so they run before the tests, which report how each ended. */
static int run_all(void **state) {
    (void)state;
    folder = temp_folder_make();
    printed = shell_output(0, "BUILD='%.*s' %s '%s' || true", build_length(), getenv("CSCD_TOOL"), runner,
                           folder.path);
    fputs(printed, stdout);
    return 0;
}

static int remove_all(void **state) {
    (void)state;
    free(printed);
    shell("rm -rf '%s'", folder.path);
    return 0;
}

/* A scenario that ran has left a log, which is empty when nothing went wrong. */
static void scenario_passes(void **state) {
    char name[128];
    snprintf(name, sizeof name, "%s.log", (const char *)*state);
    temp_path path = temp_file_path(&folder, name);
    FILE *log = fopen(path.text, "r");
    if (log == NULL) fail_msg("it did not run; the runner printed:\n%s", printed);
    fclose(log);
    char *text = read_whole_file(path.text, NULL);
    if (text[0] != '\0') fail_msg("%s", text);
    free(text);
}

int main(void) {
    struct CMUnitTest tests[SCENARIOS_MAX];
    size_t count = 0;
    FILE *list = popen("/usr/bin/python3 tests/report/run.py --list", "r");
    if (list == NULL) return 1;
    char *line = NULL;
    size_t capacity = 0;
    for (ssize_t length; count < SCENARIOS_MAX && (length = getline(&line, &capacity, list)) > 1;) {
        line[length - 1] = '\0';
        char *name = strdup(line);
        tests[count++] = (struct CMUnitTest){name, scenario_passes, NULL, NULL, name};
    }
    free(line);
    if (pclose(list) != 0 || count == 0 || count == SCENARIOS_MAX) {
        fprintf(stderr, "tests/report/run.py --list gave %zu scenarios\n", count);
        return 1;
    }
    int failed = _cmocka_run_group_tests("report in a browser", tests, count, run_all, remove_all);
    for (size_t i = 0; i < count; i++) free(tests[i].initial_state);
    return failed;
}
