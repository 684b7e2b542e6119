/* Sets of elementary queries with their exact truth, in the published CSV form. */
#include "benchmarks/lib/query_file.h"

#include <errno.h>
#include <gmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS_PER_QUERY = 8, POINTS_PER_TIME = 4 };

/* Reads the integer at *text and moves past it and one comma. */
static bool read_integer(char **text, mpz_ptr out) {
    size_t length = strcspn(*text, ",\r\n");
    char end = (*text)[length];
    (*text)[length] = '\0';
    bool read = length > 0 && mpz_set_str(out, *text, 10) == 0;
    *text += length + (end == ',');
    if (end != ',') **text = end;
    return read;
}

/* Reads numerator / denominator as a double; false when it is none. mpq_get_d truncates, so converting back shows
 * it. */
static bool read_coordinate(char **text, mpq_t value, mpq_t back, double *out) {
    if (!read_integer(text, mpq_numref(value)) || !read_integer(text, mpq_denref(value))) return false;
    if (mpz_sgn(mpq_denref(value)) == 0) return false;
    mpq_canonicalize(value);
    *out = mpq_get_d(value);
    mpq_set_d(back, *out);
    return mpq_equal(value, back) != 0;
}

static bool read_row(char *line, mpq_t value, mpq_t back, double point[3], bool *truth) {
    char *text = line;
    for (int k = 0; k < 3; k++) {
        if (!read_coordinate(&text, value, back, &point[k])) return false;
    }
    *truth = *text == '1';
    return (*text == '0' || *text == '1') && text[1 + strspn(text + 1, "\r\n")] == '\0';
}

static bool make_query_room(query_set *set, size_t *capacity) {
    if (set->count < *capacity) return true;
    size_t wider = *capacity * 2 + 256;
    elementary_query *queries = realloc(set->queries, wider * sizeof *queries);
    if (queries != NULL) set->queries = queries;
    bool *truths = realloc(set->truths, wider * sizeof *truths);
    if (truths != NULL) set->truths = truths;
    *capacity = wider;
    return queries != NULL && truths != NULL;
}

static bool read_rows(FILE *file, const char *path, query_set *set, io_error *error) {
    mpq_t value, back;
    char *line = NULL;
    size_t size = 0, capacity = 0, row = 0;
    bool read = true;
    mpq_inits(value, back, NULL);
    for (; read && getline(&line, &size, file) >= 0; row++) {
        size_t i = row % ROWS_PER_QUERY;
        bool truth = false;
        if (i == 0 && !make_query_room(set, &capacity)) {
            read = io_fail(error, "%s: out of memory", path);
            break;
        }
        elementary_query *query = &set->queries[set->count];
        double *point = i < POINTS_PER_TIME ? query->x0[i] : query->x1[i - POINTS_PER_TIME];
        if (!read_row(line, value, back, point, &truth) || (i > 0 && truth != set->truths[set->count]))
            read = io_fail(error, "%s:%zu: expected three fractions that are doubles and the query's truth",
                           path, row + 1);
        set->truths[set->count] = truth;
        set->count += i + 1 == ROWS_PER_QUERY;
    }
    if (read && row % ROWS_PER_QUERY != 0)
        read = io_fail(error, "%s:%zu: the last query has %zu rows, expected %d", path, row,
                       row % ROWS_PER_QUERY, ROWS_PER_QUERY);
    mpq_clears(value, back, NULL);
    free(line);
    return read;
}

bool query_file_read(const char *path, query_set *out, io_error *error) {
    query_set set = {NULL, NULL, 0};
    FILE *file = fopen(path, "r");
    if (file == NULL) return io_fail(error, "%s: cannot open: %s", path, strerror(errno));
    bool read = read_rows(file, path, &set, error);
    fclose(file);
    if (read)
        *out = set;
    else
        query_set_free(&set);
    return read;
}

void query_set_free(query_set *set) {
    free(set->queries);
    free(set->truths);
    *set = (query_set){NULL, NULL, 0};
}

bool query_kind_from_path(const char *path, cscd_contact_kind *out) {
    if (strstr(path, "vertex-face") != NULL)
        *out = CSCD_CONTACT_VF;
    else if (strstr(path, "edge-edge") != NULL)
        *out = CSCD_CONTACT_EE;
    else
        return false;
    return true;
}
