/* Do triangles intersect? In whole numbers of any length. */
#include "tests/support/untangle/whole_oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Vectors and numbers on the way: initialised once, so that no pair allocates. */
static struct {
    whole_vector u, v, w, n, m;
    mpz_t sum, product, length;
} scratch;

static void vector_init(whole_vector *v) {
    for (int k = 0; k < 3; k++) mpz_init(v->at[k]);
}

static void vector_clear(whole_vector *v) {
    for (int k = 0; k < 3; k++) mpz_clear(v->at[k]);
}

static void vector_between(const whole_vector *from, const whole_vector *to, whole_vector *out) {
    for (int k = 0; k < 3; k++) mpz_sub(out->at[k], to->at[k], from->at[k]);
}

static void vector_cross(const whole_vector *a, const whole_vector *b, whole_vector *out) {
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        mpz_mul(out->at[k], a->at[i], b->at[j]);
        mpz_submul(out->at[k], a->at[j], b->at[i]);
    }
}

static void vector_dot(const whole_vector *a, const whole_vector *b, mpz_t out) {
    mpz_mul(out, a->at[0], b->at[0]);
    mpz_addmul(out, a->at[1], b->at[1]);
    mpz_addmul(out, a->at[2], b->at[2]);
}

static int sign_of_dot(const whole_vector *a, const whole_vector *b) {
    vector_dot(a, b, scratch.sum);
    return mpz_sgn(scratch.sum);
}

static bool vector_is_null(const whole_vector *v) {
    return mpz_sgn(v->at[0]) == 0 && mpz_sgn(v->at[1]) == 0 && mpz_sgn(v->at[2]) == 0;
}

/* ---- the mesh ------------------------------------------------------------------------------------------ */

void whole_oracle_begin(whole_oracle *o) {
    memset(o, 0, sizeof *o);
    vector_init(&scratch.u);
    vector_init(&scratch.v);
    vector_init(&scratch.w);
    vector_init(&scratch.n);
    vector_init(&scratch.m);
    mpz_inits(scratch.sum, scratch.product, scratch.length, NULL);
}

void whole_oracle_end(whole_oracle *o) {
    for (uint32_t v = 0; v < o->vertex_room; v++) vector_clear(&o->points[v]);
    for (uint32_t t = 0; t < o->triangle_room; t++) vector_clear(&o->normals[t]);
    free(o->points);
    free(o->normals);
    vector_clear(&scratch.u);
    vector_clear(&scratch.v);
    vector_clear(&scratch.w);
    vector_clear(&scratch.n);
    vector_clear(&scratch.m);
    mpz_clears(scratch.sum, scratch.product, scratch.length, NULL);
}

static whole_vector *grow_vectors(whole_vector *vectors, uint32_t *room, uint32_t count) {
    if (count <= *room) return vectors;
    vectors = realloc(vectors, count * sizeof *vectors);
    if (vectors == NULL) abort();
    for (; *room < count; ++*room) vector_init(&vectors[*room]);
    return vectors;
}

/* Every double is a whole number times two to the power of its exponent less 53. */
static int least_exponent(const double *x, size_t count) {
    int least = 1024;
    for (size_t i = 0; i < count; i++) {
        int exponent;
        (void)frexp(x[i], &exponent);
        if (x[i] != 0.0 && exponent < least) least = exponent;
    }
    return least;
}

void whole_oracle_take(whole_oracle *o, uint32_t vertex_count, uint32_t triangle_count,
                       const uint32_t (*triangles)[3], const uint32_t *names, const double *x) {
    const int least = least_exponent(x, 3 * (size_t)vertex_count);
    o->points = grow_vectors(o->points, &o->vertex_room, vertex_count);
    o->normals = grow_vectors(o->normals, &o->triangle_room, triangle_count);
    o->vertex_count = vertex_count;
    o->triangle_count = triangle_count;
    o->triangles = triangles;
    o->names = names;
    o->x = x;
    for (size_t i = 0; i < 3 * (size_t)vertex_count; i++) {
        int exponent;
        mpz_t *at = &o->points[i / 3].at[i % 3];
        mpz_set_d(*at, ldexp(frexp(x[i], &exponent), 53));
        if (x[i] != 0.0) mpz_mul_2exp(*at, *at, (mp_bitcnt_t)(exponent - least));
    }
    for (uint32_t t = 0; t < triangle_count; t++) {
        vector_between(&o->points[triangles[t][0]], &o->points[triangles[t][1]], &scratch.u);
        vector_between(&o->points[triangles[t][0]], &o->points[triangles[t][2]], &scratch.v);
        vector_cross(&scratch.u, &scratch.v, &o->normals[t]);
    }
}

