/* Runs the built tool as a user would: arguments in; exit code, both outputs and peak memory out. */
#pragma once

#include <stddef.h>
#include <sys/types.h>

typedef struct tool_run {
    int code; /* exit code; 128 + signal when a signal ended it */
    char *out, *error;
    size_t out_size;
    long peak_kib; /* resident; never below that of the test program, which the tool starts as a copy of */
} tool_run;

/* The tool is the file that the environment variable CSCD_TOOL names. Arguments end with NULL and leave out
 * the tool's own name. The test fails when the tool cannot be started. */
tool_run run_tool(const char *const *arguments);
void tool_run_free(tool_run *run);

#define RUN_TOOL(...) run_tool((const char *const[]){__VA_ARGS__, NULL})

/* Runs, compares the exit code and frees; on a difference it prints both outputs and fails the test. */
void run_tool_expect(int code, const char *const *arguments);

#define EXPECT_TOOL(code, ...) run_tool_expect((code), (const char *const[]){__VA_ARGS__, NULL})

/* Runs; the exit code is `code`, and stderr holds all texts (up to NULL), on one "cscd: " line unless it is a
 * usage error, which adds a line about --help. */
void run_tool_expect_error(int code, const char *const *texts, const char *const *arguments);

#define TEXTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define EXPECT_ERROR(code, texts, ...)                                                                       \
    run_tool_expect_error((code), (texts), (const char *const[]){__VA_ARGS__, NULL})

/* The same in two steps, so that a test can act while the tool runs. */
typedef struct tool_process {
    pid_t pid;
    int out, error; /* open files */
} tool_process;

tool_process run_tool_start(const char *const *arguments);
tool_run run_tool_finish(tool_process *process);

/* A whole file as a string, to be freed; the test fails when it cannot be read. size may be NULL. */
char *read_whole_file(const char *path, size_t *size);
