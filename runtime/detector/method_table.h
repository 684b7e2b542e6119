/* Says how each method goes through the pipeline. */
#pragma once

#include "cscd/research.h"
#include "runtime/culling/culling.h"
#include "runtime/narrow_phase/narrow_phase.h"

typedef struct method_stages {
    cscd_method method;
    const culling_rules *rules; /* NULL: this build does not have the method */
    const pair_hider *hider;    /* NULL: no pairs are hidden */
    const own_search *search;   /* in place of the trees and tests of a step; NULL: those of a step */
    bool brute_force;           /* tests every pair of features, without trees */
    uint64_t ours;              /* the bits that cscd_detector_options.ours may have */
} method_stages;

/* Returns the row of a method; every method has one. */
const method_stages *method_stages_of(cscd_method method);
