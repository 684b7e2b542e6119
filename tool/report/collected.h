/* The state of a report while it is collected, shared by the files of this folder. */
#pragma once

#include "tool/io/io.h"
#include "tool/report/answer_arrays.h"
#include "tool/report/contact_arrays.h"
#include "tool/report/event_list.h"
#include "tool/report/frame_stream.h"
#include "tool/report/orientation_arrays.h"
#include "tool/report/report.h"

struct report {
    report_options options;
    double unit;           /* a power of two: the page's positions are in this many of the files' units */
    uint32_t stride, last; /* every stride-th frame is kept; the frame given last */
    growable kept;         /* uint32_t: the frames in the stream */
    bool last_is_kept;
    double *last_positions; /* NULL where every frame is kept */
    frame_stream frames, scenery;
    contact_arrays contacts;         /* of a replay */
    answer_arrays answers;           /* of a replay */
    event_list events;               /* of a replay */
    orientation_arrays orientations; /* of a replay whose method has them */
};

/* Puts the last frame into the stream, if it is not there yet. */
bool report_keep_last(report *r);
