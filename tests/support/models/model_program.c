/* Chooses the program that run_tool runs: the tool, or one of models/. */
#include "tests/support/models/model_program.h"
#include "tests/support/test.h"

#include "tests/support/tool/run_tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *required_variable(const char *name) {
    const char *value = getenv(name);
    if (value == NULL) fail_msg("%s is not set; run the tests through tests/run.sh", name);
    return value;
}

void model_program_use(const char *name) {
    static char tool[4096];
    char path[4096];
    if (tool[0] == '\0') snprintf(tool, sizeof tool, "%s", required_variable("CSCD_TOOL"));
    if (name != NULL) snprintf(path, sizeof path, "%s/%s", required_variable("CSCD_MODELS"), name);
    setenv("CSCD_TOOL", name == NULL ? tool : path, 1);
}

void model_program_refuses(const char *name, int code, const char *text, const char *const *arguments) {
    model_program_use(name);
    tool_run run = run_tool(arguments);
    if (run.code != code || strstr(run.error, text) == NULL)
        fail_msg("%d, not %d with \"%s\": %s", run.code, code, text, run.error);
    assert_string_equal(run.out, "");
    assert_int_equal(strncmp(run.error, name, strlen(name)), 0);
    assert_int_equal(strncmp(run.error + strlen(name), ": ", 2), 0);
    assert_ptr_equal(strchr(run.error, '\n'), run.error + strlen(run.error) - 1);
    tool_run_free(&run);
}
