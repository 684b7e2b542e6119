/* Reads back what `cscd replay --json` wrote. */
#pragma once

#include "src/io/io_error.h"

#include <stdbool.h>

/* A summary as JSON, to be freed, after a look at all members that a report shows; NULL, with the reason and
 * the place: file and line, or the member that is missing. */
char *summary_file_read(const char *path, io_error *error);
