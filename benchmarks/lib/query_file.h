/* Sets of elementary queries with their exact truth, in the published CSV form. */
#pragma once

#include "runtime/ccd/ccd.h"
#include "tool/io/io.h"

#include <stddef.h>

typedef struct query_set {
    elementary_query *queries;
    bool *truths; /* does the pair touch? */
    size_t count;
} query_set;

/* Eight rows a query, seven integers a row: x, y, z as numerator and denominator, then the truth. VF rows are
 * the vertex and the face at t = 0, then at t = 1; EE rows the ends of a and of b. Integers have any size; a
 * value that is no double is an error, as is a truth that differs between rows. On false *out is
 * untouched. */
bool query_file_read(const char *path, query_set *out, io_error *error);
void query_set_free(query_set *set);

/* Finds the kind from "vertex-face" or "edge-edge" in the path; false when it holds neither. */
bool query_kind_from_path(const char *path, cscd_contact_kind *out);
