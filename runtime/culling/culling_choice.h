/* Decides for each component and interval whether culling pays, by counts of work and never by the clock. */
#pragma once

#include "runtime/culling/start_state.h"

/* Decides which components are culled in the interval that begins, where their starts turn out to be clean enough
 * (component_start.chosen). The numbers of triangles are counted. proves: the interval proves its start; otherwise a start that
 * is not known costs nothing, and is not culled. A repetition of the interval decides the same. */
void culling_choice_decide(start_states *s, bool proves);

/* Is a component culled that was not in the last interval? */
bool culling_choice_begins(const start_states *s);

/* What an interval has shown. */
typedef struct culling_outcome {
    const bool *culled; /* per component */
    const uint32_t *
        kept; /* per component that is culled: pairs of its triangles that were not left out; NULL: as before */
    const uint32_t *contacts; /* per component: with itself */
    bool forgets;             /* a component that has contacts is not known at the end (mode EARLIEST) */
    uint64_t passes;          /* closing passes */
} culling_outcome;

/* Learns from the interval that ends, before its end becomes the start of the next. */
void culling_choice_learn(start_states *s, const culling_outcome *outcome);
