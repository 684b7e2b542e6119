/* `cscd report` of results of jobs: one page over all of them. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct jobs_report_request {
    const char *const *paths; /* of results */
    size_t count;
    const char *output_path;
    const char *title, *junit_path; /* NULL: not given */
    bool quiet;
} jobs_report_request;

/* Has the file results of jobs, by its first line? By its name, if its content does not say so. */
bool jobs_report_takes(const char *path);

/* Writes the page and prints how many jobs came to what. Returns the exit code, that of one run of the whole list; of a list that
 * is not done, of a failure. */
int jobs_report_write(const jobs_report_request *request);
