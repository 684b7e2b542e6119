/* Wall clock time, for what a program says of itself. */
#ifndef CSCD_MODELS_CLOCK_H
#define CSCD_MODELS_CLOCK_H

/* Milliseconds since some moment. */
double clock_now_ms(void);

#endif
