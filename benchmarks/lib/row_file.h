/* The JSON file of a benchmark: an object with its rows and where they come from. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/json.h"

/* Begins the object. Without a path there is no file: out->file is NULL then, and nothing may be written. */
bool row_file_open(const char *path, json *out, io_error *error);

/* Begins and ends the list of rows. The second also writes the provenance, ends the object and closes the file, if there is one. */
void row_file_begin(json *out);
bool row_file_close(const char *path, int argument_count, char **arguments, uint32_t thread_count, json *out,
                    io_error *error);
