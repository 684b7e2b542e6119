/* The pairs of triangles that `cscd check` finds, as JSON and as CSV, frame by frame. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/io/output_file.h"

typedef struct check_output {
    const char *json_path, *csv_path; /* NULL: not asked for */
    output_file json_file, csv_file;
    json out;
} check_output;

/* On false check_output_abandon is due. */
bool check_output_open(const char *json_path, const char *csv_path, check_output *out, io_error *error);

/* Adds the frame that the answers have taken last. Triangles are numbered as in their model files; the smaller comes first,
 * because welding keeps the order. Duplicates are counted and not listed. */
bool check_output_add(check_output *out, const answers *a, const cscd_intersection_pairs *found,
                      io_error *error);

/* The answers are finished. */
bool check_output_close(check_output *out, const answers *a, const length_unit *unit, io_error *error);

/* Nothing was found: older files stay. */
void check_output_abandon(check_output *out);
