/* The tool `cscd`: the function that its program and Python call, summaries that are read back, and reports
 * of many jobs. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>

/* Runs the command that the arguments name, of which the first is the program itself. It prints to stdout and
 * stderr, catches signals while it runs, and returns the exit code of the tool. */
int tool_run(int argument_count, char **arguments);

/* Reads a summary and checks all members that a report shows. Returns it as JSON, to be freed; NULL with
 * the reason and the place: file and line, or the missing member. */
char *summary_file_read(const char *path, io_error *error);

typedef struct jobs_report_request {
    const char *const *paths; /* of results */
    size_t count;
    const char *output_path;
    const char *title, *junit_path; /* NULL: not given */
    bool quiet;
} jobs_report_request;

/* True if the file has results of jobs, by its first line, or by its name, if its content does not say so. */
bool jobs_report_takes(const char *path);

/* Writes the page and prints how many jobs came to what. Returns the exit code, that of one run of the whole
 * list; of a list that is not done, of a failure. */
int jobs_report_write(const jobs_report_request *request);
