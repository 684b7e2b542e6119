/* A line on the terminal that shows how far a long command is, and signals that interrupt it. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct terminal_progress {
    bool shown;
    double last_ms; /* of the last redraw */
} terminal_progress;

/* The line is shown only if stderr is a terminal and quiet is false. */
void terminal_progress_begin(terminal_progress *p, bool quiet);
void terminal_progress_update(terminal_progress *p, uint32_t done, uint32_t total, const char *what);
/* A text instead of the bar. */
void terminal_progress_say(terminal_progress *p, const char *text);
/* Clears the line. */
void terminal_progress_end(terminal_progress *p);

/* From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP only set a flag, so that a command can finish its files. A second
 * one ends the program at once. A SIGHUP that is ignored, as nohup has it, stays ignored. */
void interrupt_catch(void);
/* The same, but no signal ends the process: for one that is told to stop by the process that started it, and dies with it. */
void interrupt_outlast(void);
bool interrupted(void);

/* 128 and the number of the signal, as shells have it: 130, 143, 129. Only after an interrupt. */
int interrupt_exit_code(void);

/* Says on stderr how far an interrupted command came, and which files have that much. done: of frames or
 * intervals; first and last: the numbers of the frames at its ends. Paths may be NULL. */
typedef struct interrupt_kept {
    uint32_t done, whole;
    const char *what; /* "frames" */
    int32_t first, last;
    const char *const *paths;
    size_t path_count;
} interrupt_kept;
void interrupt_tell(const interrupt_kept *kept);
