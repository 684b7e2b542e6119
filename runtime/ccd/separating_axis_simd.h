/* Separating axes of many pairs. The twin of separated_by_axes in separating_axis.c, with the same verdicts:
 * comparisons are exact. */
#pragma once

#include "runtime/ccd/feature_pairs_simd.h"

/* Lanes whose features lie beyond each other along an axis, on the same side at both ends. */
static inline uint32_t separated_by_axes_x8(const points_x8 *p, cscd_contact_kind kind) {
    uint32_t apart = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t before = ALL_WIDTH, beyond = ALL_WIDTH;
        for (int end = 0; end < 2; end++) {
            const f64w(*x)[3] = end == 0 ? p->x0 : p->x1;
            f64w a_low = x[0][k], a_high = x[0][k];
            f64w b_low = f64w_min(x[2][k], x[3][k]), b_high = f64w_max(x[2][k], x[3][k]);
            if (kind == CSCD_CONTACT_EE) {
                a_low = f64w_min(x[0][k], x[1][k]);
                a_high = f64w_max(x[0][k], x[1][k]);
            } else {
                b_low = f64w_min(x[1][k], b_low);
                b_high = f64w_max(x[1][k], b_high);
            }
            before &= f64w_below(a_high, b_low);
            beyond &= f64w_below(b_high, a_low);
        }
        apart |= before | beyond;
    }
    return apart;
}
