/* The frames that --frames A:B:STEP chooses. */
#pragma once

#include "src/io/io_error.h"

#include <stdint.h>

/* Frames A:B, both inclusive; A: and :B are open ends, one number is one frame. A:B:STEP is every STEP-th of
 * them, from A on. */
typedef struct frame_range {
    uint32_t first, last; /* last UINT32_MAX: to the end */
    uint32_t step;
} frame_range;

/* Every frame. */
frame_range frame_range_all(void);

/* Reads a whole string. When it returns false, *out is untouched. */
bool frame_range_parse(const char *text, frame_range *out);

/* Closes an open end. False, with a sentence, if the recording lacks a frame of the range. */
bool frame_range_close(frame_range *range, uint32_t frame_count, io_error *error);

/* How many frames a closed range has. */
uint32_t frame_range_count(const frame_range *range);
