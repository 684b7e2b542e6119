/* The vector between two points that are named by weights of the four vertices of a pair. */
#include "runtime/ccd/connection.h"

#include "src/core/vec3.h"

void connection_between(const double *const x[4], const double weights[4], int own, double out[3]) {
    vec3_subtract(x[0], x[own], out);
    for (int i = 1; i < 4; i++) {
        const double *origin = i < own ? x[0] : x[own];
        if (i == own) continue;
        for (int k = 0; k < 3; k++) out[k] += weights[i] * (x[i][k] - origin[k]);
    }
}

double connection_length(const double vector[3]) {
    double largest = vec3_largest(vector), scaled[3];
    if (!(largest > 0.0)) return 0.0;
    for (int k = 0; k < 3; k++) scaled[k] = vector[k] / largest;
    return largest * sqrt(vec3_dot(scaled, scaled));
}
