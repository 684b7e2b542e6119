/* Elementary tests on degenerate configurations whose contacts are exact: small integers, at the ends of the
 * interval, at corners and borders, double and triple roots; mirror symmetry. */
#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>

enum { ROUND_COUNT = PACED(NIGHTLY(12000, 20000), 5000) };

static int seed_random(void **state) {
    (void)state;
    random_seed(5);
    return 0;
}

static void random_grid_vector(int range, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = random_integer(-range, range);
}

/* Features of integer corners whose points u = i / 4, v = j / 4 coincide. */
static void grid_features(cscd_contact_kind kind, int range, int i, int j, double at[4][3]) {
    double along_a[3], along_b[3], meeting[3];
    random_grid_vector(range, meeting);
    random_grid_vector(range, along_a);
    random_grid_vector(range, along_b);
    for (int k = 0; k < 3; k++) {
        if (kind == CSCD_CONTACT_VF) {
            at[0][k] = meeting[k];
            at[1][k] = meeting[k] - i * along_a[k] - j * along_b[k];
            at[2][k] = at[1][k] + 4.0 * along_a[k];
            at[3][k] = at[1][k] + 4.0 * along_b[k];
        } else {
            at[0][k] = meeting[k] - i * along_a[k];
            at[1][k] = at[0][k] + 4.0 * along_a[k];
            at[2][k] = meeting[k] - j * along_b[k];
            at[3][k] = at[2][k] + 4.0 * along_b[k];
        }
    }
}

typedef enum place { INSIDE, ON_BORDER, ON_CORNER, PLACE_COUNT } place;

static void random_place(cscd_contact_kind kind, place where, int *i, int *j) {
    static const int vf_border[3][2] = {{1, 0}, {0, 3}, {2, 2}};
    static const int corners[4][2] = {{0, 0}, {4, 0}, {0, 4}, {4, 4}};
    static const int ee_border[4][2] = {{0, 1}, {4, 2}, {3, 0}, {2, 4}};
    const int *choice = corners[random_integer(0, kind == CSCD_CONTACT_VF ? 2 : 3)];
    if (where == ON_BORDER && kind == CSCD_CONTACT_VF) choice = vf_border[random_integer(0, 2)];
    if (where == ON_BORDER && kind == CSCD_CONTACT_EE) choice = ee_border[random_integer(0, 3)];
    *i = where == INSIDE ? 1 : choice[0];
    *j = where == INSIDE ? random_integer(1, 2) : choice[1];
}

/* An exact contact at toi = before / (before + after). */
static elementary_query grid_contact(cscd_contact_kind kind, place where, int range, double before,
                                     double after) {
    double at[4][3], velocity[4][3];
    int i, j;
    random_place(kind, where, &i, &j);
    grid_features(kind, range, i, j, at);
    for (int p = 0; p < 4; p++) random_grid_vector(range, velocity[p]);
    return query_through((const double(*)[3])at, (const double(*)[3])velocity, before, after);
}

/* Small ranges make all degeneracies frequent: coincident points, zero areas, common planes and lines for a
 * moment or throughout, roots of any multiplicity. */
TEST(exact_contacts) {
    static const int ranges[] = {1, 2, 3, 10, 1000};
    for (int round = 0; round < ROUND_COUNT; round++) {
        for (int c = 0; c < 2 * PLACE_COUNT; c++) {
            cscd_contact_kind kind = c % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
            int before = random_integer(0, 5), after = random_integer(before == 0, 5);
            elementary_query query = grid_contact(kind, (place)(c / 2), ranges[round % 5], before, after);
            check_touches(kind, &query, before / (double)(before + after));
        }
    }
}

TEST(ends_of_the_interval) {
    int counts[2] = {0, 0};
    for (int round = 0; round < ROUND_COUNT; round++) {
        cscd_contact_kind kind = round % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        place where = (place)(round / 2 % PLACE_COUNT);
        elementary_query query = grid_contact(kind, where, 1000, 0, 1);
        check_first(kind, &query, 0.0, 0.0);
        if (!leaves_at_start(&query, kind)) continue;
        elementary_query reversed = query_reversed(&query);
        check_first(kind, &reversed, 1.0, 1e-9);
        counts[round % 2]++;
    }
    printf("only at an end: %d vf, %d ee\n", counts[0], counts[1]);
    assert_true(counts[0] >= 1000 && counts[1] >= 1000);
}

