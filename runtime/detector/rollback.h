/* A call that takes long: it can be cancelled, and when it fails the detector is as it was, for a repetition.
 */
#pragma once

#include "src/core/context.h"

struct component_start;

/* What a call that fails puts back; without a progress function nothing, and no memory is taken. Trees that
 * it has built anew stay, and what is known of them: the repetition, when it comes to look at them, finds
 * them as good as new. */
typedef struct call_memory {
    uint8_t *triangles;         /* states at the start, and */
    struct component_start *of; /* what goes with them, per component */
    bool vouched;
    uint32_t intervals_unmeasured;
} call_memory;

cscd_status call_create(cscd_detector *d);
void call_free(cscd_detector *d);

/* Once the positions are checked, and what is known of the start is of the start. */
void call_begin(cscd_detector *d);

/* Ends the call with status, which is no success, and its sentence. IN_CONTACT is an answer, and has both
 * already.
 *
 * A call that is left in the midst has found some contacts and tainted triangles, which are of the start, as
 * are all states until the call succeeds; checks that were left record nothing. So states say at most too
 * little, and the next call is as sound as ever. Only it might do more, or in mode EARLIEST report other
 * contacts, than without the failure: that is why they are put back. */
cscd_status call_fail(cscd_detector *d, cscd_status status);
