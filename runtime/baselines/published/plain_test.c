/* The elementary test as such codes have it: the real roots of the coplanarity cubic in plain doubles, and an inside test at each. */
#include "runtime/baselines/published/plain_test.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"

/* Returns how many there are, ascending. A leading coefficient of 0 leaves a quadratic; without any coefficient the points are always
 * coplanar, and there is none. */
static int find_roots(const plain_cubic_functions *roots, const double b[4], double t[3]) {
    const double c1 = 3.0 * (b[1] - b[0]), c2 = 3.0 * (b[0] - 2.0 * b[1] + b[2]),
                 c3 = (b[3] - b[0]) + 3.0 * (b[1] - b[2]);
    if (c3 == 0.0) return roots->quadratic(c2, c1, b[0], &t[0], &t[1]);
    return roots->cubic(c2 / c3, c1 / c3, b[0] / c3, &t[0], &t[1], &t[2]);
}

static void blend_vectors(const double ends[2][3], double t, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (1.0 - t) * ends[0][k] + t * ends[1][k];
}

/* Cramer's rule in the plane that the features are largest in; the parameters are those of inside_test.c. */
static bool touch_at(const point_vectors *vectors, cscd_contact_kind kind, double t) {
    double a[3], b[3], c[3], normal[3];
    blend_vectors(vectors->a, t, a);
    blend_vectors(vectors->b, t, b);
    blend_vectors(vectors->c, t, c);
    vec3_cross(a, b, normal);
    int k = 0;
    for (int i = 1; i < 3; i++) k = fabs(normal[i]) > fabs(normal[k]) ? i : k;
    const int y = (k + 1) % 3, z = (k + 2) % 3;
    const double w = normal[k];
    if (w == 0.0) return false;
    const double u = (c[y] * b[z] - c[z] * b[y]) / w;
    const double v = (kind == CSCD_CONTACT_VF ? a[y] * c[z] - a[z] * c[y] : c[y] * a[z] - c[z] * a[y]) / w;
    return u >= 0.0 && v >= 0.0 && (kind == CSCD_CONTACT_VF ? u + v <= 1.0 : u <= 1.0 && v <= 1.0);
}

bool plain_test(const plain_cubic_functions *roots, const elementary_query *query, cscd_contact_kind kind,
                elementary_contact *contact) {
    point_vectors vectors;
    double t[3];
    point_vectors_from(query, kind, &vectors);
    const coplanarity f = coplanarity_cubic(&vectors);
    const int count = find_roots(roots, f.b, t);
    for (int i = 0; i < count; i++) {
        if (!(t[i] >= 0.0 && t[i] <= 1.0) || !touch_at(&vectors, kind, t[i])) continue;
        contact_frame_describe(query, kind, &f, t[i], contact);
        return true;
    }
    return false;
}
