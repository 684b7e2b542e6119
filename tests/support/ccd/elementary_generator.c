/* Random queries for the elementary tests, most of them degenerate in one way or another. */
#include "tests/support/ccd/elementary_generator.h"

#include "tests/support/ccd/elementary_families.h"

#include <math.h>

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
