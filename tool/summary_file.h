/* Reads back what `cscd replay --json` wrote. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>

/* Reads a summary and checks all members that a report shows. Returns it as JSON, to be freed; NULL with
 * the reason and the place: file and line, or the missing member. */
char *summary_file_read(const char *path, io_error *error);
