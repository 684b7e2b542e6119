/* The report of a plan: charge, regions, detector points of a mesh at rest. */
#pragma once

#include "tool/common/recording.h"
#include "tool/report/report.h"

typedef struct plan_report {
    const report_request *request;
    const char *model_path;
    const recording *recording;
    const double *positions; /* at rest */
    const cscd_plan *plan;
    int argument_count; /* the command line */
    char **arguments;
} plan_report;

bool plan_report_write(const plan_report *r, io_error *error);
