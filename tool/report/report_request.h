/* The options of a command about the report that it writes. */
#pragma once

#include "tool/common/options.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct report_request {
    const char *path;                               /* NULL: no report */
    const char *scenery_path, *scenery_frames_path; /* NULL: none */
    const char *title;                              /* NULL: the model's file */
    up_axis up;
} report_request;

/* False, with the reason, if the options contradict each other. */
bool report_request_agrees(const report_request *r, io_error *error);
