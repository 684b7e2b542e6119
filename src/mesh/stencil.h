/* The weights of a stencil, which follow from kind, u and v alone. */
#pragma once

#include "cscd/solver.h"

/* The points of a stencil are those of a vertex and a face, or of two edges, one point of which it may have several
 * times. */
static inline cscd_contact_kind stencil_points(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
}

static inline void stencil_weights(cscd_contact_kind kind, double u, double v, double out[4]) {
    bool vf = kind == CSCD_CONTACT_VF, vh = kind == CSCD_CONTACT_VH;
    bool vertex_a = vf || vh || kind == CSCD_CONTACT_VV;
    bool vertex_b = vh || kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_EV;
    out[0] = vertex_a ? 1.0 : 1.0 - u;
    out[1] = vf ? u + v - 1.0 : vertex_a ? -1.0 : u;
    out[2] = vf ? -u : vertex_a ? 0.0 : vertex_b ? -1.0 : v - 1.0;
    out[3] = vertex_b ? 0.0 : -v;
}
