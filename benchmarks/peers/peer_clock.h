/* The clock of the programs that we are compared with: processor time, in which a crowded machine shows
 * less. */
#pragma once

#include <time.h>

/* Milliseconds of processor time of all threads of the process. */
static inline double peer_clock_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}
