/* Elementary tests: do a moving vertex and face, or two moving edges, touch, and when? */
#pragma once

#include "cscd/detector.h"

#include <stdbool.h>

/* Two features of four points together, all moving linearly from x0 (t = 0) to x1 (t = 1).
 * VF: x[0] the vertex, x[1..3] the face. EE: x[0], x[1] the one edge, x[2], x[3] the other. */
typedef struct elementary_query {
    double x0[4][3], x1[4][3];
} elementary_query;

/* Returns how many of the four points belong to the first feature, as its vertex or as the ends of its edge.
 */
static inline int points_of_first(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? 1 : 2;
}

/* The points of a stencil are those of a vertex and a face, or of two edges, one point of which it may have several
 * times. */
static inline cscd_contact_kind stencil_points(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
}

/* The first touch. u, v, point and normal as in cscd_contact. */
typedef struct elementary_contact {
    double toi, u, v;
    double point[3], normal[3];
} elementary_contact;

/* The level that decided. Each level is certified, and the next one sees only what it left open. */
typedef enum elementary_level {
    ELEMENTARY_SIGNS, /* separating directions, signs of the coplanarity cubic */
    ELEMENTARY_ROOTS, /* intervals about its roots */
    ELEMENTARY_EXACT  /* exact arithmetic */
} elementary_level;

enum { ELEMENTARY_LEVEL_COUNT = 3 };

typedef struct elementary_verdict {
    bool touching;
    elementary_level level;
} elementary_verdict;

/* Decides pairs that the kernel of level one leaves undecided (see ccd_kernels.h). The result depends on
 * nothing but the query; *contact is written only when they touch. Features are closed, and so is the interval.
 */
elementary_verdict elementary_after_signs(const elementary_query *query, cscd_contact_kind kind,
                                          elementary_contact *contact);
