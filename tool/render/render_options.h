/* The options of `cscd render`. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/options.h"
#include "tool/picture/picture.h"

typedef enum colouring {
    COLOUR_PLAIN,
    COLOUR_CONTACTS,
    COLOUR_CHARGE,
    COLOUR_DENSITY,
    COLOUR_REGION
} colouring;

typedef struct render_options {
    recording_options source;
    const char *output_path, *plan_path;            /* NULL: not given */
    const char *scenery_path, *scenery_frames_path; /* NULL: not given */
    frame_number frame;                             /* of a single picture; not given: the first */
    bool strip;                                     /* several frames in one picture: */
    frame_range frames;
    uint32_t columns; /* 0: not given */
    bool follow;
    colouring colouring;
    bool zoom, no_text;
    picture_options picture;
    up_axis up;
    ignore_options ignored;
} render_options;

/* False: *code is the exit code to end with (0 after --help). */
bool render_options_parse(int argument_count, char **arguments, render_options *out, int *code);
