/* The elementary tests as a step runs them, queries built backwards from a contact, and checks of what was found. */
#include "tests/support/ccd/elementary_cases.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Large; opened by the first test, closed when the program ends. */
static pair_batches batches, best_batches;

static void close_batches(void) {
    pair_batches_close(&batches);
    pair_batches_close(&best_batches);
}

static void stop_test(const char *problem) {
    fprintf(stderr, "queue test: %s\n", problem);
    abort();
}

static pair_batches *open_batches(void) {
    if (batches.contexts[0] != NULL) return &batches;
    if (!pair_batches_open(&batches)) stop_test("memory ran out");
    atexit(close_batches);
    return &batches;
}

/* What decides the pairs of whole scenes. Under sanitizers one instruction set does: all pairs of a scene on three of
 * them took most of the time of such tests. That they agree on these scenes is seen in the other configurations, and on
 * single queries in all. */
static pair_batches *open_scene_batches(void) {
#ifdef SLOW_MACHINE
    if (best_batches.contexts[0] != NULL) return &best_batches;
    if (!pair_batches_open_best(&best_batches)) stop_test("memory ran out");
    atexit(close_batches);
    return &best_batches;
#else
    return open_batches();
#endif
}

static void print_query(const elementary_query *query) {
    for (int i = 0; i < 8; i++) {
        const double *x = i < 4 ? query->x0[i] : query->x1[i - 4];
        fprintf(stderr, "  %a, %a, %a\n", x[0], x[1], x[2]);
    }
}

/* Prints the queries that instruction sets differ on even alone. */
static void print_different(cscd_contact_kind kind, const elementary_query *queries, size_t count) {
    for (size_t i = 0; i < count; i++) {
        query_answer answer;
        const char *problem;
        if (pair_batches_decide_queries(&batches, kind, &queries[i], 1, &answer, &problem)) continue;
        fprintf(stderr, "query %zu: %s\n", i, problem);
        print_query(&queries[i]);
    }
}

void pair_test_all(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                   query_answer *answers) {
    const char *problem;
    if (pair_batches_decide_queries(open_batches(), kind, queries, count, answers, &problem)) return;
    print_different(kind, queries, count);
    stop_test(problem);
}

elementary_verdict pair_test(cscd_contact_kind kind, const elementary_query *query, elementary_contact *hit) {
    query_answer answer;
    pair_test_all(kind, query, 1, &answer);
    int level = 0;
    while (pair_test_decided()[level] == 0) level++;
    if (answer.touching) *hit = answer.hit;
    return (elementary_verdict){answer.touching, (elementary_level)level};
}

const uint64_t *pair_test_decided(void) {
    return pair_batches_decided(&batches);
}

const cscd_contact *pair_test_source(const feature_source *source, cscd_contact_kind kind,
                                     const uint32_t (*pairs)[2], size_t count, size_t *contact_count) {
    const char *problem;
    const cscd_contact *contacts =
        pair_batches_decide(open_scene_batches(), source, kind, pairs, count, contact_count, &problem);
    if (contacts == NULL) stop_test(problem);
    return contacts;
}

/* ---- queries with a known answer ----------------------------------------------------------------------- */

#define SIDE_MISS  1e-6
#define SHORT_MISS 1e-6

/* Rounding of the expected time, not of the one found. */
#define TOI_LATE 0x1p-52

typedef struct exact_positions {
    long double x[4][3];
} exact_positions;

elementary_query query_permuted(const elementary_query *query, const int order[4]) {
    elementary_query out;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            out.x0[i][k] = query->x0[order[i]][k];
            out.x1[i][k] = query->x1[order[i]][k];
        }
    }
    return out;
}

elementary_query query_reversed(const elementary_query *query) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        out.x0[i / 3][i % 3] = query->x1[i / 3][i % 3];
        out.x1[i / 3][i % 3] = query->x0[i / 3][i % 3];
    }
    return out;
}

elementary_query query_scaled(const elementary_query *query, int exponent) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        out.x0[i / 3][i % 3] = ldexp(query->x0[i / 3][i % 3], exponent);
        out.x1[i / 3][i % 3] = ldexp(query->x1[i / 3][i % 3], exponent);
    }
    return out;
}

elementary_query query_through(const double at[4][3], const double velocity[4][3], double before,
                               double after) {
    elementary_query out;
    for (int i = 0; i < 12; i++) {
        out.x0[i / 3][i % 3] = at[i / 3][i % 3] - before * velocity[i / 3][i % 3];
        out.x1[i / 3][i % 3] = at[i / 3][i % 3] + after * velocity[i / 3][i % 3];
    }
    return out;
}

