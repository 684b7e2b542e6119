/* Families of random queries for distances: ordinary, thin, parallel, degenerate, and far from the origin. */
#pragma once

#include "runtime/ccd/ccd.h"

enum { SEPARATION_FAMILY_COUNT = 8 };

typedef struct separation_family {
    const char *name;
    void (*make)(elementary_query *query);
} separation_family;

/* They draw from the stream of tests/support/random.h. */
extern const separation_family separation_families[SEPARATION_FAMILY_COUNT];
