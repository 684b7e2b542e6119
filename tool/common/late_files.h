/* Files that come late, as those of a network file system do after another machine has written them. */
#pragma once

#include <stdbool.h>

/* How long to go on trying, since when. */
typedef struct late_files {
    double seconds, began_ms;
} late_files;

/* Begins to try, for so many seconds; 0: once. */
late_files late_files_begin(double seconds);

/* After a failure: rests for a moment and returns true if there is to be another try. An interrupt ends it. */
bool late_files_again(const late_files *late);
