/* Lists of proximities in both forms, and their energies. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/rig.h"

typedef struct item_list {
    cscd_proximity *items;
    size_t count;
} item_list;

/* A detector that does not cull. */
rig near_rig(const scene *s, uint32_t threads);

/* Lengths at rest from these positions; NULL forgets them. */
void set_rest(const rig *r, const double *rest);

/* Copies the list, which lives until the next call; the caller frees it. */
item_list find_items(const rig *r, const double *x, double distance, cscd_near_form form);

/* The mollifier of Li et al. 2020, eq. 24, of an item's four vertices. */
double mollifier_of(const cscd_proximity *p, const double *x);

/* The sum of mollifier times a barrier without its pole, so that scenes with contacts have an energy, too. counted: each
 * item as often as it counts. */
double sum_energies(const item_list *list, const double *x, double reach, bool counted);
