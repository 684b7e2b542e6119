/* The potential of a uniformly charged triangle, in closed form (Wilton et al. 1984).
 *
 * With, for each edge, t its signed distance to the point's projection (P0 with the sign of P0 . u), l-, l+
 * the ends' coordinates along it, R-, R+ their distances, and d the height over the plane, eq. 3.17 reads
 *
 *     integral = sum of t ln((R+ + l+) / (R- + l-))  -  |d| Omega.
 *
 * The six arcs of eq. 3.17 add up to the solid angle Omega, which one arc gives (van Oosterom and Strackee
 * 1983). This file's loops are straight-line code for the vectoriser; it is compiled without errno and
 * traps. */
#include "preprocess/charge/charge.h"

#include "src/core/vec3.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#define INLINED  static inline __attribute__((always_inline))
#define UNROLLED _Pragma("GCC unroll 3") /* or clang does not vectorise */

/* Below any length that counts; its ninth power is no underflow. */
static const double TINY = 0x1p-100;

INLINED uint64_t bits_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

INLINED double from_bits(uint64_t bits) {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* ln(high / low) for high >= low > 0, where difference is high - low without its cancellation. As 2 atanh of
 * (high - low) / (high + low), with low brought near to high by a power of two; fdlibm's polynomial. */
INLINED double log_ratio(double high, double low, double difference) {
    uint64_t steps = (bits_of(high) >> 52) - (bits_of(low) >> 52);
    double near = from_bits(bits_of(low) + (steps << 52)); /* within a factor of 2 of high */
    double above = high > 0x1.6a09e667f3bcdp+0 * near ? 1.0 : 0.0;
    double below = near > 0x1.6a09e667f3bcdp+0 * high ? 1.0 : 0.0;
    near = near * (1.0 + above - 0.5 * below);
    /* steps as a double: no vector unit before AVX-512 converts 64-bit integers */
    double power = from_bits(steps | 0x4330000000000000u) - 0x1p52 + above - below;
    double s = (power == 0.0 ? difference : high - near) / (high + near);
    double z = s * s;
    double tail = z * (6.666666666666735130e-01 +
                       z * (3.999999999940941908e-01 +
                            z * (2.857142874366239149e-01 +
                                 z * (2.222219843214978396e-01 +
                                      z * (1.818357216161805012e-01 +
                                           z * (1.531383769920937332e-01 + z * 1.479819860511658591e-01))))));
    return power * 0x1.62e42fefa39efp-1 + (2.0 * s + s * tail);
}

/* The angle of (x, y) for y >= 0, in [0, pi]; (0, 0) gives 0. fdlibm's polynomial. */
INLINED double half_plane_angle(double y, double x) {
    double width = fabs(x);
    double small = y < width ? y : width, large = y < width ? width : y;
    double eighth = small > 0x1.a827999fcef34p-2 * large ? 1.0 : 0.0; /* above tan(pi / 8): turn by pi / 4 */
    double s = (small - eighth * large) / (large + eighth * small + DBL_MIN);
    double z = s * s;
    double tail = z * (3.33333333333329318027e-01 +
                       z * (-1.99999999998764832476e-01 +
                            z * (1.42857142725034663711e-01 +
                                 z * (-1.11111104054623557880e-01 +
                                      z * (9.09088713343650656196e-02 +
                                           z * (-7.69187620504482999495e-02 +
                                                z * (6.66107313738753120669e-02 +
                                                     z * (-5.83357013379057348645e-02 +
                                                          z * (4.97687799461593236017e-02 +
                                                               z * (-3.65315727442169155270e-02 +
                                                                    z * 1.62858201153657823623e-02))))))))));
    double angle = eighth * 0x1.921fb54442d18p-1 + (s - s * tail);
    angle = y < width ? angle : 0x1.921fb54442d18p+0 - angle;
    return x < 0.0 ? 0x1.921fb54442d18p+1 - angle : angle;
}

/* ln((R+ + l+) / (R- + l-)), which is ln((S + L) / (S - L)) with S = R+ + R- and L the edge's length: the
 * form for all signs of l+ and l-. Between the ends of a near edge S - L cancels; there (R+ + |l+|) (R- +
 * |l-|) / p^2 is the same, p being the distance to the edge's line. Far away 2 L / 2 S keeps ln(1 + small)
 * exact. */
INLINED double edge_logarithm(double minus, double length, double distance, double next_distance,
                              double line2) {
    double plus = minus + length;
    double sum = distance + next_distance;
    double product = (next_distance + fabs(plus)) * (distance + fabs(minus));
    double between = minus < 0.0 ? plus : -1.0;
    between = line2 < length * length ? between : -1.0;
    double high = between > 0.0 ? product : sum + length;
    double low = between > 0.0 ? line2 : sum - length;
    return log_ratio(high, low > TINY * TINY ? low : TINY * TINY, 2.0 * length);
}

/* Half of the solid angle, for the cosines c_i between the directions to the corners:
 *     tan(Omega / 2) = |triple product| / (R1 R2 R3 (1 + c_0 + c_1 + c_2)),
 * where the triple product is 2 A d. Near the triangle the sum cancels, so each cosine is taken as +-(1 - m),
 * with m = L^2 p^2 / (R R' (R R' + |r . r'|)) free of cancellation, and the sum of the whole parts is exact.
 * Everything is multiplied by the three denominators, which leaves one division in all. */
INLINED double half_solid_angle(const double distances[3], const double lengths2[3], const double lines2[3],
                                double triple) {
    double whole = 1.0, parts[3], denominators[3];
    UNROLLED
    for (int i = 0; i < 3; i++) {
        double a = distances[i], b = distances[(i + 1) % 3];
        double inner = 0.5 * (a * a + b * b - lengths2[i]);
        double sign = inner < 0.0 ? -1.0 : 1.0;
        whole += sign;
        parts[i] = sign * lengths2[i] * lines2[i] * distances[(i + 2) % 3];
        denominators[i] = a * b + fabs(inner);
    }
    double pair = denominators[1] * denominators[2], all = denominators[0] * pair;
    double fraction =
        parts[0] * pair + denominators[0] * (parts[1] * denominators[2] + parts[2] * denominators[1]);
    double radii = distances[0] * distances[1] * distances[2];
    return half_plane_angle(triple * all, whole * radii * all - fraction);
}

INLINED double potential_at_point(const potential_source *source, double x, double y, double z) {
    double to[3][3], distances[3], lengths2[3], lines2[3];
    UNROLLED
    for (int i = 0; i < 3; i++) {
        to[i][0] = source->corners[i][0] - x;
        to[i][1] = source->corners[i][1] - y;
        to[i][2] = source->corners[i][2] - z;
        double squared = vec3_dot(to[i], to[i]);
        distances[i] = sqrt(squared > TINY * TINY ? squared : TINY * TINY);
        lengths2[i] = source->lengths[i] * source->lengths[i];
    }
    double height = fabs(vec3_dot(source->normal, to[0]));
    double sum = 0.0;
    UNROLLED
    for (int i = 0; i < 3; i++) {
        double t = vec3_dot(source->outward[i], to[i]);
        lines2[i] = t * t + height * height;
        double line2 = lines2[i] > TINY * TINY ? lines2[i] : TINY * TINY;
        double logarithm = edge_logarithm(vec3_dot(source->along[i], to[i]), source->lengths[i], distances[i],
                                          distances[(i + 1) % 3], line2);
        sum += t * logarithm; /* t = 0 gives 0: the logarithm is finite */
    }
    double angle = half_solid_angle(distances, lengths2, lines2, 2.0 * source->area * height);
    return sum - 2.0 * height * angle;
}

INLINED void potentials_of(const potential_source *source, const double *restrict x, const double *restrict y,
                           const double *restrict z, size_t count, double *restrict potentials) {
    const potential_source local = *source; /* nothing aliases it */
    for (size_t i = 0; i < count; i++) potentials[i] = potential_at_point(&local, x[i], y[i], z[i]);
}

/* The same code for wider vectors. Without fused multiply-add (-ffp-contract=off) the bits are the same. */
#if defined(__x86_64__) && !defined(CSCD_SCALAR)
#define WIDER(name, features)                                                                                \
    __attribute__((target(features))) static void name(const potential_source *source, const double *x,      \
                                                       const double *y, const double *z, size_t count,       \
                                                       double *potentials) {                                 \
        potentials_of(source, x, y, z, count, potentials);                                                   \
    }
WIDER(potentials_avx512, "avx512f,avx512dq")
WIDER(potentials_avx2, "avx2")
#endif

void potential_at(const potential_source *source, const double *x, const double *y, const double *z,
                  size_t count, double *potentials) {
#if defined(__x86_64__) && !defined(CSCD_SCALAR)
    if (__builtin_cpu_supports("avx512dq")) {
        potentials_avx512(source, x, y, z, count, potentials);
        return;
    }
    if (__builtin_cpu_supports("avx2")) {
        potentials_avx2(source, x, y, z, count, potentials);
        return;
    }
#endif
    potentials_of(source, x, y, z, count, potentials);
}

/* Corners, edge lengths, directions and the normal; returns twice the area, or 0 when it is lost in rounding.
 * The normal is the product of the two shorter edges, and then turned square to the longest: in a sliver its
 * error along that edge would be large. */
static double measure_triangle(potential_source *s, const double corners[3][3]) {
    int longest = 0;
    memcpy(s->corners, corners, sizeof s->corners);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) s->along[i][k] = corners[(i + 1) % 3][k] - corners[i][k];
        s->lengths[i] = sqrt(vec3_dot(s->along[i], s->along[i]));
        longest = s->lengths[i] > s->lengths[longest] ? i : longest;
    }
    vec3_cross(s->along[(longest + 1) % 3], s->along[(longest + 2) % 3], s->normal);
    double doubled = sqrt(vec3_dot(s->normal, s->normal));
    if (doubled <= 0x1p-40 * s->lengths[longest] * s->lengths[longest]) return 0.0;

    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) s->along[i][k] /= s->lengths[i];
    }
    const double *axis = s->along[longest];
    for (int k = 0; k < 3; k++) s->normal[k] /= doubled;
    double slant = vec3_dot(s->normal, axis);
    for (int k = 0; k < 3; k++) s->normal[k] -= slant * axis[k];
    double length = sqrt(vec3_dot(s->normal, s->normal));
    for (int k = 0; k < 3; k++) s->normal[k] /= length;
    return doubled;
}

bool potential_source_set(potential_source *source, const double corners[3][3]) {
    potential_source s;
    double doubled = measure_triangle(&s, corners);
    if (doubled == 0.0) return false;
    s.area = 0.5 * doubled;
    for (int i = 0; i < 3; i++) vec3_cross(s.along[i], s.normal, s.outward[i]);
    *source = s;
    return true;
}
