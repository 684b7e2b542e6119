/* The frames that --frames A:B:STEP chooses. */
#pragma once

#include "tool/io/io_error.h"

#include <stdint.h>

/* Frames A:B, both inclusive, by their numbers; A: and :B are open ends, one number is one frame. A:B:STEP is every
 * STEP-th of them, from A on. */
typedef struct frame_range {
    int64_t first, last; /* INT64_MIN and INT64_MAX: from the beginning, to the end */
    uint32_t step;
} frame_range;

/* The frames of a range by their indices from 0. */
typedef struct frame_choice {
    uint32_t first, last, step;
} frame_choice;

/* Every frame. */
frame_range frame_range_all(void);

/* Reads a whole string. When it returns false, *out is untouched. */
bool frame_range_parse(const char *text, frame_range *out);

/* Finds the frames. numbers: of all frames, ascending. False, with a sentence, if an end of the range lies outside of
 * the recording, or no frame within the range. */
bool frame_range_choose(const frame_range *range, const int32_t *numbers, uint32_t frame_count,
                        frame_choice *out, io_error *error);

/* Finds the frame of a number; false, with a sentence that names the option --frame, if there is none. */
bool frame_range_find(int32_t number, const int32_t *numbers, uint32_t frame_count, uint32_t *frame,
                      io_error *error);

uint32_t frame_choice_count(const frame_choice *choice);