/* ---- tangential contacts ---- */

/* With s = t - 1/2, sides (1 + e s, 0, alpha s), (0, 1, beta s) and offset (c0 + c1 s, d0 + d1 s, (alpha c0 +
 * beta d0) s) span the volume (e alpha c0 - alpha c1 - beta d1) s^2 - e beta d1 s^3: the height above the
 * turning plane has a double root. The lift moves it off the plane. All coordinates are multiples of 1/16. */
typedef struct turning {
    double alpha, beta, c0, d0, c1, d1, e;
} turning;

static double volume_curvature(const turning *m) {
    return m->e * m->alpha * m->c0 - m->alpha * m->c1 - m->beta * m->d1;
}

/* Until the root the volume has one sign, and after it the same. */
static turning random_turning(void) {
    turning m;
    do {
        m = (turning){.alpha = random_integer(-8, 8),
                      .beta = random_integer(-8, 8),
                      .c0 = 0.25,
                      .d0 = 0.125 * random_integer(1, 3),
                      .c1 = 0.5 * random_integer(-4, 4),
                      .d1 = 0.5 * random_integer(-4, 4),
                      .e = random_integer(-1, 1)};
    } while (fabs(volume_curvature(&m)) <= 0.5 * fabs(m.e * m.beta * m.d1));
    return m;
}

/* VF: p0 at the origin. EE: the edges' middles at the origin and at the offset. */
static void place_turning(cscd_contact_kind kind, const double a[3], const double b[3], const double c[3],
                          double out[4][3]) {
    for (int k = 0; k < 3; k++) {
        bool vf = kind == CSCD_CONTACT_VF;
        out[0][k] = vf ? c[k] : -0.5 * a[k];
        out[1][k] = vf ? 0.0 : 0.5 * a[k];
        out[2][k] = vf ? a[k] : c[k] - 0.5 * b[k];
        out[3][k] = vf ? b[k] : c[k] + 0.5 * b[k];
    }
}

static elementary_query turning_query(cscd_contact_kind kind, const turning *m, double lift) {
    const double a[3] = {1, 0, 0}, b[3] = {0, 1, 0}, c[3] = {m->c0, m->d0, lift};
    const double a_speed[3] = {m->e, 0, m->alpha}, b_speed[3] = {0, 0, m->beta};
    const double c_speed[3] = {m->c1, m->d1, m->alpha * m->c0 + m->beta * m->d0};
    double at[4][3], velocity[4][3];
    place_turning(kind, a, b, c, at);
    place_turning(kind, a_speed, b_speed, c_speed, velocity);
    return query_through((const double(*)[3])at, (const double(*)[3])velocity, 0.5, 0.5);
}

TEST(double_roots) {
    for (int round = 0; round < 2 * ROUND_COUNT; round++) {
        cscd_contact_kind kind = round % 2 == 0 ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
        turning m = random_turning();
        elementary_query query = turning_query(kind, &m, 0.0);
        elementary_contact hit = check_first(kind, &query, 0.5, 1e-9);
        if (kind == CSCD_CONTACT_VF) assert_true(fabs(hit.u - m.c0) < 1e-4 && fabs(hit.v - m.d0) < 1e-4);
        query = turning_query(kind, &m, volume_curvature(&m) > 0.0 ? 0x1p-30 : -0x1p-30);
        check_apart(kind, &query);
    }
}

/* Two edges in a plane close like scissors and stop, parallel, at a gap. */
TEST(closing_scissors) {
    for (int exponent = -10; exponent >= -30; exponent--) {
        double gap = ldexp(1.0, exponent);
        const elementary_query query = {{{-2, 2, 0}, {2, -2, 0}, {1, gap, 0}, {6, gap, 0}},
                                        {{-2, 0, 0}, {2, 0, 0}, {0, gap, 0}, {5, gap, 0}}};
        check_apart(CSCD_CONTACT_EE, &query);
    }
    const elementary_query closed = {{{-2, 2, 0}, {2, -2, 0}, {1, 0, 0}, {6, 0, 0}},
                                     {{-2, 0, 0}, {2, 0, 0}, {0, 0, 0}, {5, 0, 0}}};
    check_first(CSCD_CONTACT_EE, &closed, 1.0, 1e-9);
}

