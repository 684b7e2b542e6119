/* A recording with a plan and a detector, and the report of its replay. */
#pragma once

#include "src/tool/report/report.h"
#include "tests/support/tool/tool_fixture.h"

typedef struct report_rig {
    recorded shape;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
} report_rig;

/* Makes a rig for a method, with a plan of that method. The rig owns the shape. */
report_rig report_rig_create(recorded shape, cscd_method method);
void report_rig_destroy(report_rig *rig);

/* Returns the options for the report of a replay of all frames. */
report_options report_rig_options(const report_rig *rig);

/* Begins the report and adds every interval; false if the report has failed. */
bool report_rig_replay(const report_rig *rig, report *r, io_error *error);

/* Writes the report of the whole replay, with one summary, to path; false if that failed. */
bool report_rig_write(const report_rig *rig, const char *path, io_error *error);
