/* Orientation of triangles as seen from a detector point during a whole interval. */
#include "runtime/orientation.h"

#include "runtime/coplanarity.h"

#include <string.h>

/* (p0 - d) . n is, but for its sign, the volume of the tetrahedron of the triangle and d: the coplanarity
 * cubic of a vertex d and the face, with that cubic's error bound. */
uint8_t orientation_of(const uint32_t corners[3], const double *x0, const double *x1, const moving_point *d) {
    elementary_query query;
    point_vectors vectors;
    memcpy(query.x0[0], d->start, sizeof query.x0[0]);
    memcpy(query.x1[0], d->end, sizeof query.x1[0]);
    for (int i = 0; i < 3; i++) {
        memcpy(query.x0[i + 1], x0 + (size_t)corners[i] * 3, sizeof query.x0[0]);
        memcpy(query.x1[i + 1], x1 + (size_t)corners[i] * 3, sizeof query.x1[0]);
    }
    point_vectors_from(&query, 1, &vectors);
    coplanarity f = coplanarity_cubic(&vectors);
    if (!coplanarity_excluded(&f)) return ORIENTATION_ZERO;
    return f.b[0] < 0.0 ? ORIENTATION_PLUS : ORIENTATION_MINUS;
}
