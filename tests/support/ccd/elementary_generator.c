/* Random queries for the elementary tests, most of them degenerate in one way or another. */
#include "tests/support/ccd/elementary_generator.h"

#include <math.h>
#include <string.h>

enum { EXPONENT_LIMIT = 300 };

const char *query_family_name(query_family family) {
    static const char *const names[FAMILY_COUNT] = {
        "tiny grid",   "small grid", "large grid",   "exact contact", "corner contact",
        "end contact", "axis plane", "tilted plane", "turning plane", "collinear",
        "parallel",    "coincident", "static",       "double root",   "triple root",
        "nudged",      "general",    "rounded",      "wild"};
    return names[family];
}

static bool one_in(random_stream *random, uint32_t count) {
    return stream_below(random, count) == 0;
}

static double *coordinate_of(elementary_query *query, int i) {
    return i < 12 ? &query->x0[i / 3][i % 3] : &query->x1[i / 3 - 4][i % 3];
}

static elementary_query some_exact_query(random_stream *random, cscd_contact_kind kind) {
    return exact_query(random, kind, (query_family)stream_below(random, FAMILY_NUDGED));
}

/* ---- inexact families ---- */

static double largest_coordinate(elementary_query *query) {
    double largest = 0.0;
    for (int i = 0; i < 24; i++) largest = fmax(largest, fabs(*coordinate_of(query, i)));
    return largest;
}

/* 0 goes by an ulp of the largest coordinate. */
static elementary_query nudged_query(random_stream *random, cscd_contact_kind kind) {
    elementary_query query = some_exact_query(random, kind);
    for (int n = stream_integer(random, 1, 2); n > 0; n--) {
        double *x = coordinate_of(&query, stream_integer(random, 0, 23));
        double direction = one_in(random, 2) ? 1.0 : -1.0;
        if (*x == 0.0)
            *x = direction * 0x1p-52 * fmax(largest_coordinate(&query), 1.0);
        else
            *x = nextafter(*x, direction * INFINITY);
    }
    return query;
}

static double stream_unit(random_stream *random) {
    return stream_between(random, -1.0, 1.0);
}

/* In (0,1), or beside 0 or 1 by a little or by rounding. */
static double random_parameter(random_stream *random) {
    if (one_in(random, 2)) return stream_between(random, 0.0, 1.0);
    double end = one_in(random, 2) ? 1.0 : 0.0;
    return one_in(random, 3) ? end : end + stream_unit(random) * ldexp(1.0, -stream_integer(random, 0, 52));
}

static void general_features(random_stream *random, cscd_contact_kind kind, double at[4][3]) {
    double u = random_parameter(random), v = random_parameter(random);
    for (int k = 0; k < 3; k++) {
        double meeting = stream_unit(random), a = stream_unit(random), b = stream_unit(random);
        if (kind == CSCD_CONTACT_VF) {
            at[0][k] = meeting;
            at[1][k] = meeting - u * a - (1.0 - u) * v * b;
            at[2][k] = at[1][k] + a;
            at[3][k] = at[1][k] + b;
        } else {
            at[0][k] = meeting - u * a;
            at[1][k] = at[0][k] + a;
            at[2][k] = meeting - v * b;
            at[3][k] = at[2][k] + b;
        }
    }
}

static elementary_query general_query(random_stream *random, cscd_contact_kind kind) {
    double at[4][3], velocity[4][3], before = random_parameter(random);
    double speed = ldexp(1.0, one_in(random, 3) ? -stream_integer(random, 0, 40) : 1);
    general_features(random, kind, at);
    for (int i = 0; i < 12; i++) velocity[i / 3][i % 3] = speed * stream_unit(random);
    return query_through((const double(*)[3])at, (const double(*)[3])velocity, before, 1.0 - before);
}

