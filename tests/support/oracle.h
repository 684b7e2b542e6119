/* Brute force over features, which every method must equal. */
#pragma once

#include "cscd/cscd.h"
#include "runtime/ccd/ccd.h"
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

/* Gives all VF and EE pairs without a common vertex whose motions have boxes that meet, but those of two components that are collapsed
 * at an end, to the feature queue, in random order and on every instruction set, without trees or stars. The list is sorted by
 * (toi, kind, a, b). Edges are numbered as the public API says, but by separate code. */
void oracle_find(const scene *s, oracle_list *out);

/* Finds the same with the test of minimum separation. */
void oracle_find_within(const scene *s, const separation *limit, oracle_list *out);

/* Which objects are looked at with which, and how far apart they have to stay. */
typedef struct oracle_rules {
    const uint32_t *vertex_objects;
    uint32_t object_count;
    const double
        *distances; /* object_count rows: 0 for touching, below 0 for objects that are not looked at */
} oracle_rules;

/* Finds contacts and what comes within the distance of its objects, with a tolerance of 1e-6 of it. */
void oracle_find_by_rules(const scene *s, const oracle_rules *rules, oracle_list *out);

/* Fails the test unless a step has found just these. */
void oracle_expect(const oracle_list *truth, const cscd_contacts *found);

void oracle_free(oracle_list *list);
