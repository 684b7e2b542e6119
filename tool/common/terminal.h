/* A line on the terminal that shows how far a long command is, and signals that interrupt it. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct terminal_progress {
    bool shown;
    bool may_stop; /* does an interrupt end the call of the library that runs? See terminal_progress_within */
    double last_ms, begun_ms; /* of the last redraw, and of the last update */
    uint32_t done, total;     /* of the last update */
    const char *what;
} terminal_progress;

/* True if standard output and standard error go to one terminal, file or pipe. */
bool terminal_outputs_are_one(void);

/* The line is shown only if stderr is a terminal and quiet is false. */
void terminal_progress_begin(terminal_progress *p, bool quiet);
void terminal_progress_update(terminal_progress *p, uint32_t done, uint32_t total, const char *what);
/* The callback of a context (cscd_progress), whose user is the line: shows behind the bar how far a call
 * is that takes long, and ends it when an interrupt has come and it may stop; then interrupt_ended_wait
 * is true. */
bool terminal_progress_within(void *line, const char *stage, double fraction);
/* A text instead of the bar. */
void terminal_progress_say(terminal_progress *p, const char *text);
/* Clears the line. */
void terminal_progress_end(terminal_progress *p);

/* From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP only set a flag, so that a command can finish its files,
 * and end a wait for the other side of a pipe. A second one ends the program at once. Those that are ignored,
 * as nohup has it with SIGHUP and a shell with SIGINT of what runs in its background, stay ignored. */
void interrupt_catch(void);
/* The same, but no signal ends the process: for one that is told to stop by the process that started it, and
 * dies with it. */
void interrupt_outlast(void);
bool interrupted(void);

/* Asked by whoever waits for a file: is the wait to end, because an interrupt has come? */
bool interrupt_ends_wait(void);
/* True if an interrupt has ended a wait. It is no fault then that nothing came. */
bool interrupt_ended_wait(void);

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