/* Columns of random numbers do: the families are invariant to linear maps. */
static elementary_query rounded_query(random_stream *random, cscd_contact_kind kind) {
    elementary_query exact = some_exact_query(random, kind), query;
    double map[3][3];
    for (int i = 0; i < 9; i++) map[i / 3][i % 3] = stream_unit(random);
    for (int i = 0; i < 24; i++) {
        const double *x = coordinate_of(&exact, i / 3 * 3), *row = map[i % 3];
        *coordinate_of(&query, i) = row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
    }
    return query;
}

static double wild_number(random_stream *random) {
    if (one_in(random, 8)) return 0.0;
    double mantissa = one_in(random, 2) ? 1.0 : stream_between(random, 1.0, 2.0);
    double value = ldexp(mantissa, stream_integer(random, -EXPONENT_LIMIT, EXPONENT_LIMIT - 1));
    return one_in(random, 2) ? value : -value;
}

/* All coordinates wild, or a few of an exact query's. */
static elementary_query wild_query(random_stream *random, cscd_contact_kind kind) {
    elementary_query query = some_exact_query(random, kind);
    int first = one_in(random, 4) ? 0 : stream_integer(random, 20, 24);
    for (int n = first; n < 24; n++) {
        int i = first == 0 ? n : stream_integer(random, 0, 23);
        *coordinate_of(&query, i) = wild_number(random);
    }
    return query;
}

/* ---- disguise ---- */

static bool in_range(elementary_query *query) {
    for (int i = 0; i < 24; i++) {
        double size = fabs(*coordinate_of(query, i));
        if (size != 0.0 && (size < ldexp(1.0, -EXPONENT_LIMIT) || size > ldexp(1.0, EXPONENT_LIMIT)))
            return false;
    }
    return true;
}

static elementary_query renumbered_points(random_stream *random, cscd_contact_kind kind,
                                          const elementary_query *query) {
    static const int ee_orders[8][4] = {{0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 3, 2}, {1, 0, 3, 2},
                                        {2, 3, 0, 1}, {3, 2, 0, 1}, {2, 3, 1, 0}, {3, 2, 1, 0}};
    static const int vf_orders[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                        {0, 1, 3, 2}, {0, 2, 1, 3}, {0, 3, 2, 1}};
    if (kind == CSCD_CONTACT_VF) return query_permuted(query, vf_orders[stream_below(random, 6)]);
    return query_permuted(query, ee_orders[stream_below(random, 8)]);
}

static elementary_query axes_exchanged(random_stream *random, elementary_query *query) {
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
    const int *order = orders[stream_below(random, 6)];
    elementary_query out;
    for (int i = 0; i < 24; i++) *coordinate_of(&out, i) = *coordinate_of(query, i / 3 * 3 + order[i % 3]);
    return out;
}

static void scale_axes(random_stream *random, elementary_query *query) {
    static const int limits[] = {0, 2, 20, 299};
    bool each_axis = one_in(random, 2);
    int limit = limits[stream_below(random, 4)], exponents[3];
    for (int k = 0; k < 3; k++)
        exponents[k] = k > 0 && !each_axis ? exponents[0] : stream_integer(random, -limit, limit);
    for (int i = 0; i < 24; i++) *coordinate_of(query, i) = ldexp(*coordinate_of(query, i), exponents[i % 3]);
}

/* Far from the origin, where that needs no rounding. */
static void shift_exactly(random_stream *random, elementary_query *query) {
    elementary_query shifted = *query;
    int exponent = stream_integer(random, 0, 40);
    for (int i = 0; i < 24; i++) {
        double *x = coordinate_of(&shifted, i), before = *x,
               offset = ldexp(i % 3 == 1 ? -3.0 : 1.0, exponent);
        *x += offset;
        if (*x - offset != before || *x - before != offset) return;
    }
    *query = shifted;
}

