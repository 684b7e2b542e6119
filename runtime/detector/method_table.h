/* How each method goes through the pipeline. */
#pragma once

#include "runtime/culling/culling_rules.h"

typedef struct method_stages {
    const culling_rules *rules; /* NULL: this build does not have the method */
    const pair_hider *hider;    /* NULL: no pairs are hidden */
    bool brute_force;           /* tests every pair of features, without trees */
} method_stages;

/* For every method that there is. */
const method_stages *method_stages_of(cscd_method method);
