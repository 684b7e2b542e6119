/* What positions may hold. */
#include "src/positions.h"

#include <math.h>

static bool acceptable(double x) {
    double magnitude = fabs(x);
    return (magnitude <= 0x1p300 && magnitude >= 0x1p-300) || x == 0.0; /* false for NaN */
}

cscd_status positions_check(cscd_context *context, const double *positions, uint32_t vertex_count,
                            const char *name) {
    if (positions == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    for (size_t i = 0; i < (size_t)vertex_count * 3; i++) {
        if (acceptable(positions[i])) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s: vertex %zu has %c = %g, expected 0 or a magnitude from 2^-300 to 2^300",
                            name, i / 3, "xyz"[i % 3], positions[i]);
    }
    return CSCD_OK;
}