elementary_query generate_query(random_stream *random, cscd_contact_kind kind, query_family family) {
    elementary_query query;
    switch (family) {
    case FAMILY_NUDGED:
        query = nudged_query(random, kind);
        break;
    case FAMILY_GENERAL:
        query = general_query(random, kind);
        break;
    case FAMILY_ROUNDED:
        query = rounded_query(random, kind);
        break;
    case FAMILY_WILD:
        query = wild_query(random, kind);
        break;
    default:
        query = exact_query(random, kind, family);
        break;
    }
    query = renumbered_points(random, kind, &query);
    query = axes_exchanged(random, &query);
    if (one_in(random, 2)) query = query_reversed(&query);
    if (one_in(random, 4)) shift_exactly(random, &query);
    elementary_query scaled = query;
    scale_axes(random, &scaled);
    return in_range(&scaled) ? scaled : query;
}

/* ---- exact families ------------------------------------------------------------------------------------ */

/* Positions at a moment, and velocities. */
typedef struct moving_points {
    double at[4][3], velocity[4][3];
} moving_points;

int stream_integer(random_stream *random, int lowest, int highest) {
    return lowest + (int)stream_below(random, (uint32_t)(highest - lowest + 1));
}

static void grid_vector(random_stream *random, int range, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = stream_integer(random, -range, range);
}

static int some_range(random_stream *random) {
    static const int ranges[] = {1, 1, 2, 3, 5, 10, 100, 1000, 1 << 20};
    return ranges[stream_below(random, 9)];
}

static elementary_query grid_query(random_stream *random, int range) {
    elementary_query query;
    for (int i = 0; i < 4; i++) {
        grid_vector(random, range, query.x0[i]);
        grid_vector(random, range, query.x1[i]);
    }
    return query;
}

/* ---- contacts at a moment ---- */

typedef enum place { ANYWHERE, ON_BORDER, JUST_OUTSIDE } place;

/* u = i / 4, v = j / 4 */
static void choose_place(random_stream *random, cscd_contact_kind kind, place where, int *i, int *j) {
    static const int vf_border[6][2] = {{0, 0}, {4, 0}, {0, 4}, {1, 0}, {0, 3}, {2, 2}};
    static const int ee_border[8][2] = {{0, 0}, {4, 0}, {0, 4}, {4, 4}, {0, 1}, {4, 2}, {3, 0}, {2, 4}};
    uint32_t n = stream_below(random, kind == CSCD_CONTACT_VF ? 6 : 8);
    if (where == ON_BORDER) {
        *i = kind == CSCD_CONTACT_VF ? vf_border[n][0] : ee_border[n][0];
        *j = kind == CSCD_CONTACT_VF ? vf_border[n][1] : ee_border[n][1];
    } else if (where == ANYWHERE) {
        *i = stream_integer(random, 0, 4);
        *j = stream_integer(random, 0, kind == CSCD_CONTACT_VF ? 4 - *i : 4);
    } else {
        *i = stream_integer(random, -1, 5);
        *j = *i >= 0 && *i <= 4 ? 5 : stream_integer(random, 0, 4);
    }
}

/* Points of the features with sides a and b; those named by u and v are b's + offset at the origin. */
static void place_features(cscd_contact_kind kind, const int uv[2], const double a[3], const double b[3],
                           const double offset[3], double out[4][3]) {
    double u = 0.25 * uv[0], v = 0.25 * uv[1];
    for (int k = 0; k < 3; k++) {
        if (kind == CSCD_CONTACT_VF) {
            out[0][k] = 0.0;
            out[1][k] = offset[k] - u * a[k] - v * b[k];
            out[2][k] = out[1][k] + a[k];
            out[3][k] = out[1][k] + b[k];
        } else {
            out[0][k] = -u * a[k];
            out[1][k] = out[0][k] + a[k];
            out[2][k] = offset[k] - v * b[k];
            out[3][k] = out[2][k] + b[k];
        }
    }
}

