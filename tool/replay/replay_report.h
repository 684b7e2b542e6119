/* The report of a replay. An error in it ends the report and not the replay, and is printed at the end. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/length_unit.h"
#include "tool/common/provenance.h"
#include "tool/common/scenery.h"
#include "tool/report/report.h"
#include "tool/report/report_request.h"

typedef struct replay_report {
    const report_request *request;
    const char *model_path;
    recording *recording;
    report *report;  /* NULL: none was asked for, or it has failed */
    scenery scenery; /* zeroed: none */
    char generator[PROVENANCE_GENERATOR_SIZE];
    io_error failure; /* "" while all is well */
} replay_report;

/* Opens the scenery, and the report if one is asked for. oriented: there will be orientations. The frames to come are first to last. unit: of the files.
 * Whatever this returns, replay_report_close is due. */
bool replay_report_open(replay_report *out, const report_request *request, const char *model_path,
                        recording *r, const cscd_plan *plan, bool oriented, uint32_t first, uint32_t last,
                        const length_unit *unit, io_error *error);

/* The positions of the first frame. */
void replay_report_begin(replay_report *r, const double *positions);

/* An interval, and the positions at its end. */
void replay_report_add(replay_report *r, const orientation_row *orientations, const cscd_contacts *contacts,
                       const double *end);

/* What was found in a frame, after the interval that it ends. */
void replay_report_add_found(replay_report *r, uint32_t frame, const cscd_intersection_pairs *found);

/* answers: finished; NULL: there are none, and the page then shows no events. summary: the text of the replay's JSON
 * summary; NULL: there was no memory for it. */
bool replay_report_write(replay_report *r, const answers *found, const char *summary, io_error *error);

void replay_report_close(replay_report *r);
