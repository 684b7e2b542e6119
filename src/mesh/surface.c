/* The sign of the volume that a closed component encloses, in doubles with a bound on their error, and behind that by a sum that
 * loses nothing; and components whose triangles have no area. */
#include "src/mesh/surface.h"

#include "src/mesh/predicates.h"

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

/* ---- collapsed components ---------------------------------------------------------------------------------- */

/* Facts about a component: one of its triangles has an area; one has three vertices of different names. */
enum { SEEN_AREA = 1, SEEN_SURFACE = 2 };

static array_list collapsed_arrays(collapsed_components *c) {
    size_t components = c->mesh->component_count;
    return (array_list){{ARRAY(c->witnesses, components), ARRAY(c->seen, components),
                         ARRAY(c->marks, components), ARRAY(c->list, components)}};
}

/* The first witness of each component is its first triangle. */
cscd_status collapsed_create(const cscd_mesh *mesh, collapsed_components *out) {
    collapsed_components c = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, collapsed_arrays(&c))) return CSCD_OUT_OF_MEMORY;
    for (uint32_t t = mesh->triangle_count; t-- > 0;) c.witnesses[mesh->triangle_components[t]] = t;
    *out = c;
    return CSCD_OK;
}

void collapsed_free(collapsed_components *c) {
    if (c->mesh == NULL) return;
    context_free_all(c->mesh->context, collapsed_arrays(c));
    *c = (collapsed_components){.mesh = NULL};
}

void collapsed_begin(collapsed_components *c) {
    if (c->count > 0) memset(c->marks, false, c->mesh->component_count * sizeof *c->marks);
    c->count = 0;
}

static bool has_area(const cscd_mesh *mesh, uint32_t triangle, const double *positions) {
    const double *corners[3];
    for (int i = 0; i < 3; i++) corners[i] = positions + (size_t)mesh->triangles[triangle][i] * 3;
    return !collinear(corners[0], corners[1], corners[2]);
}

static bool has_three_names(const uint32_t corners[3], const uint32_t *names) {
    if (names == NULL) return true;
    uint32_t a = names[corners[0]], b = names[corners[1]], c = names[corners[2]];
    return a != b && b != c && c != a;
}

/* Looks for an area, and for a triangle of three names, in the components whose witness has no area. */
static void look_everywhere(collapsed_components *c, const double *positions, const uint32_t *names) {
    const cscd_mesh *mesh = c->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t component = mesh->triangle_components[t];
        if ((c->seen[component] & SEEN_AREA) != 0) continue;
        if (has_area(mesh, t, positions)) {
            c->seen[component] |= SEEN_AREA;
            c->witnesses[component] = t;
        } else if (has_three_names(mesh->triangles[t], names)) {
            c->seen[component] |= SEEN_SURFACE;
        }
    }
}

void collapsed_add(collapsed_components *c, const double *positions, const uint32_t *names) {
    uint32_t open = 0;
    for (uint32_t i = 0; i < c->mesh->component_count; i++) {
        c->seen[i] = has_area(c->mesh, c->witnesses[i], positions) ? SEEN_AREA : 0;
        open += c->seen[i] == 0;
    }
    if (open == 0) return;
    look_everywhere(c, positions, names);
    for (uint32_t i = 0; i < c->mesh->component_count; i++) {
        if (c->seen[i] != SEEN_SURFACE || c->marks[i]) continue;
        c->marks[i] = true;
        c->count++;
    }
}

const uint32_t *collapsed_list(collapsed_components *c) {
    uint32_t next = 0;
    for (uint32_t i = 0; next < c->count; i++) {
        c->list[next] = i;
        next += c->marks[i];
    }
    return c->count > 0 ? c->list : NULL;
}