/* ---- evaluation, in long double and apart from the code under test ---- */

static exact_positions positions_at(const elementary_query *query, long double t) {
    exact_positions out;
    for (int i = 0; i < 12; i++)
        out.x[i / 3][i % 3] = (1 - t) * query->x0[i / 3][i % 3] + t * query->x1[i / 3][i % 3];
    return out;
}

static void subtract_long(const long double a[3], const long double b[3], long double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static void cross_long(const long double a[3], const long double b[3], long double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static long double dot_long(const long double a[3], const long double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static long double length_long(const long double a[3]) {
    return sqrtl(dot_long(a, a));
}

/* Two directions that span the contact plane: sides of the face, or the two edges. */
static void contact_directions(cscd_contact_kind kind, const exact_positions *p, long double a[3],
                               long double b[3]) {
    subtract_long(p->x[kind == CSCD_CONTACT_VF ? 2 : 1], p->x[kind == CSCD_CONTACT_VF ? 1 : 0], a);
    subtract_long(p->x[3], p->x[kind == CSCD_CONTACT_VF ? 1 : 2], b);
}

static void contact_points(cscd_contact_kind kind, const exact_positions *p, long double u, long double v,
                           long double on_a[3], long double on_b[3]) {
    for (int k = 0; k < 3; k++) {
        if (kind == CSCD_CONTACT_VF) {
            on_a[k] = p->x[0][k];
            on_b[k] = (1 - u - v) * p->x[1][k] + u * p->x[2][k] + v * p->x[3][k];
        } else {
            on_a[k] = (1 - u) * p->x[0][k] + u * p->x[1][k];
            on_b[k] = (1 - v) * p->x[2][k] + v * p->x[3][k];
        }
    }
}

/* Motion of the point of a relative to that of b, over the interval. */
static void relative_motion(cscd_contact_kind kind, const elementary_query *query, long double u,
                            long double v, long double out[3]) {
    exact_positions start = positions_at(query, 0), end = positions_at(query, 1);
    long double a0[3], b0[3], a1[3], b1[3];
    contact_points(kind, &start, u, v, a0, b0);
    contact_points(kind, &end, u, v, a1, b1);
    for (int k = 0; k < 3; k++) out[k] = (a1[k] - a0[k]) - (b1[k] - b0[k]);
}

static long double volume_at(const elementary_query *query, cscd_contact_kind kind, long double t) {
    exact_positions p = positions_at(query, t);
    long double a[3], b[3], c[3], n[3];
    contact_directions(kind, &p, a, b);
    subtract_long(p.x[0], p.x[kind == CSCD_CONTACT_VF ? 1 : 2], c);
    cross_long(a, b, n);
    return dot_long(n, c);
}

/* Of the volume, by its values at four times; returns the largest. */
static long double bernstein_coefficients(const elementary_query *query, cscd_contact_kind kind,
                                          long double b[4]) {
    long double f[4], largest = 0;
    for (int i = 0; i < 4; i++) f[i] = volume_at(query, kind, i / 3.0L);
    b[0] = f[0];
    b[1] = (-5 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / 6;
    b[2] = (2 * f[0] - 9 * f[1] + 18 * f[2] - 5 * f[3]) / 6;
    b[3] = f[3];
    for (int i = 0; i < 4; i++) largest = fmaxl(largest, fabsl(b[i]));
    return largest;
}

/* The changes of sign from coefficient first on; -1 when one of them is near zero. */
static int sign_changes(const elementary_query *query, cscd_contact_kind kind, int first) {
    long double b[4], largest = bernstein_coefficients(query, kind, b);
    int changes = 0;
    for (int i = first; i < 4; i++) {
        if (!(fabsl(b[i]) > 1e-5L * largest)) return -1;
        changes += i > first && (b[i] > 0) != (b[i - 1] > 0);
    }
    return changes;
}

bool crosses_once(const elementary_query *query, cscd_contact_kind kind) {
    return sign_changes(query, kind, 0) == 1;
}

bool leaves_at_start(const elementary_query *query, cscd_contact_kind kind) {
    return sign_changes(query, kind, 1) == 0;
}

/* ---- random queries ---- */

static void random_vector(double size, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = size * random_unit();
}

/* Random features of about unit size whose points u, v coincide. */
static void touching_features(cscd_contact_kind kind, double u, double v, double at[4][3]) {
    double along_a[3], along_b[3];
    random_vector(1.0, at[0]);
    random_vector(1.0, along_a);
    random_vector(1.0, along_b);
    for (int k = 0; k < 3; k++) {
        double meeting = at[0][k];
        if (kind == CSCD_CONTACT_VF) {
            at[1][k] = meeting - u * along_a[k] - v * along_b[k];
            at[2][k] = at[1][k] + along_a[k];
            at[3][k] = at[1][k] + along_b[k];
        } else {
            at[0][k] = meeting - u * along_a[k];
            at[1][k] = meeting + (1.0 - u) * along_a[k];
            at[2][k] = meeting - v * along_b[k];
            at[3][k] = meeting + (1.0 - v) * along_b[k];
        }
    }
}

/* No sliver, and the features meet at more than a grazing angle. */
static bool well_shaped(const contact_case *c) {
    exact_positions p = positions_at(&c->query, c->toi);
    long double a[3], b[3], n[3], motion[3];
    contact_directions(c->kind, &p, a, b);
    cross_long(a, b, n);
    relative_motion(c->kind, &c->query, c->u, c->v, motion);
    return length_long(n) > 0.2L && fabsl(dot_long(n, motion)) > 0.1L * length_long(n);
}

/* At a random size, and at the origin, near it, or a thousand sizes away. */
static void scale_and_place(contact_case *c) {
    double offset[3];
    c->size = pow(10.0, random_between(-6.0, 6.0));
    random_vector(c->size * (double[]){0.0, 1.0, 1000.0}[random_integer(0, 2)], offset);
    for (int i = 0; i < 12; i++) {
        c->query.x0[i / 3][i % 3] = c->size * c->query.x0[i / 3][i % 3] + offset[i % 3];
        c->query.x1[i / 3][i % 3] = c->size * c->query.x1[i / 3][i % 3] + offset[i % 3];
    }
}

/* The contact at u, v; the interval ends cut before it, if cut > 0. */
static contact_case unit_contact(cscd_contact_kind kind, double u, double v, double cut) {
    contact_case c = {.kind = kind, .size = 1.0, .u = u, .v = v};
    do {
        double at[4][3], velocity[4][3];
        c.toi = random_between(0.02, 0.98);
        touching_features(kind, u, v, at);
        for (int i = 0; i < 4; i++) random_vector(2.0, velocity[i]);
        c.query = query_through(at, velocity, c.toi, 1.0 - c.toi);
        if (!well_shaped(&c) || (cut > 0.0 && !crosses_once(&c.query, kind))) continue;
        if (cut > 0.0) c.query = query_through(at, velocity, c.toi, -cut);
        return c;
    } while (true);
}

static void random_parameters(cscd_contact_kind kind, double *u, double *v) {
    do {
        *u = random_between(0.01, 0.99);
        *v = random_between(0.01, 0.99);
    } while (kind == CSCD_CONTACT_VF && *u + *v > 0.99);
}

contact_case random_contact(cscd_contact_kind kind) {
    double u, v;
    random_parameters(kind, &u, &v);
    contact_case c = unit_contact(kind, u, v, 0.0);
    scale_and_place(&c);
    return c;
}

contact_case random_short_miss(cscd_contact_kind kind) {
    double u, v;
    random_parameters(kind, &u, &v);
    contact_case c = unit_contact(kind, u, v, SHORT_MISS);
    scale_and_place(&c);
    return c;
}

static void move_outside(cscd_contact_kind kind, double *u, double *v) {
    double *moved = random_integer(0, 1) ? u : v;
    if (random_integer(0, 1))
        *moved = -SIDE_MISS;
    else
        *moved = kind == CSCD_CONTACT_VF ? 1.0 + SIDE_MISS - (moved == u ? *v : *u) : 1.0 + SIDE_MISS;
}

contact_case random_side_miss(cscd_contact_kind kind) {
    double u, v;
    random_parameters(kind, &u, &v);
    move_outside(kind, &u, &v);
    contact_case c;
    do {
        c = unit_contact(kind, u, v, 0.0);
    } while (!crosses_once(&c.query, kind));
    scale_and_place(&c);
    return c;
}

/* ---- checks ---- */

static double query_extent(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 12; i++) {
        largest = fmax(largest, fabs(query->x0[i / 3][i % 3] - query->x0[0][i % 3]));
        largest = fmax(largest, fabs(query->x1[i / 3][i % 3] - query->x0[0][i % 3]));
    }
    return largest > 0.0 ? largest : 1.0;
}

static void fail_query(cscd_contact_kind kind, const elementary_query *query, double found, double expected) {
    printf("%s: toi %.17g, expected %.17g (2: never)\n", kind == CSCD_CONTACT_VF ? "vf" : "ee", found,
           expected);
    for (int i = 0; i < 4; i++)
        printf("  (%a %a %a) -> (%a %a %a)\n", query->x0[i][0], query->x0[i][1], query->x0[i][2],
               query->x1[i][0], query->x1[i][1], query->x1[i][2]);
    fail();
}

static long double farthest_coordinate(const elementary_query *query) {
    long double farthest = 0;
    for (int i = 0; i < 12; i++)
        farthest = fmaxl(farthest, fmaxl(fabsl(query->x0[i / 3][i % 3]), fabsl(query->x1[i / 3][i % 3])));
    return farthest;
}

static long double largest_displacement(const elementary_query *query) {
    long double largest = 0;
    for (int i = 0; i < 4; i++) {
        long double motion[3];
        for (int k = 0; k < 3; k++) motion[k] = (long double)query->x1[i][k] - query->x0[i][k];
        largest = fmaxl(largest, length_long(motion));
    }
    return largest;
}

static void check_points(cscd_contact_kind kind, const elementary_query *query, double size,
                         const elementary_contact *hit) {
    exact_positions p = positions_at(query, hit->toi);
    long double on_a[3], on_b[3], apart[3];
    long double rounding = 0x1p-50L * farthest_coordinate(query);
    contact_points(kind, &p, hit->u, hit->v, on_a, on_b);
    subtract_long(on_a, on_b, apart);
    if (length_long(apart) >
        1e-8L * largest_displacement(query) + 64 * 0x1p-52L * farthest_coordinate(query)) {
        printf("%Lg of the size apart\n", length_long(apart) / size);
        fail_query(kind, query, hit->toi, hit->toi);
    }
    for (int k = 0; k < 3; k++)
        assert_true(fabsl(hit->point[k] - (on_a[k] + on_b[k]) / 2) <= 1e-12L * size + rounding);
}

static void check_normal(cscd_contact_kind kind, const elementary_query *query, double size,
                         const elementary_contact *hit) {
    exact_positions p = positions_at(query, hit->toi);
    long double n[3] = {hit->normal[0], hit->normal[1], hit->normal[2]}, a[3], b[3], area[3], motion[3];
    contact_directions(kind, &p, a, b);
    cross_long(a, b, area);
    long double quality = length_long(area) / ((long double)size * size);
    if (dot_long(n, n) == 0) {
        assert_true(quality < 1e-9L);
        return;
    }
    assert_true(fabsl(length_long(n) - 1) < 1e-14L);
    if (quality < 1e-6L) return; /* what is left of a vanishing area is rounding */
    relative_motion(kind, query, hit->u, hit->v, motion);
    assert_true(fabsl(dot_long(n, a)) <= 1e-13L / quality * size);
    assert_true(fabsl(dot_long(n, b)) <= 1e-13L / quality * size);
    assert_true(dot_long(n, motion) <= 1e-13L / quality * size);
}

void check_hit(cscd_contact_kind kind, const elementary_query *query, double size,
               const elementary_contact *hit) {
    assert_true(hit->toi >= 0.0 && hit->toi <= 1.0);
    assert_true(hit->u >= 0.0 && hit->u <= 1.0 && hit->v >= 0.0 && hit->v <= 1.0);
    if (kind == CSCD_CONTACT_VF) assert_true(hit->u + hit->v <= 1.0 + 0x1p-50);
    check_points(kind, query, size, hit);
    check_normal(kind, query, size, hit);
}

elementary_contact check_touches(cscd_contact_kind kind, const elementary_query *query, double toi) {
    elementary_contact hit = {.toi = 2.0};
    if (!pair_test(kind, query, &hit).touching || hit.toi > toi + TOI_LATE)
        fail_query(kind, query, hit.toi, toi);
    check_hit(kind, query, query_extent(query), &hit);
    return hit;
}

elementary_contact check_first(cscd_contact_kind kind, const elementary_query *query, double toi,
                               double early) {
    elementary_contact hit = check_touches(kind, query, toi);
    if (hit.toi < toi - early) fail_query(kind, query, hit.toi, toi);
    return hit;
}

void check_apart(cscd_contact_kind kind, const elementary_query *query) {
    elementary_contact hit = {.toi = 2.0};
    if (pair_test(kind, query, &hit).touching) fail_query(kind, query, hit.toi, 2.0);
}
