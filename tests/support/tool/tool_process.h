/* Runs the built tool on Windows with a console of its own: arguments in; exit code and what it says about errors out. */
#pragma once

#include <sys/types.h>

typedef struct tool_run {
    int code;
    char *error; /* the caller frees it */
} tool_run;

/* The tool while it runs. */
typedef struct tool_process {
    pid_t pid;      /* the handle of the process, which fits */
    int out, error; /* open files */
} tool_process;

/* Starts the tool, the file that the environment variable CSCD_TOOL names; arguments end with NULL and leave out its own name. Its
 * console has no window; its events come to the tool alone. The test fails when the tool cannot be started. */
tool_process tool_process_start(const char *const *arguments);
tool_run tool_process_finish(tool_process *process);
