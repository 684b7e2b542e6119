/* Sums and products of two doubles with what rounding takes from them: exact, since both together are the result. For
 * coordinates as src/mesh/predicates.h allows them, and products of three of these. */
#pragma once

/* sum + error = a + b exactly, |a| >= |b| or a = 0 (Dekker). */
static inline void fast_two_sum(double a, double b, double *sum, double *error) {
    double s = a + b;

    *error = b - (s - a);
    *sum = s;
}

/* sum + error = a + b exactly (Knuth). */
static inline void two_sum(double a, double b, double *sum, double *error) {
    double s = a + b;
    double b_part = s - a;
    double a_part = s - b_part;

    *error = (a - a_part) + (b - b_part);
    *sum = s;
}

/* high + low = a, 26 bits each (Veltkamp). */
static inline void split_double(double a, double *high, double *low) {
    double scaled = 134217729.0 * a; /* 2^27 + 1 */

    *high = scaled - (scaled - a);
    *low = a - *high;
}

/* product + error = a * b exactly (Dekker), with b split by the caller. fma() is slower on processors that
 * lack the instruction. */
static inline void two_product(double a, double b, double b_high, double b_low, double *product,
                               double *error) {
    double p = a * b;
    double a_high, a_low;

    split_double(a, &a_high, &a_low);
    *error = a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low);
    *product = p;
}
