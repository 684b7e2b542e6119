/* The events of a recording by comparing everything with everything: the truth of the tests. It shares no code with the
 * tracker. */
#pragma once

#include "tests/support/events/recorded_frames.h"

/* Returns a sorted list, to be freed by the caller. */
cscd_event *recording_oracle(const recorded_frames *r, size_t *count);
