/* What intersects in each frame of a replay, and the events, for its report. */
#pragma once

#include "src/tool/common/part_names.h"
#include "src/tool/report/report.h"

typedef struct replay_answers {
    recording *recording;
    const part_names *parts;
    cscd_event_tracker *tracker; /* NULL: frames are not checked */
} replay_answers;

/* parts outlive the answers. On false *out holds nothing to close. */
bool replay_answers_open(recording *r, const part_names *parts, replay_answers *out, io_error *error);
void replay_answers_close(replay_answers *answers); /* a zeroed struct is fine */

/* The contacts of an interval, before the frame at its end. */
bool replay_answers_add_contacts(replay_answers *answers, const cscd_contacts *contacts, io_error *error);

/* Finds what intersects in a frame, and adds it to the report. */
bool replay_answers_add_frame(replay_answers *answers, report *page, cscd_detector *detector, uint32_t frame,
                              const double *positions, io_error *error);

/* Adds the events to the report, when the replay has ended. */
bool replay_answers_finish(replay_answers *answers, report *page, io_error *error);
