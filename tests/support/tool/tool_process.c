/* The process of the tool: fork and exec. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { ARGUMENTS_MAX = 2048 };

/* Opens a file without a name. */
static int open_capture(void) {
    FILE *file = tmpfile();
    assert_non_null(file);
    int descriptor = dup(fileno(file));
    assert_true(descriptor >= 0);
    fclose(file);
    return descriptor;
}

/* Whoever runs the tests in the background, or by nohup, ignores some of these. */
static const int interrupts[] = {SIGINT, SIGTERM, SIGHUP};

tool_process run_tool_start(const char *const *arguments) {
    const char *path = run_tool_path();
    char *list[ARGUMENTS_MAX] = {strdup("cscd")};
    int count = 1;
    for (; arguments[count - 1] != NULL; count++) {
        assert_true(count + 1 < ARGUMENTS_MAX);
        list[count] = strdup(arguments[count - 1]);
    }
    tool_process process = {.out = open_capture(), .error = open_capture()};
    fflush(NULL);
    process.pid = fork();
    assert_true(process.pid >= 0);
    if (process.pid == 0) {
        for (size_t i = 0; i < sizeof interrupts / sizeof *interrupts; i++) signal(interrupts[i], SIG_DFL);
        dup2(process.out, STDOUT_FILENO);
        dup2(process.error, STDERR_FILENO);
        execv(path, list);
        _exit(RUN_TOOL_NOT_STARTED);
    }
    for (int i = 0; i < count; i++) free(list[i]);
    return process;
}

void run_tool_wait(const tool_process *process, tool_run *run) {
    int status = 0;
    struct rusage usage = {0};
    assert_int_equal(wait4(process->pid, &status, 0, &usage), process->pid);
    run->code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    run->peak_kib = usage.ru_maxrss;
}
