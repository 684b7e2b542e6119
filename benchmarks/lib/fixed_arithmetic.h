/* A fixed amount of arithmetic that touches no memory: how fast the machine is at the moment. */
#pragma once

/* About a millisecond or two; the result is to be looked at, or the loop is optimised away. */
double fixed_arithmetic(void);

/* Milliseconds that it takes now. */
double fixed_arithmetic_ms(void);
