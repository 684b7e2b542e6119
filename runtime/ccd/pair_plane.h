/* A plane that certainly lies between two features at rest, and how far apart it certainly keeps them. */
#pragma once

#include "runtime/ccd/elementary.h"

/* The points of a pair along a direction. docs/theory/displacement-bounds.md, lemma 2, has the errors: with a scale 2^e
 * above the extent of the pair, the heights are off by 2^-50 of the scale and `gap` is at most the distance of the
 * features. Any direction does; a bad one only gives a small gap. */
typedef struct pair_plane {
    double normal[3];     /* from b to a; its length is 1 up to 2^-50 */
    double height[4];     /* of the points along it, above the first point */
    double low_a, high_b; /* the least height of a's points, and the greatest of b's */
    double gap;           /* certainly lies between these; above 0, or the plane proves nothing */
    double distance;      /* at least that of the features */
} pair_plane;

/* Finds a plane across the nearest points. x: the points, as in an elementary_query. */
void pair_plane_find(cscd_contact_kind kind, const double x[4][3], pair_plane *out);

/* Returns a number that is at most the distance of the features less the length, and at least 0.985 times that; 0 if
 * they are no farther apart, or by less than 2^-352. Planes prove most of it, integers the rest. */
double pair_gap(cscd_contact_kind kind, const double x[4][3], double length);
