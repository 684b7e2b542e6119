/* Random queries for the elementary tests, most of them degenerate in one way or another. */
#pragma once

#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"

typedef enum query_family {
    FAMILY_TINY_GRID,      /* coordinates -1, 0, 1 */
    FAMILY_SMALL_GRID,     /* 2 .. 5 */
    FAMILY_LARGE_GRID,     /* 10 .. 2^26 */
    FAMILY_EXACT_CONTACT,  /* at a rational time, anywhere on the features */
    FAMILY_CORNER_CONTACT, /* at a rational time, on a corner or border */
    FAMILY_END_CONTACT,    /* at t = 0 or t = 1 */
    FAMILY_AXIS_PLANE,     /* always in a plane across an axis, which may move */
    FAMILY_TILTED_PLANE,   /* always in a plane of another direction, which may move */
    FAMILY_TURNING_PLANE,  /* always in a plane, which turns */
    FAMILY_COLLINEAR,      /* always on a line, which may move or turn */
    FAMILY_PARALLEL,       /* always parallel edges; a vertex that keeps its height above the face */
    FAMILY_COINCIDENT,     /* points that are one for good, or at an end */
    FAMILY_STATIC,         /* at rest, or one common motion */
    FAMILY_DOUBLE_ROOT,    /* features that graze, or all but */
    FAMILY_TRIPLE_ROOT,    /* a triple root at a contact, or all but */
    FAMILY_NUDGED,         /* another family's query, one or two coordinates an ulp off */
    FAMILY_GENERAL,        /* doubles that nearly touch in general position */
    FAMILY_ROUNDED,        /* an exact family's query, turned in space with rounding */
    FAMILY_WILD,           /* 0 and magnitudes from 2^-300 to 2^300 in one query */
    FAMILY_COUNT
} query_family;

const char *query_family_name(query_family family);

/* Points are renumbered, axes exchanged, time reversed, coordinates shifted and scaled by powers of two at
 * random, exactly, so that all coordinates are 0 or from 2^-300 to 2^300. */
elementary_query generate_query(random_stream *random, cscd_contact_kind kind, query_family family);

/* ---- exact families ------------------------------------------------------------------------------------ */

/* Both ends included. */
int stream_integer(random_stream *random, int lowest, int highest);

/* A query of the family, which comes before FAMILY_NUDGED. */
elementary_query exact_query(random_stream *random, cscd_contact_kind kind, query_family family);
