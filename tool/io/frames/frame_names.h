/* The file names of a sequence of frames: a list, how to fill it from a folder, and its natural order. */
#pragma once

#include "tool/io/growable.h"
#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>

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

/* Does a number of the name begin here: a digit, or a sign before one? A '-' is a sign behind a dot, an underscore, another '-' or the
 * folder, as in f.-0001.obj; in walk-0001.obj and 2024-06-01.obj it only separates. */
bool frame_names_number_begins(const char *name, const char *at);

/* Natural order: numbers compare by their values, of any length, so f.-1 comes before f.2, and that before f.10. Numbers must not be
 * there yet. */
void frame_names_sort(frame_names *list);
bool frame_names_are_sorted(const frame_names *list);

/* Sorts by the numbers, which are there for every name. False when out of memory. */
bool frame_names_sort_by_number(frame_names *list);
