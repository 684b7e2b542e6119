/* Brute force over features: what every method must equal. */
#pragma once

#include "cscd/cscd.h"
#include "runtime/ccd/min_separation.h"
#include "tests/support/scenes.h"

/* A contact as a triple that can be sorted and compared. */
typedef struct oracle_contact {
    cscd_contact_kind kind;
    uint32_t a, b;
    double toi;
} oracle_contact;

typedef struct oracle_list {
    oracle_contact *items;
    size_t count, capacity;
} oracle_list;

/* All VF and EE pairs without a common vertex, each given to the elementary test; no volumes, no stars.
 * Sorted by (toi, kind, a, b). Edges are numbered as the public API says, by its own reckoning. */
void oracle_find(const scene *s, oracle_list *out);

/* The same with the test for minimum separation. */
void oracle_find_within(const scene *s, const separation *limit, oracle_list *out);

void oracle_free(oracle_list *list);
