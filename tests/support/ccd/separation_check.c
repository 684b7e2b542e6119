/* Distances of moving features by dense sampling in long double, which shares nothing with the code under test; and
 * random queries for them. */
#include "tests/support/ccd/separation_check.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>

enum { CELLS = 48, DEPTH_MAX = 40, SAMPLES_MAX = 5000, BISECTIONS = 60 };

/* Of a sampled distance, for an extent of 1. */
#define SAMPLING_ERROR 0x1p-58L

typedef long double vec[3];

bool separation_test(cscd_contact_kind kind, const elementary_query *query, const separation *limit,
                     elementary_contact *hit, bool *bounded) {
    return (kind == CSCD_CONTACT_VF ? separation_vf : separation_ee)(query, limit, hit, bounded);
}

/* ---- distance at one moment ------------------------------------------------------------------------- */

static long double dot_long(const vec a, const vec b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract_long(const vec a, const vec b, vec out) {
    for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

static long double clamped_to_unit(long double x) {
    return x < 0.0L ? 0.0L : x > 1.0L ? 1.0L : x;
}

/* Between p and the point of a b nearest to it. */
static long double point_segment(const vec p, const vec a, const vec b) {
    vec along, offset;
    subtract_long(b, a, along);
    subtract_long(p, a, offset);
    long double length = dot_long(along, along),
                s = length > 0.0L ? clamped_to_unit(dot_long(offset, along) / length) : 0.0L;
    for (int k = 0; k < 3; k++) offset[k] -= s * along[k];
    return sqrtl(dot_long(offset, offset));
}

/* The least of |origin + s first + t second| where it lies inside of the square, or triangle, of s and t.
 * Solved again for what is left over, which makes it good for edges that are nearly parallel. */
static long double inner_minimum(const vec origin, const vec first, const vec second, bool triangle) {
    long double a = dot_long(first, first), b = dot_long(first, second), c = dot_long(second, second),
                s = 0.0L, t = 0.0L;
    long double determinant = a * c - b * b;
    vec offset = {origin[0], origin[1], origin[2]};
    if (!(determinant > 0.0L)) return INFINITY;
    for (int pass = 0; pass < 4; pass++) {
        long double d = dot_long(offset, first), e = dot_long(offset, second);
        s += (b * e - c * d) / determinant;
        t += (b * d - a * e) / determinant;
        for (int k = 0; k < 3; k++) offset[k] = origin[k] + s * first[k] + t * second[k];
    }
    if (s < 0.0L || t < 0.0L || s > 1.0L || t > 1.0L || (triangle && s + t > 1.0L)) return INFINITY;
    return sqrtl(dot_long(offset, offset));
}

static long double distance_vf(const vec x[4]) {
    vec origin, first, second;
    subtract_long(x[1], x[0], origin);
    subtract_long(x[2], x[1], first);
    subtract_long(x[3], x[1], second);
    long double least = inner_minimum(origin, first, second, true);
    for (int i = 1; i < 4; i++) least = fminl(least, point_segment(x[0], x[i], x[i % 3 + 1]));
    return least;
}

static long double distance_ee(const vec x[4]) {
    vec origin, first, second;
    subtract_long(x[0], x[2], origin);
    subtract_long(x[1], x[0], first);
    subtract_long(x[2], x[3], second);
    long double least = inner_minimum(origin, first, second, false);
    for (int i = 0; i < 2; i++) {
        least = fminl(least, point_segment(x[i], x[2], x[3]));
        least = fminl(least, point_segment(x[2 + i], x[0], x[1]));
    }
    return least;
}

/* Relative to the first point at t = 0, which is exact for points that are not too far from it. */
static void position_at(const elementary_query *query, int i, long double t, vec out) {
    for (int k = 0; k < 3; k++) {
        long double origin = query->x0[0][k];
        out[k] = (1.0L - t) * (query->x0[i][k] - origin) + t * (query->x1[i][k] - origin);
    }
}

long double sampled_distance(cscd_contact_kind kind, const elementary_query *query, long double t) {
    vec x[4];
    for (int i = 0; i < 4; i++) position_at(query, i, t, x[i]);
    return kind == CSCD_CONTACT_VF ? distance_vf((const vec *)x) : distance_ee((const vec *)x);
}

/* ---- over the interval ------------------------------------------------------------------------------ */

static long double largest_speed(cscd_contact_kind kind, const elementary_query *query) {
    long double largest = 0.0L;
    int first = points_of_first(kind);
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) {
            vec motion;
            for (int k = 0; k < 3; k++)
                motion[k] = ((long double)query->x1[i][k] - query->x0[i][k]) -
                            ((long double)query->x1[j][k] - query->x0[j][k]);
            largest = fmaxl(largest, sqrtl(dot_long(motion, motion)));
        }
    }
    return largest;
}

