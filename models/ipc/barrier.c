/* The barrier of incremental potential contact: an energy that rises without bound as a distance goes to
 * 0. */
#include "models/ipc/barrier.h"

#include <math.h>

ipc_curve ipc_barrier(double distance, double reach) {
    if (distance >= reach) return (ipc_curve){0.0, 0.0, 0.0};
    if (distance <= 0.0) return (ipc_curve){INFINITY, -INFINITY, INFINITY};
    double beyond = distance - reach, logarithm = log(distance / reach), share = beyond / distance;
    return (ipc_curve){
        .value = -beyond * beyond * logarithm,
        .slope = -2.0 * beyond * logarithm - beyond * share,
        .curvature = -2.0 * logarithm - 4.0 * share + share * share,
    };
}

ipc_curve ipc_mollifier(double crossing, double threshold) {
    if (crossing >= threshold) return (ipc_curve){1.0, 0.0, 0.0};
    double share = crossing / threshold;
    return (ipc_curve){share * (2.0 - share), 2.0 * (1.0 - share) / threshold,
                       -2.0 / (threshold * threshold)};
}
