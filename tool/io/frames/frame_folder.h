/* Sequences given as a folder that holds one mesh file a frame. */
#pragma once

#include "tool/io/frames/frame_names.h"
#include "tool/io/io_error.h"

#include <stdbool.h>

/* Appends the mesh files of folder to the empty list, in natural order. Hidden files, folders
 * and all other files are ignored. The names must have one extension and differ in the value of one number
 * only, so that their order is beyond doubt, or be subframes (frame_series.h), of which *fractions tells. Unless allow_gaps, none of a regular step may be missing. prefix: the folder
 * with its '/', for messages. On false the list may have grown. */
bool frame_folder_find(const char *folder, const char *prefix, bool allow_gaps, frame_names *list,
                       bool *fractions, io_error *error);
