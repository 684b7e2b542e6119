/* Series: file names that differ in the value of one number only, which says when the frames come; or in that of a number and of the
 * fraction behind it, as f.0001.50.obj. */
#pragma once

#include "tool/io/frames/frame_names.h"
#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How two names differ: in the text around their numbers, or in the values of this many numbers. */
typedef struct name_difference {
    bool in_text;
    size_t number_count;
    size_t last_number; /* how many numbers precede the last one that differs */
} name_difference;

name_difference frame_series_compare(const char *first, const char *second);

/* True if at least two names are listed, each differs from the first in one number only, always the same one, and no
 * two are equal; *number then says which one, counted from 0. The list must be in natural order. */
bool frame_series_find(const frame_names *list, size_t *number);

/* What the names' numbers count, appended to numbers (of int32_t): number says which one, counted from 0, and SIZE_MAX
 * the last one after the last '/'. There are none when a name lacks it or its value is larger than INT32_MAX. False when
 * memory is short; folder: what precedes the names. */
bool frame_series_read(const char *folder, const frame_names *list, size_t number, growable *numbers,
                       io_error *error);

/* A member that a series lacks: the one behind the member `before`. */
typedef struct frame_gap {
    size_t before;
    int64_t missing, step;
} frame_gap;

/* numbers: int32_t, ascending. Their step is the largest one by which all can be reached from the first. */
bool frame_series_find_gap(const growable *numbers, frame_gap *gap);

/* Where a name has its number. */
typedef struct number_place {
    size_t start, length;
    int width; /* the fewest digits that are written */
} number_place;

/* Fails with the name of the missing file. folder: what precedes the names; place: that of the number in the name
 * behind which it is missing. */
bool frame_series_fail(const char *folder, const frame_names *list, const frame_gap *gap, number_place place,
                       io_error *error);

/* Whether the names are subframes: they differ in a whole number and in the fraction behind it, a dot between, with as many digits in
 * all. Then they are sorted by their times, and their numbers are times in units of the last digit. False when out of memory. */
bool frame_series_take_fractions(frame_names *list, bool *found);

/* What is said of subframes, which no whole number names. */
#define FRAME_FRACTIONS_NOTE                                                                                 \
    "the frames are taken in the order of their numbers, and called 0, 1, 2, ... since these have fractions"

/* Fails for the first gap in subframes; after that they have no numbers any more. */
bool frame_series_end_fractions(const char *folder, frame_names *list, bool allow_gaps, io_error *error);

/* Fails for the first gap, if there is one, in a series whose names count by this number. */
bool frame_series_is_complete(const char *folder, const frame_names *list, size_t number, io_error *error);
