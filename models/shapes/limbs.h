/* Bodies that are put together of limbs. */
#pragma once

#include <stddef.h>

/* A cone with round ends. */
typedef struct limb {
    double a[3], b[3], radius_a, radius_b, blend; /* blend: how far its root is rounded */
} limb;

/* The smaller of two distances, smoothly where they differ by less than `blend`. */
double round_union(double a, double b, double blend);

/* About the distance to all limbs together; each is joined to those before it. */
double limbs_distance(const limb *limbs, size_t count, const double p[3]);
