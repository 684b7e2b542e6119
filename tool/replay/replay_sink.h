/* The outputs of a replay, behind one interface. An output is a replay_sink and a row in the table of
 * replay_sink.c. */
#pragma once

#include "tool/replay/replay_run.h"

/* Functions that an output has no use for are NULL. */
typedef struct replay_sink {
    /* Opens the output. *state stays NULL if the options do not ask for it, and nothing else is called then.
     * On false *state is NULL as well. */
    bool (*open)(replay *r, void **state, io_error *error);
    /* Takes what happens between frame k and the next one. The source has the positions at both ends. */
    bool (*add_interval)(void *state, uint32_t k, const interval_step *step, io_error *error);
    /* Takes a frame, whose positions the source has in x0. Its answer is the last of the answers. found is
     * NULL if nothing was looked for. */
    bool (*add_frame)(void *state, uint32_t frame, const cscd_intersections *found, io_error *error);
    /* Takes the results of an interval, after the frame at its end. */
    bool (*end_interval)(void *state, const interval_result *result, io_error *error);
    /* Writes what is left and frees the state. whole is false if the replay could not begin: then older files
     * stay as they are. */
    bool (*close)(void *state, bool whole, io_error *error);
} replay_sink;

extern const replay_sink summary_sink, report_sink;

/* Opens all outputs. Whatever it returns, sinks_close is due. */
bool sinks_open(replay *r, io_error *error);
bool sinks_add_interval(replay *r, uint32_t k, const interval_step *step, io_error *error);
bool sinks_add_frame(replay *r, uint32_t frame, const cscd_intersections *found, io_error *error);
bool sinks_end_interval(replay *r, const interval_result *result, io_error *error);
/* Closes all outputs, also after an error. The first error is reported. */
bool sinks_close(replay *r, io_error *error);
