/* Lines of results that jobs have left in a file. */
#pragma once

#include "tests/support/tool/json_reader.h"

#include <stddef.h>

enum { LINES_MAX = 64 };

/* Lines by their jobs, from 1; NULL where there is none. */
typedef struct result_lines {
    json_node *of[LINES_MAX + 1];
    size_t count;
} result_lines;

/* Reads the file, and removes it. Every line is whole, and no job is there twice. */
result_lines result_lines_take(const char *path);
void result_lines_free(result_lines *lines);
