/* Wall clock time, for what a program says of itself. */
#pragma once

/* Milliseconds since some moment. */
double clock_now_ms(void);
