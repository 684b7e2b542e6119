/* A fixed amount of arithmetic that touches no memory: how fast the machine is at the moment. */
#include "benchmarks/fixed_arithmetic.h"

#include "src/timer.h"

enum { STEPS = 400000, CHAINS = 4 };

/* Four chains, so that it is bound by arithmetic and not by waiting for one result. */
double fixed_arithmetic(void) {
    double x[CHAINS] = {1.0, 2.0, 3.0, 4.0};
    for (int i = 0; i < STEPS; i++) {
        for (int k = 0; k < CHAINS; k++) x[k] = x[k] * 0.999 + 0.001;
    }
    return x[0] + x[1] + x[2] + x[3];
}

static volatile double result; /* wanted, as far as the compiler knows */

double fixed_arithmetic_ms(void) {
    double since = timer_now_ms(), spent = 0.0;
    result = fixed_arithmetic();
    timer_lap(&since, &spent);
    return spent;
}