static void integer_features(random_stream *random, cscd_contact_kind kind, place where, int range,
                             double at[4][3]) {
    double a[3], b[3], meeting[3];
    int uv[2];
    choose_place(random, kind, where, &uv[0], &uv[1]);
    grid_vector(random, range, a);
    grid_vector(random, range, b);
    grid_vector(random, range, meeting);
    for (int k = 0; k < 3; k++) {
        a[k] *= 4.0;
        b[k] *= 4.0;
    }
    place_features(kind, uv, a, b, (const double[3]){0, 0, 0}, at);
    for (int i = 0; i < 12; i++) at[i / 3][i % 3] += meeting[i % 3];
}

static moving_points contact_points(random_stream *random, cscd_contact_kind kind, place where) {
    moving_points points;
    int range = some_range(random), speed = one_in(random, 3) ? some_range(random) : range;
    integer_features(random, kind, where, range, points.at);
    for (int i = 0; i < 4; i++) grid_vector(random, speed, points.velocity[i]);
    return points;
}

/* The moment is before / (before + after). */
static elementary_query query_through_contact(const moving_points *points, int before, int after) {
    return query_through((const double(*)[3])points->at, (const double(*)[3])points->velocity, before, after);
}

static elementary_query at_some_time(random_stream *random, const moving_points *points) {
    int largest = one_in(random, 4) ? 1000 : 5;
    int before = stream_integer(random, 0, largest);
    return query_through_contact(points, before, stream_integer(random, before == 0, largest));
}

/* Half of them touch; the others would if their features were larger. */
static moving_points contact_or_not(random_stream *random, cscd_contact_kind kind) {
    return contact_points(random, kind, one_in(random, 2) ? ANYWHERE : JUST_OUTSIDE);
}

static elementary_query contact_at_end(random_stream *random, cscd_contact_kind kind) {
    moving_points points = contact_points(random, kind, (place)stream_below(random, 3));
    if (one_in(random, 2)) return query_through_contact(&points, 0, 1);
    return query_through_contact(&points, 1, 0);
}

/* ---- flat ---- */

static elementary_query axis_plane(random_stream *random, cscd_contact_kind kind) {
    elementary_query query;
    if (one_in(random, 2)) {
        query = grid_query(random, some_range(random));
    } else {
        moving_points points = contact_or_not(random, kind);
        query = at_some_time(random, &points);
    }
    double start = stream_integer(random, -3, 3), end = stream_integer(random, -3, 3);
    for (int i = 0; i < 4; i++) {
        query.x0[i][2] = start;
        query.x1[i][2] = end;
    }
    return query;
}

/* The planar x, y in the frame of two vectors of space; z is the common motion along a third one. */
static elementary_query tilted_plane(random_stream *random, cscd_contact_kind kind) {
    elementary_query flat = axis_plane(random, kind), query;
    double frame[3][3];
    for (int i = 0; i < 3; i++) grid_vector(random, 3, frame[i]);
    for (int i = 0; i < 12; i++) {
        int p = i / 3, k = i % 3;
        query.x0[p][k] = query.x1[p][k] = 0.0;
        for (int n = 0; n < 3; n++) {
            query.x0[p][k] += flat.x0[p][n] * frame[n][k];
            query.x1[p][k] += flat.x1[p][n] * frame[n][k];
        }
    }
    return query;
}

/* i e + j f(t), where i moves only if e rests: linear in time, and in the plane of e and f. */
static elementary_query turning_plane(random_stream *random, cscd_contact_kind kind) {
    elementary_query flat = axis_plane(random, kind), query;
    double e[2][3], f[2][3], origin[2][3];
    bool sliding = !one_in(random, 3);
    for (int n = 0; n < 2; n++) {
        grid_vector(random, 3, e[n]);
        grid_vector(random, 3, f[n]);
        grid_vector(random, 3, origin[n]);
    }
    if (sliding) memcpy(e[1], e[0], sizeof e[0]);
    for (int i = 0; i < 12; i++) {
        int p = i / 3, k = i % 3;
        double end = sliding ? flat.x1[p][0] : flat.x0[p][0];
        query.x0[p][k] = origin[0][k] + flat.x0[p][0] * e[0][k] + flat.x0[p][1] * f[0][k];
        query.x1[p][k] = origin[1][k] + end * e[1][k] + flat.x0[p][1] * f[1][k];
    }
    return query;
}

