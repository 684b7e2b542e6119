/* What is asked of one moment: the static check, and the search for intersections by kind. */
#pragma once

#include "runtime/detector/detector.h"

typedef struct moment_question {
    /* Uses the trees, which are at these positions, and leaves in d->check what it has found. */
    cscd_status (*answer)(cscd_detector *d, const double *positions, void *data);
    void *data;
    bool complete; /* d->check has marked every triangle that intersects, so states are known */
} moment_question;

/* Asks at positions in one call that can be cancelled or fail; the caller has read them. */
cscd_status detector_ask_moment(cscd_detector *d, const double *positions, const moment_question *question);
