/* The report of a replay. An error in it ends the report and not the replay, and is printed at the end. */
#pragma once

#include "src/tool/common/provenance.h"
#include "src/tool/common/recording.h"
#include "src/tool/common/report_request.h"
#include "src/tool/common/scenery.h"
#include "src/tool/replay/replay_answers.h"
#include "src/tool/report/report.h"

typedef struct replay_report {
    const report_request *request;
    const char *model_path;
    recording *recording;
    report *report;  /* NULL: none was asked for, or it has failed */
    scenery scenery; /* zeroed: none */
    replay_answers answers;
    char generator[PROVENANCE_GENERATOR_SIZE];
    io_error failure; /* "" while all is well */
} replay_report;

/* Opens the scenery, and the report if one is asked for. The frames to come are first to last; are they checked? Whatever this
 * returns, replay_report_close is due. */
bool replay_report_open(replay_report *out, const report_request *request, const char *model_path,
                        recording *r, const cscd_plan *plan, const cscd_detector *detector, uint32_t first,
                        uint32_t last, const part_names *parts, io_error *error);

/* The positions of the first frame. */
void replay_report_begin(replay_report *r, const double *positions);

/* An interval, right after the detector's step, and the positions at its end. */
void replay_report_add(replay_report *r, const cscd_detector *detector, const cscd_contacts *contacts,
                       const double *end);

/* A frame that was checked, after the interval that it ends: finds what intersects there. */
void replay_report_add_frame(replay_report *r, cscd_detector *detector, uint32_t frame,
                             const double *positions);

/* summary: the text of the replay's JSON summary; NULL: there was no memory for it. */
bool replay_report_write(replay_report *r, const char *summary, io_error *error);

void replay_report_close(replay_report *r);
