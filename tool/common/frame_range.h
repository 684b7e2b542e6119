/* Frames: those that --frames A:B:STEP chooses, and lists of spans for people to read. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

/* Frames A:B, both inclusive, by their numbers; A: and :B are open ends, one number is one frame. A:B:STEP is
 * every STEP-th of them, from A on. */
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

/* Finds the frames. numbers: of all frames, ascending. False, with a sentence, if an end of the range lies
 * outside of the recording, or no frame within the range. */
bool frame_range_choose(const frame_range *range, const int32_t *numbers, uint32_t frame_count,
                        frame_choice *out, io_error *error);

/* Finds the frame of a number; false, with a sentence that names the option --frame, if there is none. */
bool frame_range_find(int32_t number, const int32_t *numbers, uint32_t frame_count, uint32_t *frame,
                      io_error *error);

uint32_t frame_choice_count(const frame_choice *choice);

typedef struct frame_span {
    uint32_t first, last;
} frame_span;

typedef struct frame_list {
    frame_span *spans; /* ascending */
    uint32_t count, capacity;
} frame_list;

/* Adds a frame, which is larger than all before. False when out of memory. */
bool frame_list_add(frame_list *list, uint32_t frame);
/* The number of frames in the list. */
uint32_t frame_list_frames(const frame_list *list);

/* Prints prefix, then "3, 7-12, 20", and a line end; for an empty list the line end only. Behind the first 20
 * ranges stands "and others". numbers: of all frames. */
void frame_list_print(const frame_list *list, const int32_t *numbers, const char *prefix);
void frame_list_free(frame_list *list);
