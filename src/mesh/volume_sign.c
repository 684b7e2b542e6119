/* The sign of the volume that a closed component encloses: in doubles with a bound on their error, and behind that by a sum
 * that loses nothing. */
#include "src/mesh/volume_sign.h"

#include "src/core/vec3.h"
#include "src/mesh/error_free.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- in doubles ---------------------------------------------------------------------------------------- */

/* Adds the determinant of three points, and to the rounding that of the magnitudes alone. */
static void add_determinant(double p[3][3], volume_estimate *e) {
    double sum = 0.0, most = 0.0;
    for (int k = 0; k < 3; k++) {
        double left = p[1][(k + 1) % 3] * p[2][(k + 2) % 3], right = p[1][(k + 2) % 3] * p[2][(k + 1) % 3];
        sum += p[0][k] * (left - right);
        most += fabs(p[0][k]) * (fabs(left) + fabs(right));
    }
    e->volume += sum;
    e->rounding += most;
}

/* In units of 2^-53 of the sum of all products' magnitudes: the three differences 3, a product of three 2, the sums within a
 * determinant 3, that of n determinants n, so n + 8 together; and the computed sum of magnitudes may be too small by n + 8
 * units itself. Since n is below 2^32, 2 (n + 16) covers both. */
void volume_estimates_find(const cscd_mesh *mesh, const double *positions, volume_estimate *estimates) {
    memset(estimates, 0, mesh->component_count * sizeof *estimates);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        volume_estimate *e = &estimates[mesh->triangle_components[t]];
        double from[3][3];
        if (!mesh->components[mesh->triangle_components[t]].closed_manifold) continue;
        if (e->origin == NULL) e->origin = surface_corner(mesh, positions, t, 0);
        for (uint32_t i = 0; i < 3; i++)
            vec3_subtract(surface_corner(mesh, positions, t, i), e->origin, from[i]);
        add_determinant(from, e);
    }
    for (uint32_t c = 0; c < mesh->component_count; c++)
        estimates[c].rounding *= 0x1p-52 * ((double)mesh->components[c].triangle_count + 16.0);
}

/* ---- without loss -------------------------------------------------------------------------------------- */

/* A sum of doubles in fixed point: limb i counts units of 2^(32 i - UNIT). Products of three coordinates are multiples of
 * 2^-1056 below 2^903 in magnitude, and of at most 53 bits; 2^37 of them are below 2^940. Limbs are carried before they can
 * overflow. */
enum { UNIT = 1120, LIMBS = 66, ADDS_BEFORE_CARRY = 1 << 28 };

typedef struct limb_sum {
    int64_t limbs[LIMBS];
    int adds;
} limb_sum;

static const int64_t LIMB = INT64_C(1) << 32;

/* Leaves each limb but the last in [0, 2^32), so that the last has the sign of the whole, or all are 0. */
static void carry_limbs(limb_sum *s) {
    for (int i = 0; i + 1 < LIMBS; i++) {
        int64_t rest = s->limbs[i] % LIMB;
        if (rest < 0) rest += LIMB;
        s->limbs[i + 1] += (s->limbs[i] - rest) / LIMB;
        s->limbs[i] = rest;
    }
    s->adds = 0;
}

static void add_double(limb_sum *s, double x) {
    int exponent;
    if (x == 0.0) return;
    uint64_t mantissa = (uint64_t)ldexp(frexp(fabs(x), &exponent), 53);
    int place = exponent - 53 + UNIT, shift = place % 32;
    int64_t sign = x < 0.0 ? -1 : 1, *limb = &s->limbs[place / 32];
    limb[0] += sign * (int64_t)(mantissa << shift & 0xffffffff);
    limb[1] += sign * (int64_t)(mantissa >> (32 - shift) & 0xffffffff);
    limb[2] += sign * (int64_t)(shift == 0 ? 0 : mantissa >> (64 - shift));
    if (++s->adds == ADDS_BEFORE_CARRY) carry_limbs(s);
}

static void add_product(limb_sum *s, double a, double b, double c) {
    double high, low, of_b[2], of_c[2], product, error;
    split_double(b, &of_b[0], &of_b[1]);
    split_double(c, &of_c[0], &of_c[1]);
    two_product(a, b, of_b[0], of_b[1], &high, &low);
    two_product(high, c, of_c[0], of_c[1], &product, &error);
    add_double(s, product);
    add_double(s, error);
    two_product(low, c, of_c[0], of_c[1], &product, &error);
    add_double(s, product);
    add_double(s, error);
}

/* The determinants of the points themselves, whose sum does not depend on the origin, since the surface is closed. */
int volume_sign_exact(const cscd_mesh *mesh, const double *positions, const uint32_t *triangles,
                      uint32_t count) {
    limb_sum sum = {.adds = 0};
    for (uint32_t i = 0; i < count; i++) {
        const double *a = surface_corner(mesh, positions, triangles[i], 0);
        const double *b = surface_corner(mesh, positions, triangles[i], 1);
        const double *c = surface_corner(mesh, positions, triangles[i], 2);
        for (int k = 0; k < 3; k++) {
            add_product(&sum, a[k], b[(k + 1) % 3], c[(k + 2) % 3]);
            add_product(&sum, -a[k], b[(k + 2) % 3], c[(k + 1) % 3]);
        }
    }
    carry_limbs(&sum);
    if (sum.limbs[LIMBS - 1] < 0) return -1;
    for (int i = 0; i < LIMBS; i++) {
        if (sum.limbs[i] != 0) return 1;
    }
    return 0;
}