/* ---- features ------------------------------------------------------------------------------------------ */

/* On which side of the triangle's plane is the vertex? 0: on it, or there is no plane. */
static int side_of(const whole_oracle *o, uint32_t triangle, uint32_t vertex) {
    vector_between(&o->points[o->triangles[triangle][0]], &o->points[vertex], &scratch.w);
    return sign_of_dot(&o->normals[triangle], &scratch.w);
}

static bool lies_on_segment(const whole_oracle *o, uint32_t vertex, uint32_t a, uint32_t b) {
    vector_between(&o->points[a], &o->points[b], &scratch.u);
    vector_between(&o->points[a], &o->points[vertex], &scratch.v);
    vector_between(&o->points[b], &o->points[vertex], &scratch.w);
    vector_cross(&scratch.u, &scratch.v, &scratch.m);
    return vector_is_null(&scratch.m) && sign_of_dot(&scratch.v, &scratch.w) <= 0;
}

static bool lies_in_triangle(const whole_oracle *o, uint32_t vertex, uint32_t triangle) {
    const uint32_t *t = o->triangles[triangle];
    const bool flat = vector_is_null(&o->normals[triangle]);
    for (int k = 0; flat && k < 3; k++) {
        if (lies_on_segment(o, vertex, t[k], t[(k + 1) % 3])) return true;
    }
    if (flat || side_of(o, triangle, vertex) != 0) return false;
    for (int k = 0; k < 3; k++) {
        vector_between(&o->points[t[k]], &o->points[t[(k + 1) % 3]], &scratch.u);
        vector_between(&o->points[t[k]], &o->points[vertex], &scratch.v);
        vector_cross(&scratch.u, &scratch.v, &scratch.m);
        if (sign_of_dot(&scratch.m, &o->normals[triangle]) < 0) return false;
    }
    return true;
}

/* Is (factor x v) . n between 0 and the squared length of n? */
static bool is_within(const whole_vector *factor, const whole_vector *v) {
    vector_cross(factor, v, &scratch.m);
    vector_dot(&scratch.m, &scratch.n, scratch.product);
    return mpz_sgn(scratch.product) >= 0 && mpz_cmp(scratch.product, scratch.length) <= 0;
}

static bool segments_meet(const whole_oracle *o, const uint32_t a[2], const uint32_t b[2]) {
    vector_between(&o->points[a[0]], &o->points[a[1]], &scratch.u);
    vector_between(&o->points[b[0]], &o->points[b[1]], &scratch.v);
    vector_between(&o->points[a[0]], &o->points[b[0]], &scratch.w);
    vector_cross(&scratch.u, &scratch.v, &scratch.n);
    if (vector_is_null(&scratch.n)) { /* parallel, or points */
        return lies_on_segment(o, a[0], b[0], b[1]) || lies_on_segment(o, a[1], b[0], b[1]) ||
               lies_on_segment(o, b[0], a[0], a[1]) || lies_on_segment(o, b[1], a[0], a[1]);
    }
    if (sign_of_dot(&scratch.w, &scratch.n) != 0) return false;
    vector_dot(&scratch.n, &scratch.n, scratch.length);
    return is_within(&scratch.w, &scratch.v) && is_within(&scratch.w, &scratch.u);
}

/* Does an edge whose ends are on different sides of the plane pass through the triangle? All other ways to meet it are those of
 * vertices, and of edges with edges. */
