/* The file names of a sequence of frames: a list in natural order, the series that the numbers in it form,
 * and how it is found from a pattern or a folder. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- the list ------------------------------------------------------------------------------------------ */

typedef struct frame_names {
    growable names;   /* of char *, each owned */
    growable numbers; /* of int32_t: what the artist calls each frame; empty when the names do not say it */
} frame_names;

frame_names frame_names_none(void);
size_t frame_names_count(const frame_names *list);
const char *frame_names_at(const frame_names *list, size_t index);

/* The first length characters of text, to be freed; NULL when out of memory. */
char *frame_names_copy(const char *text, size_t length);

/* Appends a copy; false when out of memory, the list is then as before. */
bool frame_names_add(frame_names *list, const char *name);
void frame_names_free(frame_names *list);

/* Appends the names in folder ("" is the current one) that keep says yes to, in no particular order. Folders
 * in it are passed over. On false the list may have grown. */
bool frame_names_read_folder(frame_names *list, const char *folder,
                             bool (*keep)(const char *name, const void *context), const void *context,
                             io_error *error);

/* True if a number of the name begins here: a digit, or a sign before one. A '-' is a sign behind a dot, an
 * underscore, another '-' or the folder, as in f.-0001.obj; in walk-0001.obj and 2024-06-01.obj it only
 * separates. */
bool frame_names_number_begins(const char *name, const char *at);

/* Natural order: numbers compare by their values, of any length, so f.-1 comes before f.2, and that before
 * f.10. Numbers must not be there yet. */
void frame_names_sort(frame_names *list);
bool frame_names_are_sorted(const frame_names *list);

/* Sorts by the numbers, which are there for every name. False when out of memory. */
bool frame_names_sort_by_number(frame_names *list);

/* ---- series -------------------------------------------------------------------------------------------- */

/* Series: file names that differ in the value of one number only, which says when the frames come; or in that
 * of a number and of the fraction behind it, as f.0001.50.obj. */

/* The difference between two names: in the text around their numbers, or in the values of this many
 * numbers. */
typedef struct name_difference {
    bool in_text;
    size_t number_count;
    size_t last_number; /* how many numbers precede the last one that differs */
} name_difference;

name_difference frame_series_compare(const char *first, const char *second);

/* True if at least two names are listed, each differs from the first in one number only, always the same one,
 * and no two are equal; *number then says which one, counted from 0. The list must be in natural order. */
bool frame_series_find(const frame_names *list, size_t *number);

/* Appends the values of one number of each name to numbers (of int32_t): number says which one, counted from
 * 0, and SIZE_MAX the last one after the last '/'. There are none when a name lacks it or its value is larger
 * than INT32_MAX. False when memory is short; folder: what precedes the names. */
bool frame_series_read(const char *folder, const frame_names *list, size_t number, growable *numbers,
                       io_error *error);

/* A member that a series lacks: the one behind the member `before`. */
typedef struct frame_gap {
    size_t before;
    int64_t missing, step;
} frame_gap;

/* numbers: int32_t, ascending. Their step is the largest one by which all can be reached from the first. */
bool frame_series_find_gap(const growable *numbers, frame_gap *gap);

/* The place of a number in a name. */
typedef struct number_place {
    size_t start, length;
    int width; /* the fewest digits that are written */
} number_place;

/* Fails with the name of the missing file. folder: what precedes the names; place: that of the number in the
 * name behind which it is missing. */
bool frame_series_fail(const char *folder, const frame_names *list, const frame_gap *gap, number_place place,
                       io_error *error);

/* Finds out whether the names are subframes: they differ in a whole number and in the fraction behind it, a
 * dot between, with as many digits in all. Then they are sorted by their times, and their numbers are times
 * in units of the last digit. False when out of memory. */
bool frame_series_take_fractions(frame_names *list, bool *found);

/* A note about subframes, which no whole number names. */
#define FRAME_FRACTIONS_NOTE                                                                                 \
    "the frames are taken in the order of their numbers, and called 0, 1, 2, ... since these have fractions"

/* Fails for the first gap in subframes; after that they have no numbers any more. */
bool frame_series_end_fractions(const char *folder, frame_names *list, bool allow_gaps, io_error *error);

/* Fails for the first gap, if there is one, in a series whose names count by this number. */
bool frame_series_is_complete(const char *folder, const frame_names *list, size_t number, io_error *error);

/* ---- a pattern: walk/f_%04d.obj ------------------------------------------------------------------------ */

/* The file name holds exactly one %d or %0Nd (N from 1 to 32), and "%%" wherever a percent sign is meant; the
 * folder holds no conversion. A file belongs to the sequence if printf would write its name for a number from
 * 0 to INT32_MAX: f_%d.obj has f_7.obj but not f_007.obj, f_%02d.obj has f_07.obj and f_100.obj. The sequence
 * starts at the smallest number that the folder has and runs to the largest in a regular step; a missing one in between
 * is an error unless allow_gaps. *folder (to be freed) becomes the folder with its '/', or ""; list holds the names in
 * it, in order, and their numbers. On false *folder is untouched, and list may have grown. */
bool frame_pattern_find(const char *pattern, bool allow_gaps, char **folder, frame_names *list,
                        io_error *error);

/* ---- a folder that holds one mesh file a frame --------------------------------------------------------- */

/* Appends the mesh files of folder to the empty list, in natural order. Hidden files, folders and all other
 * files are ignored. The names must have one extension and differ in the value of one number only, so that
 * their order is beyond doubt, or be subframes, of which *fractions tells. Unless allow_gaps, none of a
 * regular step may be missing. prefix: the folder with its '/', for messages. On false the list may have
 * grown. */
bool frame_folder_find(const char *folder, const char *prefix, bool allow_gaps, frame_names *list,
                       bool *fractions, io_error *error);
