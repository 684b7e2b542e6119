/* Runs the built tool as a user would: arguments in; exit code, both outputs and peak memory out. */
#pragma once

#include <stddef.h>
#include <sys/types.h>

typedef struct tool_run {
    int code; /* exit code; 128 + signal when a signal ended it */
    char *out, *error;
    size_t out_size;
    long peak_kib; /* resident; at least that of the test program, since the tool starts as its copy */
} tool_run;

/* Runs the tool, the file that the environment variable CSCD_TOOL names. Arguments end with NULL and leave
 * out the tool's own name. The test fails when the tool cannot be started. */
tool_run run_tool(const char *const *arguments);
void tool_run_free(tool_run *run);

#define RUN_TOOL(...) run_tool((const char *const[]){__VA_ARGS__, NULL})

/* Runs the tool and compares the exit code; on a difference it prints both outputs and fails the test. */
void run_tool_expect(int code, const char *const *arguments);

#define EXPECT_TOOL(code, ...) run_tool_expect((code), (const char *const[]){__VA_ARGS__, NULL})

/* Runs the tool and expects the exit code `code` and all texts, a list up to NULL, on stderr. They must
 * stand on one "cscd: " line unless it is a usage error, which adds a line about --help. */
void run_tool_expect_error(int code, const char *const *texts, const char *const *arguments);

#define TEXTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define EXPECT_ERROR(code, texts, ...)                                                                       \
    run_tool_expect_error((code), (texts), (const char *const[]){__VA_ARGS__, NULL})

/* Fails the test unless the text has this part, or begins with it. */
void expect_in(const char *text, const char *part);
void expect_start(const char *text, const char *part);

/* These functions run the tool in two steps, so that a test can act while it runs. */
typedef struct tool_process {
    pid_t pid;      /* on Windows the handle of the process, which fits */
    int out, error; /* open files */
} tool_process;

tool_process run_tool_start(const char *const *arguments);
tool_run run_tool_finish(tool_process *process);

/* On Windows: with a console of its own, which has no window, and so with its events; those of run_tool_start hear no Ctrl-C. */
tool_process run_tool_start_in_console(const char *const *arguments);

/* For the file that starts processes: what CSCD_TOOL names, and the exit code of a tool that could not be started. */
enum { RUN_TOOL_NOT_STARTED = 127 };
const char *run_tool_path(void);
/* Waits for its end, and fills in exit code and peak. */
void run_tool_wait(const tool_process *process, tool_run *run);

/* Reads a whole file as a string, which the caller frees; the test fails when it cannot be read. size may
 * be NULL. */
char *read_whole_file(const char *path, size_t *size);
