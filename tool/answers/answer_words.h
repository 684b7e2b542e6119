/* The answers for people: a sentence, which comes first, and tables of events and frames. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/length_unit.h"

#include <stdio.h>

/* Prints which frames cross or touch, how many events there are and which one is the worst:
 *
 *     Frames 17 to 43 cross (27 of 48). 5 events, worst: forearm.L x forearm.R, frames 21 to 29, 12.4 mm deep at frame 24.
 *
 * Of a single frame, how many triangles cross. Where not all was looked at that was asked for (answers_unfinished), that comes
 * first, and nothing is called clean; where less was asked for than the recording has, the frames are named. After
 * answers_finish. */
void answers_print_sentence(FILE *out, const answers *a, const length_unit *unit);

/* Prints on the standard output a row for each event, as many as a screen holds; nothing where there is none. */
void answers_print_events(const answers *a, const length_unit *unit);

/* The same for each frame that crosses or touches (pairs, share of the triangles that cross another one, depth,
 * milliseconds), and how many are clean. */
void answers_print_frames(const answers *a, const length_unit *unit);
