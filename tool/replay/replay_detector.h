/* The detector of a replay: steps, checks, and a new one for each chunk. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/plans.h"
#include "tool/replay/interval_step.h"
#include "tool/replay/replay_options.h"

typedef struct replay_detector {
    /* All of these outlive it. */
    const replay_options *options;
    const recording *recording;
    const cscd_plan *plan; /* NULL: none */
    cscd_method method;
    ignore_pairs *ignored;
    const answers *answers;
    bool takes_orientations; /* else steps come without */
    bool told_half_turn;     /* one note is enough */

    cscd_detector *detector;
    cscd_guarantee *guarantees;
    orientation_row orientations;
} replay_detector;

/* Makes the first detector; the members above are set. Whatever this returns, replay_detector_close is
 * due. */
bool replay_detector_open(replay_detector *d, io_error *error);
void replay_detector_close(replay_detector *d); /* a zeroed struct is fine */

/* Puts a new detector in its place, which knows nothing of what was before. */
bool replay_detector_renew(replay_detector *d, io_error *error);

/* Does its method have detector points? */
bool replay_detector_is_oriented(const replay_detector *d);

/* The interval from frame k on. Contacts are the detector's. */
bool replay_detector_step(replay_detector *d, uint32_t k, const double *x0, const double *x1,
                          interval_step *out, io_error *error);

/* What intersects in a frame, unless the options say not to look. out->hashes is the caller's. */
bool replay_detector_check(replay_detector *d, uint32_t frame, const double *positions, frame_check *out,
                           io_error *error);
