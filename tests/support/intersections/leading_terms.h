/* The leading terms of all determinants of a few moved points: polynomials in epsilon as in docs/theory/curves.md, written
 * out, of which only the term with the least power is kept. Each is computed once and looked up after, so that millions of
 * scenes can be compared. It shares no code with src/mesh/symbolic.c, and none with epsilon_polynomial.h. */
#pragma once

#include <stdint.h>

enum { LEADING_POINTS = 20, LEADING_QUADRUPLES = 4845, LEADING_TRIPLES = 1140 };

/* coefficient * epsilon^power, the coefficient not 0. */
typedef struct leading_term {
    uint64_t power;
    __int128 coefficient;
} leading_term;

/* Points by their names, with integers below 2^28 in magnitude as coordinates. */
typedef struct leading_terms {
    int64_t points[LEADING_POINTS][3];
    leading_term spatial[LEADING_QUADRUPLES],
        flat[3][LEADING_TRIPLES]; /* a coefficient of 0: not known yet */
} leading_terms;

/* Forgets all terms; the points follow. */
void leading_terms_clear(leading_terms *t);

/* Of (b - a) x (c - a) . (d - a), the names all different. */
leading_term leading_orient3d(leading_terms *t, const uint32_t names[4]);

/* The sign of (b - a) x (c - a) in the projection along an axis. */
int leading_orient_along(leading_terms *t, const uint32_t names[3], int axis);

static inline int leading_sign(leading_term term) {
    return term.coefficient > 0 ? 1 : -1;
}
