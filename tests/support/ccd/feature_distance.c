/* The distance of two moving features, in long double and by cases: nothing in common with the oracle. */
#include "tests/support/ccd/feature_distance.h"

#include <math.h>

typedef struct vector {
    long double x[3];
} vector;

enum { MOST_INTERVALS = 1 << 12 };

typedef struct proof {
    cscd_contact_kind kind;
    const elementary_query *query;
    long double speed, distance;
    int intervals;
} proof;

static vector position_at(const elementary_query *query, int i, long double t) {
    vector out;
    for (int k = 0; k < 3; k++) out.x[k] = (1 - t) * query->x0[i][k] + t * query->x1[i][k];
    return out;
}

static vector vector_difference(vector a, vector b) {
    return (vector){{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}

/* a + f (b - a) */
static vector point_between(vector a, vector b, long double f) {
    for (int k = 0; k < 3; k++) a.x[k] = (1 - f) * a.x[k] + f * b.x[k];
    return a;
}

static long double dot_product(vector a, vector b) {
    return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

static long double vector_norm(vector a) {
    return sqrtl(dot_product(a, a));
}

static vector cross_product(vector a, vector b) {
    vector out;
    for (int k = 0; k < 3; k++)
        out.x[k] = a.x[(k + 1) % 3] * b.x[(k + 2) % 3] - a.x[(k + 2) % 3] * b.x[(k + 1) % 3];
    return out;
}

static long double point_segment(vector p, vector a, vector b) {
    vector side = vector_difference(b, a);
    long double square = dot_product(side, side);
    long double f = square > 0 ? dot_product(vector_difference(p, a), side) / square : 0;
    return vector_norm(vector_difference(p, point_between(a, b, fminl(fmaxl(f, 0), 1))));
}

static long double point_triangle(const vector p[4]) {
    vector n = cross_product(vector_difference(p[2], p[1]), vector_difference(p[3], p[1]));
    long double best = INFINITY;
    bool inside = dot_product(n, n) > 0;
    for (int i = 1; i < 4; i++) {
        const vector *a = &p[i], *b = &p[i % 3 + 1];
        best = fminl(best, point_segment(p[0], *a, *b));
        inside = inside &&
                 dot_product(cross_product(vector_difference(*b, *a), vector_difference(p[0], *a)), n) >= 0;
    }
    return inside ? fminl(best, fabsl(dot_product(vector_difference(p[0], p[1]), n)) / vector_norm(n)) : best;
}

static long double segment_segment(const vector p[4]) {
    vector a = vector_difference(p[1], p[0]), b = vector_difference(p[3], p[2]),
           c = vector_difference(p[2], p[0]), n = cross_product(a, b);
    long double square = dot_product(n, n);
    long double best = fminl(point_segment(p[0], p[2], p[3]), point_segment(p[1], p[2], p[3]));
    best = fminl(best, fminl(point_segment(p[2], p[0], p[1]), point_segment(p[3], p[0], p[1])));
    if (!(square > 0)) return best;
    long double u = dot_product(cross_product(c, b), n) / square,
                v = dot_product(cross_product(c, a), n) / square;
    bool inside = u >= 0 && u <= 1 && v >= 0 && v <= 1;
    return inside ? fminl(best, fabsl(dot_product(c, n)) / sqrtl(square)) : best;
}

long double feature_distance(cscd_contact_kind kind, const elementary_query *query, long double t) {
    vector p[4];
    for (int i = 0; i < 4; i++) p[i] = position_at(query, i, t);
    return kind == CSCD_CONTACT_VF ? point_triangle(p) : segment_segment(p);
}

long double named_distance(cscd_contact_kind kind, const elementary_query *query, long double t,
                           long double u, long double v) {
    vector p[4];
    for (int i = 0; i < 4; i++) p[i] = position_at(query, i, t);
    if (kind == CSCD_CONTACT_EE)
        return vector_norm(vector_difference(point_between(p[0], p[1], u), point_between(p[2], p[3], v)));
    for (int k = 0; k < 3; k++) p[0].x[k] -= (1 - u - v) * p[1].x[k] + u * p[2].x[k] + v * p[3].x[k];
    return vector_norm(p[0]);
}

static vector motion_of(const elementary_query *query, int i) {
    return vector_difference(position_at(query, i, 1), position_at(query, i, 0));
}

/* No two points of the features approach faster. */
static long double closing_speed(cscd_contact_kind kind, const elementary_query *query) {
    long double fastest = 0;
    int first = points_of_first(kind);
    for (int i = 0; i < first; i++)
        for (int j = first; j < 4; j++)
            fastest =
                fmaxl(fastest, vector_norm(vector_difference(motion_of(query, i), motion_of(query, j))));
    return fastest;
}

static bool stays_apart(proof *p, long double low, long double high) {
    long double middle = (low + high) / 2, near = p->speed * (high - low) / 2 * (1 + 0x1p-40L);
    if (p->intervals++ > MOST_INTERVALS) return false;
    if (feature_distance(p->kind, p->query, middle) > near + p->distance) return true;
    return stays_apart(p, low, middle) && stays_apart(p, middle, high);
}

bool proved_apart(cscd_contact_kind kind, const elementary_query *query, long double low, long double high,
                  long double distance) {
    proof p = {kind, query, closing_speed(kind, query), distance + 0x1p-55L * largest_coordinate(query), 0};
    return stays_apart(&p, low, high);
}

long double largest_coordinate(const elementary_query *query) {
    long double largest = 0;
    for (int i = 0; i < 12; i++)
        largest = fmaxl(largest, fmaxl(fabsl(query->x0[i / 3][i % 3]), fabsl(query->x1[i / 3][i % 3])));
    return largest;
}

long double largest_displacement(const elementary_query *query) {
    long double largest = 0;
    for (int i = 0; i < 4; i++) largest = fmaxl(largest, vector_norm(motion_of(query, i)));
    return largest;
}
