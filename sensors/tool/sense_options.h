/* The options of `cscd sense`. */
#pragma once

#include "cscd/sensors.h"
#include "tool/common/frame_range.h"
#include "tool/common/options.h"
#include "tool/common/recording.h"
#include "tool/picture/picture.h"

typedef struct sense_options {
    recording_options source;
    frame_range frames;
    cscd_sensor_options sensors;
    const char *plan_path; /* NULL: as for replay */
    bool no_plan;
    bool compare, quiet;
    const char *json_path, *csv_path, *picture_path; /* NULL: not given */
    frame_number frame;                              /* of the picture; not given: the last */
    picture_options picture;
    up_axis up;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
} sense_options;

extern const option_table sense_table;

/* False: *code is the exit code to end with (0 after --help). */
bool sense_options_parse(int argument_count, char **arguments, sense_options *out, int *code);
