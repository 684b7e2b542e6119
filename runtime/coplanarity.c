/* The cubic whose roots are the times at which four moving points are coplanar. */
#include "runtime/coplanarity.h"

#include "runtime/vector.h"

static double determinant(const double a[3], const double b[3], const double c[3]) {
    double normal[3];
    vector_cross(a, b, normal);
    return vector_dot(normal, c);
}

/* The polar form of the cubic (A x B) . C: b1 = (f(1,0,0) + f(0,1,0) + f(0,0,1)) / 3, and b2 likewise.
 *
 * Error: let u = 2^-53, and a, b, c here be the largest components over both ends. A component of A has the
 * relative error u from its subtraction. A determinant is a sum of 6 products of three such components; each
 * product passes 3 subtractions, 2 multiplications, 1 subtraction in the cross product and at most 2
 * additions in the dot product: 8 roundings, so |error| <= 6 a b c ((1+u)^8 - 1) <= 48.1 u a b c. The sum of
 * three determinants, each at most 6 a b c (1 + 8u), adds 2 roundings of at most 18.1 a b c and, divided by 3
 * (1 rounding), an error of at most (48.1 + 12.1 + 6.1) u a b c <= 67 u a b c. Evaluation by de Casteljau
 * adds 3 multiplications, 3 additions and the rounding of 1 - t in each of 3 steps to numbers below 6.1 a b
 * c: at most 9.1 * 6.1 < 56 u a b c. The sum is below 123 u a b c; 128 leaves room for computing it.
 * Underflow: each of some 40 operations may lose 2^-1075, covered by 2^-1060. */
coplanarity coplanarity_cubic(const double a[2][3], const double b[2][3], const double c[2][3]) {
    coplanarity f;
    f.b[0] = determinant(a[0], b[0], c[0]);
    f.b[1] =
        (determinant(a[1], b[0], c[0]) + determinant(a[0], b[1], c[0]) + determinant(a[0], b[0], c[1])) / 3.0;
    f.b[2] =
        (determinant(a[0], b[1], c[1]) + determinant(a[1], b[0], c[1]) + determinant(a[1], b[1], c[0])) / 3.0;
    f.b[3] = determinant(a[1], b[1], c[1]);
    double largest = fmax(vector_largest(a[0]), vector_largest(a[1])) *
                     fmax(vector_largest(b[0]), vector_largest(b[1])) *
                     fmax(vector_largest(c[0]), vector_largest(c[1]));
    f.error = 128.0 * 0x1p-53 * largest + 0x1p-1060;
    return f;
}

bool coplanarity_excluded(const coplanarity *f) {
    const double *b = f->b;
    double error = f->error;
    return (b[0] > error && b[1] > error && b[2] > error && b[3] > error) ||
           (b[0] < -error && b[1] < -error && b[2] < -error && b[3] < -error);
}
