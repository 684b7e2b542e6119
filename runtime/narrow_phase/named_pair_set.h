/* A sorted set of pairs of features, or of triangles. */
#pragma once

#include "src/core/context.h"
#include "src/mesh/mesh.h"

/* A cscd_contact_kind, and a and b as in lists of that kind. */
typedef struct named_pair {
    uint32_t kind, a, b;
    uint32_t marked; /* of use to whoever goes through a set */
} named_pair;

typedef struct named_pair_set {
    named_pair *items; /* sorted by (kind, a, b) */
    size_t count, capacity;
    size_t triangle_pairs; /* so many of them are of the kind TT */
} named_pair_set;

void named_pair_set_free(cscd_context *context, named_pair_set *set);

/* Appends a pair; the set is sorted later, by named_pair_set_sort. False: no memory. */
bool named_pair_set_add(cscd_context *context, named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                        uint32_t b);

/* Sorts what has been added, and drops repetitions. False: no memory. */
bool named_pair_set_sort(cscd_context *context, named_pair_set *set);

/* Keeps the marked pairs, and takes the marks off. */
void named_pair_set_keep_marked(named_pair_set *set);

/* Returns the pair of the set, or NULL. */
named_pair *named_pair_set_find(const named_pair_set *set, cscd_contact_kind kind, uint32_t a, uint32_t b);

static inline bool named_pair_set_has(const named_pair_set *set, cscd_contact_kind kind, uint32_t a,
                                      uint32_t b) {
    return set->count > 0 && named_pair_set_find(set, kind, a, b) != NULL;
}
