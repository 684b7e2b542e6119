/* The cubic whose roots are the times at which four moving points are coplanar. */
#include "runtime/ccd/coplanarity.h"

#include "src/core/vec3.h"

static void subtract_at_ends(const elementary_query *query, int to, int from, double out[2][3],
                             double size[3]) {
    vec3_subtract(query->x0[to], query->x0[from], out[0]);
    vec3_subtract(query->x1[to], query->x1[from], out[1]);
    for (int k = 0; k < 3; k++) size[k] = max_of(fabs(out[0][k]), fabs(out[1][k]));
}

void point_vectors_from(const elementary_query *query, cscd_contact_kind kind, point_vectors *out) {
    bool vf = kind == CSCD_CONTACT_VF;
    subtract_at_ends(query, vf ? 2 : 1, vf ? 1 : 0, out->a, out->size_a);
    subtract_at_ends(query, 3, vf ? 1 : 2, out->b, out->size_b);
    subtract_at_ends(query, vf ? 0 : 2, vf ? 1 : 0, out->c, out->size_c);
}

/* Multiplying out the determinant of a + t a', b + t b' and c + t c' gives the coefficients: b0 = f(0), b3 =
 * f(1), and b1 and b2 are a third of the sum of the three determinants with one vector, or two, taken from t
 * = 1.
 *
 * Error: let u = 2^-53, and P the permanent of the components' largest magnitudes, which bounds the sum of
 * the magnitudes of the products in any of these coefficients.
 *     Each product passes 3 subtractions, 2 multiplications, 1 subtraction in the cross product, 1 addition
 *     of cross products, 2 additions in the dot product, 1 addition of dot products and 1 division: 11
 *     roundings. So a coefficient is off by at most P ((1+u)^11 - 1) < 11.1 u P.
 *     Evaluation by blending at three parameters adds 3 multiplications, 3 additions and 3 roundings of 1 - t
 *     to numbers below (1 + 11.1 u) P: at most 9.1 u P.
 * The sum is below 20.2 u P; 24 leaves room for computing P. Each of some 100 operations may lose 2^-1075 to
 * underflow, which 2^-1060 covers. */
coplanarity coplanarity_cubic(const point_vectors *v) {
    coplanarity f;
    double start[3], end[3], one[3], other[3], mixed[3];
    vec3_cross(v->a[0], v->b[0], start);
    vec3_cross(v->a[1], v->b[1], end);
    vec3_cross(v->a[1], v->b[0], one);
    vec3_cross(v->a[0], v->b[1], other);
    for (int k = 0; k < 3; k++) mixed[k] = one[k] + other[k];
    f.b[0] = vec3_dot(start, v->c[0]);
    f.b[1] = (vec3_dot(mixed, v->c[0]) + vec3_dot(start, v->c[1])) / 3.0;
    f.b[2] = (vec3_dot(mixed, v->c[1]) + vec3_dot(end, v->c[0])) / 3.0;
    f.b[3] = vec3_dot(end, v->c[1]);
    double permanent = 0.0;
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        permanent += v->size_c[k] * (v->size_a[y] * v->size_b[z] + v->size_a[z] * v->size_b[y]);
    }
    f.error = 24.0 * 0x1p-53 * permanent + 0x1p-1060;
    return f;
}

bool coplanarity_excluded(const coplanarity *f) {
    const double *b = f->b;
    double error = f->error;
    return (b[0] > error && b[1] > error && b[2] > error && b[3] > error) ||
           (b[0] < -error && b[1] < -error && b[2] < -error && b[3] < -error);
}