static bool passes_through(const whole_oracle *o, const uint32_t edge[2], uint32_t triangle) {
    const uint32_t *t = o->triangles[triangle];
    int signs[3];
    if (side_of(o, triangle, edge[0]) * side_of(o, triangle, edge[1]) >= 0) return false;
    vector_between(&o->points[edge[0]], &o->points[edge[1]], &scratch.u);
    for (int k = 0; k < 3; k++) {
        vector_between(&o->points[edge[0]], &o->points[t[k]], &scratch.v);
        vector_between(&o->points[edge[0]], &o->points[t[(k + 1) % 3]], &scratch.w);
        vector_cross(&scratch.v, &scratch.w, &scratch.m);
        signs[k] = sign_of_dot(&scratch.u, &scratch.m);
    }
    return (signs[0] >= 0 && signs[1] >= 0 && signs[2] >= 0) ||
           (signs[0] <= 0 && signs[1] <= 0 && signs[2] <= 0);
}

/* ---- pairs --------------------------------------------------------------------------------------------- */

static bool boxes_meet(const whole_oracle *o, const uint32_t a[3], const uint32_t b[3]) {
    for (size_t k = 0; k < 3; k++) {
        double low[2], high[2];
        for (int i = 0; i < 2; i++) {
            const uint32_t *t = i == 0 ? a : b;
            const double p = o->x[3 * (size_t)t[0] + k], q = o->x[3 * (size_t)t[1] + k],
                         r = o->x[3 * (size_t)t[2] + k];
            low[i] = fmin(p, fmin(q, r));
            high[i] = fmax(p, fmax(q, r));
        }
        if (low[0] > high[1] || low[1] > high[0]) return false;
    }
    return true;
}

static bool is_beside(const whole_oracle *o, uint32_t a, uint32_t b) {
    const int side = side_of(o, a, o->triangles[b][0]);
    return side != 0 && side_of(o, a, o->triangles[b][1]) == side &&
           side_of(o, a, o->triangles[b][2]) == side;
}

static bool has_name(const whole_oracle *o, uint32_t vertex, const uint32_t *of, int count) {
    for (int k = 0; k < count; k++) {
        if (o->names[vertex] == o->names[of[k]]) return true;
    }
    return false;
}

static bool is_duplicate(const whole_oracle *o, const uint32_t a[3], const uint32_t b[3]) {
    int equal = 0;
    for (int k = 0; k < 9; k++) {
        vector_between(&o->points[a[k / 3]], &o->points[b[k % 3]], &scratch.w);
        equal += has_name(o, a[k / 3], &b[k % 3], 1) && vector_is_null(&scratch.w);
    }
    return equal == 3;
}

/* An edge with the edges of a triangle. */
static bool edge_meets_edges(const whole_oracle *o, const uint32_t edge[2], const uint32_t t[3]) {
    for (int k = 0; k < 3; k++) {
        const uint32_t other[2] = {t[k], t[(k + 1) % 3]};
        if (!has_name(o, edge[0], other, 2) && !has_name(o, edge[1], other, 2) &&
            segments_meet(o, edge, other))
            return true;
    }
    return false;
}

/* The vertices and edges of a with the triangle b; not edges with edges. */
static bool features_meet(const whole_oracle *o, uint32_t a, uint32_t b) {
    const uint32_t *s = o->triangles[a], *t = o->triangles[b];
    for (int k = 0; k < 3; k++) {
        const uint32_t edge[2] = {s[k], s[(k + 1) % 3]};
        if (has_name(o, s[k], t, 3)) continue;
        if (lies_in_triangle(o, s[k], b)) return true;
        if (!has_name(o, edge[1], t, 3) && passes_through(o, edge, b)) return true;
    }
    return false;
}

bool whole_oracle_has_area(const whole_oracle *o, uint32_t triangle) {
    return !vector_is_null(&o->normals[triangle]);
}

bool whole_oracle_counts(const whole_oracle *o, uint32_t a, uint32_t b) {
    const uint32_t *s = o->triangles[a], *t = o->triangles[b];
    if (!boxes_meet(o, s, t)) return false;
    if (is_beside(o, a, b) || is_beside(o, b, a)) return false;
    if (!vector_is_null(&o->normals[a]) && is_duplicate(o, s, t)) return true;
    for (int k = 0; k < 3; k++) {
        const uint32_t edge[2] = {s[k], s[(k + 1) % 3]};
        if (edge_meets_edges(o, edge, t)) return true;
    }
    return features_meet(o, a, b) || features_meet(o, b, a);
}
