/* The points of intersection curves that come or go in an interval, found at its contacts. */
#pragma once

#include "cscd/curve_changes.h"
#include "runtime/intersections/curve_piece.h"
#include "runtime/intersections/placed_names.h"

/* A number to sort by, and what belongs to it. */
typedef struct change_key {
    uint64_t number, value;
} change_key;

/* The memory of all searches; begin with the context and zeroes. */
typedef struct change_finder {
    cscd_context *context;
    placed_names names[2]; /* at the ends of the interval */

    /* Per contact, and one more. */
    change_key *order, *spare_order; /* contacts by toi */
    size_t *rank_first;              /* where the causes of the contacts in that order begin */
    size_t *contact_first, *next;
    size_t contact_capacity;

    /* Per cause. */
    change_key *keys, *spare_keys;
    cscd_curve_change *items;
    size_t *causes, *of_contacts;
    size_t cause_capacity;
} change_finder;

void change_finder_free(change_finder *f);

/* What changes between two moments. names: per vertex the smallest one of its seam, or NULL. The contacts' features are in
 * range. */
cscd_status change_finder_run(change_finder *f, const cscd_mesh *mesh, const double *const ends[2],
                              const uint32_t *names, const cscd_contact *contacts, size_t contact_count,
                              cscd_curve_changes *out);
