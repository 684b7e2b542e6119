/* The elementary test as such codes have it: the real roots of the coplanarity cubic in plain doubles, and an inside test at each
 * (Provot 1997; Bridson, Fedkiw, Anderson 2002). It has no bound of its rounding, so it may err on either side. */
#pragma once

#include "runtime/baselines/gsl/plain_cubic.h"
#include "runtime/ccd/ccd.h"

/* Writes the first touch, as elementary_after_signs does. */
bool plain_test(const plain_cubic_functions *roots, const elementary_query *query, cscd_contact_kind kind,
                elementary_contact *contact);