/* ---- mirrored at the plane x = 0 ---- */

static void mirror_coordinates(const double p[3], double out[3]) {
    out[0] = -p[0];
    out[1] = p[1];
    out[2] = p[2];
}

/* Points on the right that move anywhere; x at the end is at least 0.01 off the mirror. */
static void random_right(elementary_query *query, int i, bool may_cross) {
    for (int k = 0; k < 3; k++) {
        query->x0[i][k] = random_unit();
        query->x1[i][k] = random_unit();
    }
    query->x0[i][0] = random_between(0.01, 1.0);
    query->x1[i][0] = random_between(0.01, 1.0) * (may_cross && random_integer(0, 2) != 0 ? -1.0 : 1.0);
}

static void mirror_point(elementary_query *query, int from, int to) {
    mirror_coordinates(query->x0[from], query->x0[to]);
    mirror_coordinates(query->x1[from], query->x1[to]);
}

/* When a point meets its mirror image; 2: never. */
static double meeting_time(const elementary_query *query, int i) {
    double start = query->x0[i][0], end = query->x1[i][0];
    return end > 0.0 ? 2.0 : start / (start - end);
}

static void check_mirrored(cscd_contact_kind kind, const elementary_query *query, double toi) {
    if (toi > 1.0)
        check_apart(kind, query);
    else
        check_first(kind, query, toi, 1e-9);
}

/* An edge and its image stay in a plane. */
TEST(mirrored_edges) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        for (int i = 0; i < 2; i++) {
            random_right(&query, i, true);
            mirror_point(&query, i, i + 2);
        }
        check_mirrored(CSCD_CONTACT_EE, &query, fmin(meeting_time(&query, 0), meeting_time(&query, 1)));
    }
}

/* A vertex meets its image, which is a corner of the face or the end of an edge; the others keep off. */
TEST(mirrored_vertices) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        elementary_query query;
        random_right(&query, 0, true);
        for (int i = 1; i < 4; i++) random_right(&query, i, false);
        for (int i = 2; i < 4; i++) mirror_point(&query, i, i);
        elementary_query edges = query;
        mirror_point(&query, 0, 1);
        check_mirrored(CSCD_CONTACT_VF, &query, meeting_time(&query, 0));
        mirror_point(&edges, 0, 2);
        check_mirrored(CSCD_CONTACT_EE, &edges, meeting_time(&edges, 0));
    }
}

/* A vertex in the mirror meets a face that is its own image: on its axis. */
TEST(symmetric_face) {
    for (int round = 0; round < ROUND_COUNT; round++) {
        double at[4][3], velocity[4][3], u = random_between(0.05, 0.45), toi = random_unit() * 0.4 + 0.5;
        for (int i = 0; i < 12; i++) {
            at[i / 3][i % 3] = random_unit();
            velocity[i / 3][i % 3] = random_unit();
        }
        at[0][0] = at[1][0] = velocity[0][0] = velocity[1][0] = 0.0;
        mirror_coordinates(at[2], at[3]);
        mirror_coordinates(velocity[2], velocity[3]);
        double closing[3];
        for (int k = 1; k < 3; k++) {
            at[0][k] = (1.0 - 2.0 * u) * at[1][k] + 2.0 * u * at[2][k];
            closing[k] = velocity[0][k] - (1.0 - 2.0 * u) * velocity[1][k] - 2.0 * u * velocity[2][k];
        }
        double across = (at[2][1] - at[1][1]) * closing[2] - (at[2][2] - at[1][2]) * closing[1];
        if (fabs(across) < 0.05) continue;
        elementary_query query =
            query_through((const double(*)[3])at, (const double(*)[3])velocity, toi, 1.0 - toi);
        elementary_contact hit = check_touches(CSCD_CONTACT_VF, &query, toi);
        double width = (1.0 - hit.toi) * query.x0[2][0] + hit.toi * query.x1[2][0];
        if (fabs(width) > 1e-3) assert_true(fabs(hit.u - hit.v) < 1e-9);
    }
}

AROUND_EACH(seed_random, NULL)
