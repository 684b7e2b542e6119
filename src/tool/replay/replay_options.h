/* The options of `cscd replay`. */
#pragma once

#include "cscd/cscd.h"
#include "src/tool/common/command.h"
#include "src/tool/common/frame_range.h"
#include "src/tool/common/report_request.h"

#include <stddef.h>

typedef struct replay_options {
    const char *model_path;
    const char *const *frame_paths;
    size_t frame_path_count;
    cscd_method method;
    uint32_t k; /* of method KMEANS; 0: not given */
    cscd_mode mode;
    cscd_start start;
    cscd_volume volume;
    cscd_simd simd;
    frame_range frames;
    uint32_t thread_count;
    bool weld;
    double weld_epsilon;
    double min_separation;
    bool ignore_rest, no_check, quiet, fail_on_contact;
    const char *plan_path; /* NULL: not given */
    const char *ignore_path, *contacts_path, *json_path;
    report_request report;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
} replay_options;

/* False: *code is the exit code to end with (0 after --help). */
bool replay_options_parse(int argument_count, char **arguments, replay_options *out, int *code);
