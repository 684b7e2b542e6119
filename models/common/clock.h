/* Wall clock time, for the summaries of programs. */
#pragma once

/* Milliseconds since some fixed moment. */
double clock_now_ms(void);