static elementary_query collinear_query(random_stream *random) {
    elementary_query along = grid_query(random, some_range(random)), query;
    double e[2][3], origin[2][3];
    bool turning = one_in(random, 3);
    for (int n = 0; n < 2; n++) {
        grid_vector(random, 3, e[n]);
        grid_vector(random, 3, origin[n]);
    }
    if (!turning) memcpy(e[1], e[0], sizeof e[0]);
    for (int i = 0; i < 12; i++) {
        int p = i / 3, k = i % 3;
        query.x0[p][k] = origin[0][k] + along.x0[p][0] * e[0][k];
        query.x1[p][k] = origin[1][k] + (turning ? along.x0 : along.x1)[p][0] * e[1][k];
    }
    return query;
}

/* EE: the second edge is a multiple of the first, which may turn. VF: the vertex keeps a multiple of one side
 * as its distance from a corner. */
static elementary_query parallel_query(random_stream *random, cscd_contact_kind kind) {
    moving_points points = contact_or_not(random, kind);
    elementary_query query = at_some_time(random, &points);
    int multiple = stream_integer(random, -3, 3), pivot = kind == CSCD_CONTACT_VF ? 1 : 2;
    int moved = kind == CSCD_CONTACT_VF ? 0 : 3, from = kind == CSCD_CONTACT_VF ? 2 : 0,
        to = kind == CSCD_CONTACT_VF ? 3 : 1;
    if (one_in(random, 4)) query = grid_query(random, some_range(random));
    for (int k = 0; k < 3; k++) {
        query.x0[moved][k] = query.x0[pivot][k] + multiple * (query.x0[to][k] - query.x0[from][k]);
        query.x1[moved][k] = query.x1[pivot][k] + multiple * (query.x1[to][k] - query.x1[from][k]);
    }
    return query;
}

static elementary_query coincident_query(random_stream *random, cscd_contact_kind kind) {
    moving_points points = contact_or_not(random, kind);
    elementary_query query = at_some_time(random, &points);
    if (one_in(random, 2)) query = grid_query(random, some_range(random));
    for (int n = stream_integer(random, 1, 2); n > 0; n--) {
        uint32_t from = stream_below(random, 4), to = (from + 1 + stream_below(random, 3)) % 4;
        uint32_t when = stream_below(random, 4);
        if (when != 0) memcpy(query.x0[to], query.x0[from], sizeof query.x0[to]);
        if (when != 1) memcpy(query.x1[to], query.x1[from], sizeof query.x1[to]);
    }
    return query;
}

static elementary_query at_rest(random_stream *random, cscd_contact_kind kind) {
    moving_points points = contact_points(random, kind, (place)stream_below(random, 3));
    double motion[3] = {0, 0, 0};
    if (one_in(random, 2)) grid_vector(random, some_range(random), motion);
    for (int i = 0; i < 4; i++) memcpy(points.velocity[i], motion, sizeof motion);
    elementary_query query = at_some_time(random, &points);
    return query;
}

/* ---- multiple roots ---- */

/* Sides a and b and offset c, at s = 0 and per s, of determinant O(s^2) and s^3; c is 0 at s = 0. */
typedef struct grazing {
    double a[2][3], b[2][3], c[2][3];
} grazing;

static grazing double_root(random_stream *random) {
    grazing m = {.a = {{4, 0, 0}}, .b = {{0, 4, 0}}};
    grid_vector(random, 4, m.a[1]);
    grid_vector(random, 4, m.b[1]);
    grid_vector(random, 4, m.c[1]);
    m.c[1][2] = 0.0;
    return m;
}

