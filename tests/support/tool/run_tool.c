/* Runs the built tool as a user would: arguments in; exit code, both outputs and peak memory out. */
#include "tests/support/tool/run_tool.h"
#include "tests/support/test.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *run_tool_path(void) {
    const char *path = getenv("CSCD_TOOL");
    if (path == NULL || access(path, X_OK) != 0)
        fail_msg("CSCD_TOOL must name the built tool, but is %s; run the tests through tests/run.sh",
                 path != NULL ? path : "not set");
    return path;
}

static char *read_capture(int descriptor, size_t *size) {
    off_t end = lseek(descriptor, 0, SEEK_END);
    assert_true(end >= 0);
    char *text = malloc((size_t)end + 1);
    assert_non_null(text);
    assert_int_equal(pread(descriptor, text, (size_t)end, 0), end);
    text[end] = '\0';
    close(descriptor);
    if (size != NULL) *size = (size_t)end;
    return text;
}

tool_run run_tool_finish(tool_process *process) {
    tool_run run = {.code = 0};
    run_tool_wait(process, &run);
    run.out = read_capture(process->out, &run.out_size);
    run.error = read_capture(process->error, NULL);
    if (run.code == RUN_TOOL_NOT_STARTED) fail_msg("the tool %s cannot be started", run_tool_path());
    return run;
}

tool_run run_tool(const char *const *arguments) {
    tool_process process = run_tool_start(arguments);
    return run_tool_finish(&process);
}

void tool_run_free(tool_run *run) {
    free(run->out);
    free(run->error);
    *run = (tool_run){0};
}

static void require_that(bool holds, const char *what, const tool_run *run) {
    if (holds) return;
    fail_msg("%s\nexit code %d\nstdout: %s\nstderr: %s", what, run->code, run->out, run->error);
}

void run_tool_expect(int code, const char *const *arguments) {
    char what[64];
    tool_run run = run_tool(arguments);
    snprintf(what, sizeof what, "expected exit code %d", code);
    require_that(run.code == code, what, &run);
    tool_run_free(&run);
}

static int count_lines(const char *text) {
    int lines = 0;
    for (; *text != '\0'; text++) lines += *text == '\n';
    return lines;
}

void run_tool_expect_error(int code, const char *const *texts, const char *const *arguments) {
    char what[256];
    tool_run run = run_tool(arguments);
    snprintf(what, sizeof what, "expected exit code %d", code);
    require_that(run.code == code, what, &run);
    require_that(strncmp(run.error, "cscd: ", 6) == 0, "expected 'cscd: ' first", &run);
    require_that(count_lines(run.error) == (code == 2 ? 2 : 1), "expected one line", &run);
    require_that(code != 2 || strstr(run.error, "--help'") != NULL, "expected a hint to --help", &run);
    for (; *texts != NULL; texts++) {
        snprintf(what, sizeof what, "expected '%s' in the error", *texts);
        require_that(strstr(run.error, *texts) != NULL, what, &run);
    }
    tool_run_free(&run);
}

char *read_whole_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) fail_msg("cannot open %s", path);
    int descriptor = dup(fileno(file));
    fclose(file);
    return read_capture(descriptor, size);
}

void expect_in(const char *text, const char *part) {
    if (strstr(text, part) == NULL) fail_msg("expected '%s' in: %s", part, text);
}

void expect_start(const char *text, const char *part) {
    if (strncmp(text, part, strlen(part)) != 0) fail_msg("expected '%s' first in: %s", part, text);
}