typedef struct distance_search {
    cscd_contact_kind kind;
    const elementary_query *query;
    long double distance, speed;
    int samples_left;
} distance_search;

/* Between a sample that is not within the distance and a later one that is: an early one that is. */
static double first_within(const distance_search *s, long double before, long double within) {
    for (int step = 0; step < BISECTIONS; step++) {
        long double middle = 0.5L * (before + within);
        if (sampled_distance(s->kind, s->query, middle) <= s->distance)
            within = middle;
        else
            before = middle;
    }
    return (double)within;
}

/* At both ends the features are farther apart than the distance, by d0 and d1. */
static sampled_answer search_between(distance_search *s, long double t0, long double d0, long double t1,
                                     long double d1, int depth, double *time) {
    if (d0 + d1 - s->speed * (t1 - t0) > 2.0L * s->distance) return SAMPLED_APART;
    if (depth == DEPTH_MAX || s->samples_left-- <= 0) return SAMPLED_UNDECIDED;
    long double middle = 0.5L * (t0 + t1), at = sampled_distance(s->kind, s->query, middle);
    if (at <= s->distance) {
        *time = first_within(s, t0, middle);
        return SAMPLED_WITHIN;
    }
    sampled_answer left = search_between(s, t0, d0, middle, at, depth + 1, time);
    if (left == SAMPLED_WITHIN) return left;
    sampled_answer right = search_between(s, middle, at, t1, d1, depth + 1, time);
    return right != SAMPLED_APART ? right : left;
}

sampled_answer sampled_within(cscd_contact_kind kind, const elementary_query *query, long double distance,
                              double *time) {
    distance_search s = {kind, query, distance, largest_speed(kind, query), SAMPLES_MAX};
    long double before = 0.0L, d0 = sampled_distance(kind, query, before);
    sampled_answer answer = SAMPLED_APART;
    *time = 0.0;
    if (d0 <= distance) return SAMPLED_WITHIN;
    for (int i = 1; i <= CELLS; i++) {
        long double t = (long double)i / CELLS, d1 = sampled_distance(kind, query, t);
        if (d1 <= distance) {
            *time = first_within(&s, before, t);
            return SAMPLED_WITHIN;
        }
        sampled_answer cell = search_between(&s, before, d0, t, d1, 0, time);
        if (cell == SAMPLED_WITHIN) return cell;
        if (cell == SAMPLED_UNDECIDED) answer = cell;
        before = t;
        d0 = d1;
    }
    return answer;
}

long double sampled_least(cscd_contact_kind kind, const elementary_query *query) {
    int best = 0;
    long double least = INFINITY;
    for (int i = 0; i <= CELLS; i++) {
        long double d = sampled_distance(kind, query, (long double)i / CELLS);
        if (d < least) best = i;
        least = fminl(least, d);
    }
    long double low = fmaxl(0.0L, (best - 1.0L) / CELLS), high = fminl(1.0L, (best + 1.0L) / CELLS);
    for (int step = 0; step < BISECTIONS; step++) {
        long double left = low + 0.382L * (high - low), right = high - 0.382L * (high - low);
        long double at_left = sampled_distance(kind, query, left);
        long double at_right = sampled_distance(kind, query, right);
        least = fminl(least, fminl(at_left, at_right));
        if (at_left < at_right)
            high = right;
        else
            low = left;
    }
    return least;
}

/* ---- what must hold of an answer -------------------------------------------------------------------- */

