/* Wall clock for the stage timings. */
#pragma once

#include <time.h>

/* Milliseconds since an arbitrary moment; never goes back. */
static inline double timer_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Adds the milliseconds since *since to *sum and moves *since to now. */
static inline void timer_lap(double *since, double *sum) {
    double now = timer_now_ms();
    *sum += now - *since;
    *since = now;
}
