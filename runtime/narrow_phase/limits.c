/* The limits of searches: how near is near, and how exactly. */
#include "runtime/narrow_phase/limits.h"

#include "src/core/check.h"

cscd_status separation_check(cscd_context *context, double min_separation, double tolerance) {
    if (!is_length(min_separation))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "min_separation is %g, expected 0 or a length from 2^-300 to 2^300",
                            min_separation);
    if (!(tolerance >= 0.0 && tolerance <= 1.0))
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "tolerance is %g, expected a share in (0,1] of min_separation, or 0 for 1e-6",
                            tolerance);
    return CSCD_OK;
}

separation separation_limit(double distance, double tolerance) {
    return (separation){distance, (tolerance > 0.0 ? tolerance : 1e-6) * distance};
}

separation proximity_limit(double distance) {
    const double relative_tolerance = 0x1p-21; /* half of what is promised: the distance is rounded, too */
    return (separation){distance, relative_tolerance * distance};
}