double query_extent_of(const elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            largest = fmax(largest, fabs(query->x0[i][k] - query->x0[0][k]));
            largest = fmax(largest, fabs(query->x1[i][k] - query->x0[0][k]));
        }
    }
    return largest;
}

long double tolerance_of(const elementary_query *query, const separation *limit) {
    return fmaxl(limit->tolerance, (long double)SEPARATION_FINEST * query_extent_of(query));
}

static void fail_query(cscd_contact_kind kind, const elementary_query *query, const separation *limit,
                       const char *what) {
    print_error("%s, distance %a, tolerance %a:\n", kind == CSCD_CONTACT_VF ? "vf" : "ee", limit->distance,
                limit->tolerance);
    for (int i = 0; i < 4; i++)
        print_error("    {%a, %a, %a} -> {%a, %a, %a}\n", query->x0[i][0], query->x0[i][1], query->x0[i][2],
                    query->x1[i][0], query->x1[i][1], query->x1[i][2]);
    fail_msg("%s", what);
}

/* The points that u and v name at toi, relative to the first point at t = 0. */
static void named_points(cscd_contact_kind kind, const elementary_query *query, const elementary_contact *hit,
                         vec a, vec b) {
    vec x[4];
    long double t = hit->toi, u = hit->u, v = hit->v;
    for (int i = 0; i < 4; i++) position_at(query, i, t, x[i]);
    for (int k = 0; k < 3; k++) {
        a[k] = kind == CSCD_CONTACT_VF ? x[0][k] : (1.0L - u) * x[0][k] + u * x[1][k];
        b[k] = kind == CSCD_CONTACT_VF ? (1.0L - u - v) * x[1][k] + u * x[2][k] + v * x[3][k]
                                       : (1.0L - v) * x[2][k] + v * x[3][k];
    }
}

/* Between them; that of two points, so the features are no farther apart. */
static long double named_distance(cscd_contact_kind kind, const elementary_query *query,
                                  const elementary_contact *hit) {
    vec a, b, offset;
    named_points(kind, query, hit, a, b);
    subtract_long(a, b, offset);
    return sqrtl(dot_long(offset, offset));
}

/* What is wrong with the hit's place; NULL if nothing is. */
static const char *wrong_place(cscd_contact_kind kind, const elementary_query *query,
                               const elementary_contact *hit) {
    vec a, b, offset;
    long double rounding = 0x1p-46L * query_extent_of(query), size = 0.0L;
    named_points(kind, query, hit, a, b);
    subtract_long(a, b, offset);
    long double apart = sqrtl(dot_long(offset, offset));
    for (int k = 0; k < 3; k++) {
        long double middle = query->x0[0][k] + 0.5L * (a[k] + b[k]);
        if (fabsl(hit->point[k] - middle) > rounding + 0x1p-52L * fabsl(middle))
            return "the point is not in the middle";
        if (apart > 1e3L * rounding && fabsl(hit->normal[k] - offset[k] / apart) > 2.0L * rounding / apart)
            return "the normal does not point from b to a";
        size += (long double)hit->normal[k] * hit->normal[k];
    }
    if (apart > sampled_distance(kind, query, hit->toi) + rounding) return "u and v are not nearest";
    if (size != 0.0L && fabsl(size - 1.0L) > 1e-14L) return "the normal is not of unit length";
    if (size == 0.0L && apart > rounding) return "there is no normal";
    return NULL;
}

bool check_separation(cscd_contact_kind kind, const elementary_query *query, const separation *limit,
                      bool *bounded) {
    elementary_contact hit;
    double time;
    long double farthest = limit->distance + tolerance_of(query, limit);
    bool reported = separation_test(kind, query, limit, &hit, bounded);
    long double surely = limit->distance - SAMPLING_ERROR * query_extent_of(query);
    bool within = sampled_within(kind, query, surely, &time) == SAMPLED_WITHIN;
    if (within && !reported) fail_query(kind, query, limit, "a pair that comes within the distance is lost");
    if (!reported) return false;
    if (!(hit.toi >= 0.0 && hit.toi <= 1.0)) fail_query(kind, query, limit, "toi is outside of the interval");
    if (within && hit.toi > time) fail_query(kind, query, limit, "toi is late");
    if (!*bounded && named_distance(kind, query, &hit) > farthest)
        fail_query(kind, query, limit, "at toi the features are farther apart than the tolerance allows");
    const char *wrong = wrong_place(kind, query, &hit);
    if (wrong != NULL) fail_query(kind, query, limit, wrong);
    return true;
}

