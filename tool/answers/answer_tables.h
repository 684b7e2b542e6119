/* The answers for people: what follows the sentence, the events, the worst first, and the frames. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/length_unit.h"

/* Prints on the standard output a row for each event, as many as a screen holds; nothing where there is none. */
void answers_print_events(const answers *a, const length_unit *unit);

/* The same for each frame that crosses or touches (pairs, share of the triangles that cross another one, depth,
 * milliseconds), and how many are clean. */
void answers_print_frames(const answers *a, const length_unit *unit);
