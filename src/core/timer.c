/* Wall clock for the stage timings. */
#include "src/core/timer.h"

#include <time.h>

double timer_now_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

void timer_lap(double *since, double *sum) {
    double now = timer_now_ms();
    *sum += now - *since;
    *since = now;
}
