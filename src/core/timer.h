/* Wall clock for the stage timings. */
#pragma once

/* Milliseconds since an arbitrary moment; never goes back. */
double timer_now_ms(void);

/* Adds the milliseconds since *since to *sum and moves *since to now. */
void timer_lap(double *since, double *sum);
