/* A fixed amount of arithmetic that touches no memory: how fast the machine is at the moment. */
#include "benchmarks/lib/fixed_arithmetic.h"

#include "src/core/timer.h"

enum { STEPS = 100000, CHAINS = 24 };

/* This many chains keep all units busy, so that the time also shows when another processor shares them.
 * With few chains it would wait for results and take the same time whatever the neighbour does. */
double fixed_arithmetic(void) {
    double x[CHAINS], sum = 0.0;
    for (int k = 0; k < CHAINS; k++) x[k] = k;
    for (int i = 0; i < STEPS; i++) {
        for (int k = 0; k < CHAINS; k++) x[k] = x[k] * 0.999 + 0.001;
    }
    for (int k = 0; k < CHAINS; k++) sum += x[k];
    return sum;
}

static volatile double result; /* keeps the compiler from dropping the loop */

double fixed_arithmetic_ms(void) {
    double since = timer_now_ms(), spent = 0.0;
    result = fixed_arithmetic();
    timer_lap(&since, &spent);
    return spent;
}