static grazing triple_root(random_stream *random) {
    double p = stream_integer(random, 1, 4), q = stream_integer(random, -4, -1);
    double r = stream_integer(random, 1, 4);
    return (grazing){{{4, 0, 0}, {0, p, 0}}, {{0, 4, 0}, {0, 0, q}}, {{0, 0, 0}, {r, 0, 0}}};
}

static void shear_points(random_stream *random, moving_points *points) {
    uint32_t to = stream_below(random, 3), from = (to + 1 + stream_below(random, 2)) % 3;
    double factor = stream_integer(random, -2, 2);
    for (int i = 0; i < 4; i++) {
        points->at[i][to] += factor * points->at[i][from];
        points->velocity[i][to] += factor * points->velocity[i][from];
    }
}

/* All four points in one place at one moment: a triple root, too. */
static moving_points imploding_query(random_stream *random) {
    moving_points points;
    double meeting[3];
    grid_vector(random, some_range(random), meeting);
    int speed = some_range(random);
    for (int i = 0; i < 4; i++) {
        memcpy(points.at[i], meeting, sizeof meeting);
        grid_vector(random, speed, points.velocity[i]);
    }
    return points;
}

static elementary_query grazing_query(random_stream *random, cscd_contact_kind kind, bool triple) {
    grazing m = triple ? triple_root(random) : double_root(random);
    moving_points points;
    double motion[3], lift = 0.0;
    int uv[2];
    choose_place(random, kind, one_in(random, 4) ? ON_BORDER : ANYWHERE, &uv[0], &uv[1]);
    if (one_in(random, 2)) lift = ldexp(one_in(random, 2) ? 1.0 : -1.0, -stream_integer(random, 0, 42));
    m.c[0][stream_below(random, 3) == 0 ? stream_below(random, 3) : 2] += lift;
    place_features(kind, uv, m.a[0], m.b[0], m.c[0], points.at);
    place_features(kind, uv, m.a[1], m.b[1], m.c[1], points.velocity);
    if (triple && one_in(random, 3)) points = imploding_query(random);
    grid_vector(random, 3, motion);
    for (int i = 0; i < 12; i++) points.velocity[i / 3][i % 3] += motion[i % 3];
    for (int i = stream_integer(random, 0, 3); i > 0; i--) shear_points(random, &points);
    int before = stream_integer(random, 1, 4);
    return query_through_contact(&points, before, stream_integer(random, 1, 4));
}

elementary_query exact_query(random_stream *random, cscd_contact_kind kind, query_family family) {
    moving_points points;
    switch (family) {
    case FAMILY_SMALL_GRID:
        return grid_query(random, stream_integer(random, 2, 5));
    case FAMILY_LARGE_GRID:
        return grid_query(random, one_in(random, 2) ? 10 : 1 << stream_integer(random, 4, 26));
    case FAMILY_EXACT_CONTACT:
        points = contact_or_not(random, kind);
        break;
    case FAMILY_CORNER_CONTACT:
        points = contact_points(random, kind, ON_BORDER);
        break;
    case FAMILY_END_CONTACT:
        return contact_at_end(random, kind);
    case FAMILY_AXIS_PLANE:
        return axis_plane(random, kind);
    case FAMILY_TILTED_PLANE:
        return tilted_plane(random, kind);
    case FAMILY_TURNING_PLANE:
        return turning_plane(random, kind);
    case FAMILY_COLLINEAR:
        return collinear_query(random);
    case FAMILY_PARALLEL:
        return parallel_query(random, kind);
    case FAMILY_COINCIDENT:
        return coincident_query(random, kind);
    case FAMILY_STATIC:
        return at_rest(random, kind);
    case FAMILY_DOUBLE_ROOT:
        return grazing_query(random, kind, false);
    case FAMILY_TRIPLE_ROOT:
        return grazing_query(random, kind, true);
    default:
        return grid_query(random, 1);
    }
    return at_some_time(random, &points);
}
