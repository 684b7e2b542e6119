/* A line on the terminal that says how far a long command is; silent elsewhere. */
#ifndef CSCD_PROGRESS_H
#define CSCD_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct progress {
    bool shown;
    double last_ms; /* of the last redraw */
} progress;

/* Shows only when stderr is a terminal and quiet is false. */
void progress_begin(progress *p, bool quiet);
void progress_update(progress *p, uint32_t done, uint32_t total, const char *what);
/* A text instead of the bar. */
void progress_say(progress *p, const char *text);
/* Clears the line. */
void progress_end(progress *p);

/* From now on Ctrl-C (SIGINT) and SIGTERM only set a flag, so that a command can finish its files. A second
 * one ends the program at once. */
void interrupt_catch(void);
bool interrupted(void);

#endif
