/* Sequences given as a pattern: walk/f_%04d.obj. */
#pragma once

#include "tool/io/frames/frame_names.h"
#include "tool/io/io_error.h"

#include <stdbool.h>

/* The file name holds exactly one %d or %0Nd (N from 1 to 32), and "%%" wherever a percent sign is meant; the
 * folder holds no conversion. A file belongs to the sequence if printf would write its name for a number from
 * 0 to INT32_MAX: f_%d.obj has f_7.obj but not f_007.obj, f_%02d.obj has f_07.obj and f_100.obj. The sequence
 * starts at the smallest number that the folder has and runs to the largest in a regular step; a missing one in between
 * is an error unless allow_gaps. *folder (to be freed) becomes the folder with its '/', or ""; list holds the names in
 * it, in order, and their numbers. On false *folder is untouched, and list may have grown. */
bool frame_pattern_find(const char *pattern, bool allow_gaps, char **folder, frame_names *list,
                        io_error *error);