/* ---- families of queries ------------------------------------------------------------------------------- */

/* Any features, any motion. */
static void wild_motion(elementary_query *query) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] = random_unit();
            query->x1[i][k] = random_unit();
        }
    }
}

/* A tenth of their size at most, as in recordings. */
static void slow_motion(elementary_query *query) {
    wild_motion(query);
    double speed = ldexp(1.0, -random_integer(3, 20));
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) query->x1[i][k] = query->x0[i][k] + speed * random_unit();
    }
}

/* Each feature flies without turning. */
static void rigid_motion(elementary_query *query) {
    double motion[4][3];
    wild_motion(query);
    for (int k = 0; k < 3; k++) {
        motion[0][k] = random_unit();
        motion[1][k] = random_unit();
        for (int i = 0; i < 4; i++) query->x1[i][k] = query->x0[i][k] + motion[i > 1][k];
    }
}

/* Small integers: coplanar, parallel, coincident and zero features are common. */
static void on_a_grid(elementary_query *query) {
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] = random_integer(-2, 2);
            query->x1[i][k] = random_integer(0, 2) ? query->x0[i][k] : random_integer(-2, 2);
        }
    }
}

/* Needles and nearly parallel edges: two points of a feature nearly on a line with the others. */
static void thin_features(elementary_query *query) {
    slow_motion(query);
    double width = ldexp(1.0, -random_integer(4, 50)), along = random_between(-0.5, 1.5);
    for (int k = 0; k < 3; k++) {
        double offset = width * random_unit();
        query->x0[3][k] = query->x0[1][k] + along * (query->x0[2][k] - query->x0[1][k]) + offset;
        query->x1[3][k] = query->x1[1][k] + along * (query->x1[2][k] - query->x1[1][k]) + offset;
    }
}

/* Edges side by side that turn through being parallel. */
static void side_by_side(elementary_query *query) {
    wild_motion(query);
    double turn = ldexp(1.0, -random_integer(0, 30)), height = ldexp(1.0, -random_integer(0, 12));
    for (int k = 0; k < 3; k++) {
        double along = random_unit(), up = k == 2 ? height : 0.0;
        query->x0[0][k] = query->x1[0][k] = query->x0[2][k] = query->x1[2][k] = 0.0;
        query->x0[1][k] = query->x1[1][k] = along;
        query->x0[3][k] = along + turn * random_unit();
        query->x1[3][k] = along + turn * random_unit();
        for (int i = 2; i < 4; i++) {
            query->x0[i][k] += up;
            query->x1[i][k] += up * random_between(0.5, 1.0);
        }
    }
}

/* A vertex, or an edge, that stays as near to a turning face, or edge, as it can. */
static void hovering_features(elementary_query *query) {
    double h = ldexp(1.0, -random_integer(1, 20)), turn = ldexp(1.0, -random_integer(0, 12));
    wild_motion(query);
    for (int i = 0; i < 4; i++) {
        query->x0[i][2] = query->x1[i][2] = 0.0;
        query->x0[i][2] = i == 0 ? h : turn * random_unit();
        query->x1[i][2] = i == 0 ? h : -query->x0[i][2];
        for (int k = 0; k < 2; k++) query->x1[i][k] = query->x0[i][k] + turn * random_unit();
    }
}

/* Far from the origin, where coordinates have fewer digits. */
static void far_away(elementary_query *query) {
    double place[3] = {4e5 * random_unit(), -3e6, 7e4};
    slow_motion(query);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            query->x0[i][k] += place[k];
            query->x1[i][k] += place[k];
        }
    }
}

const separation_family separation_families[SEPARATION_FAMILY_COUNT] = {
    {"wild", wild_motion},           {"slow", slow_motion},
    {"rigid", rigid_motion},         {"grid", on_a_grid},
    {"thin", thin_features},         {"side by side", side_by_side},
    {"hovering", hovering_features}, {"far away", far_away}};
