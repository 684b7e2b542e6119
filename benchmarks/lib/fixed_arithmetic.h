/* A fixed amount of arithmetic that touches no memory: how fast the machine is at the moment. */
#pragma once

/* Computes for a millisecond or two; use the result, or the loop is optimised away. */
double fixed_arithmetic(void);

/* Returns the milliseconds that it takes now. */
double fixed_arithmetic_ms(void);
