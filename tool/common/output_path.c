/* Keeps a command from writing over what it reads. */
#include "tool/common/options.h"

#include "tool/io/io.h"
#include "tool/io/output_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Do two paths name one file that does not exist yet: the same name in the same folder? */
static bool same_place(const char *a, const char *b) {
    const char *names[2] = {a, b};
    char *folders[2] = {NULL, NULL};
    for (int i = 0; i < 2; i++) {
        const char *slash = path_last_separator(names[i]);
        char *folder = slash != NULL ? strndup(names[i], (size_t)(slash - names[i]) + 1) : strdup(".");
        folders[i] = folder != NULL ? realpath(folder, NULL) : NULL;
        free(folder);
        names[i] = slash != NULL ? slash + 1 : names[i];
    }
    bool same = folders[0] != NULL && folders[1] != NULL && strcmp(folders[0], folders[1]) == 0 &&
                strcmp(names[0], names[1]) == 0;
    free(folders[0]);
    free(folders[1]);
    return same;
}

static bool same_file(const char *a, const char *b) {
    struct stat first, second;
    if (strcmp(a, b) == 0 || same_place(a, b)) return true;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

static bool named_like_input(const char *path) {
    static const char *const others[] = {".pc2", ".mdd"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (path_has_extension(path, others[i])) return true;
    return path_mesh_ending(path) > 0;
}

bool output_path_fits(const char *path, const char *ending, io_error *error) {
    static const char *const known[] = {".png", ".jpg", ".jpeg", ".gif",  ".bmp",  ".tif",   ".tiff", ".webp",
                                        ".svg", ".exr", ".pdf",  ".html", ".json", ".jsonl", ".csv",  ".tsv",
                                        ".txt", ".xml", ".xlsx", ".md",   ".vtk",  ".vtp",   ".mp4",  ".mov"};
    for (size_t i = 0; path != NULL && i < sizeof known / sizeof *known; i++) {
        if (path_has_extension(path, known[i]) && strcmp(known[i], ending) != 0)
            return io_fail(error, "'%s' would be no %s file; choose a name that ends in %s", path,
                           known[i] + 1, ending);
    }
    return true;
}

/* Removes the file that was created to see whether it can be; a link that led to nothing stays. */
static void remove_created(const char *path) {
    char *target = realpath(path, NULL);
    if (target != NULL) unlink(target);
    free(target);
}

/* A pipe is not opened: its reader would take the end of this writer for the end of the data. */
static bool try_open(const char *path) {
    struct stat status;
    if (output_file_is_standard(path)) return output_file_standard_opens();
    bool exists = stat(path, &status) == 0;
    if (exists && S_ISFIFO(status.st_mode)) return access(path, W_OK) == 0;
    FILE *file = fopen(path, "ab");
    if (file == NULL) return false;
    fclose(file);
    if (!exists) remove_created(path);
    return true;
}

bool output_path_opens(const char *path, io_error *error) {
    return path == NULL || try_open(path) || io_fail_write(error, path);
}

bool output_path_differs(const char *path, const char *const *others, size_t other_count, io_error *error) {
    for (size_t i = 0; path != NULL && i < other_count; i++) {
        if (others[i] == NULL) continue;
        if (output_file_is_standard(path) && output_file_is_standard(others[i]))
            return io_fail(error, "- would be the standard output twice; give the other output a file");
        if (same_file(path, others[i])) return io_fail(error, "'%s' would overwrite '%s'", path, others[i]);
    }
    return true;
}

/* Is a path named like no mesh and no point cache? */
static bool is_named_apart(const char *path, io_error *error) {
    char *target = realpath(path, NULL);
    const bool like_input = named_like_input(path) || (target != NULL && named_like_input(target));
    free(target);
    return !like_input ||
           io_fail(error, "'%s' is named like a mesh or a point cache; choose another name", path);
}

bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error) {
    return path == NULL ||
           (output_path_differs(path, others, other_count, error) && is_named_apart(path, error));
}

/* ---- all paths of a command ---------------------------------------------------------------------------- */

bool read_input_path(const char *text, void *place) {
    *(const char **)place = text;
    return true;
}

bool read_output_path(const char *text, void *place) {
    return read_input_path(text, place);
}

bool read_output_stem(const char *text, void *place) {
    return read_input_path(text, place);
}

bool option_is_output(const option_row *row) {
    return row->read == read_output_path || row->read == read_output_stem;
}

static const char *path_at(const void *options, const option_row *row) {
    return *(const char *const *)((const char *)options + row->place);
}

/* Another name of an option above has its place. */
static bool is_alias(const option_row *rows, size_t i) {
    for (size_t k = 0; k < i; k++)
        if (rows[k].read == rows[i].read && rows[k].place == rows[i].place) return true;
    return false;
}

/* The name by which the path was given. */
static const option_row *given_row(const option_row *rows, size_t count, size_t i,
                                   const given_options *given) {
    for (size_t k = i; k < count; k++)
        if (rows[k].read == rows[i].read && rows[k].place == rows[i].place && given->rows[k]) return &rows[k];
    return &rows[i];
}

/* The paths that an output must not have: those of inputs, and of the outputs above it. */
static size_t collect_others(const option_row *rows, size_t count, size_t i, const void *options,
                             const char *others[OPTION_ROWS_MAX]) {
    size_t used = 0;
    for (size_t k = 0; k < count; k++)
        if (rows[k].read == read_input_path ||
            (k < i && rows[k].read == read_output_path && rows[k].place != rows[i].place))
            others[used++] = path_at(options, &rows[k]);
    return used;
}

/* The value of the row is "OUT.csv|OUT.jsonl". */
static bool fits_value(const char *path, const char *value, io_error *error) {
    while (value != NULL) {
        char ending[16];
        const char *dot = strchr(value, '.'), *bar = strchr(value, '|');
        if (dot == NULL) return true;
        snprintf(ending, sizeof ending, "%.*s", (int)strcspn(dot, "|"), dot);
        if (output_path_fits(path, ending, error)) return true;
        value = bar != NULL ? bar + 1 : NULL;
    }
    return false;
}

/* The output of a row, by all paths of the command. */
typedef bool output_test(const option_row *rows, size_t count, size_t i, const void *options,
                         const given_options *given, io_error *error);

static bool is_apart(const option_row *rows, size_t count, size_t i, const void *options,
                     const given_options *given, io_error *error) {
    const char *path = path_at(options, &rows[i]), *others[OPTION_ROWS_MAX];
    const size_t other_count = collect_others(rows, count, i, options, others);
    return output_path_differs(path, given->inputs, given->input_count, error) &&
           (rows[i].read == read_output_stem || is_named_apart(path, error)) &&
           output_path_differs(path, others, other_count, error);
}

static bool fits_row(const option_row *rows, size_t count, size_t i, const void *options,
                     const given_options *given, io_error *error) {
    (void)count, (void)given;
    return fits_value(path_at(options, &rows[i]), rows[i].value, error);
}

static bool test_outputs(const option_table *table, const void *options, const given_options *given,
                         output_test *test, io_error *error) {
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(table, rows);
    for (size_t i = 0; i < count; i++) {
        io_error reason;
        if (!option_is_output(&rows[i]) || is_alias(rows, i) || path_at(options, &rows[i]) == NULL ||
            test(rows, count, i, options, given, &reason))
            continue;
        const option_row *named = given_row(rows, count, i, given);
        return io_fail(error, "%s%s %s", option_is_letter(named) ? "-" : "--", named->name, reason.text);
    }
    return true;
}

bool output_paths_are_safe(const option_table *table, const void *options, const given_options *given,
                           io_error *error) {
    return test_outputs(table, options, given, is_apart, error) &&
           test_outputs(table, options, given, fits_row, error);
}

bool output_paths_open(const option_table *table, const void *options, io_error *error) {
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(table, rows);
    for (size_t i = 0; i < count; i++)
        if (rows[i].read == read_output_path && !output_path_opens(path_at(options, &rows[i]), error))
            return false;
    return true;
}

size_t output_paths_of(const option_table *table, const void *options, const char *paths[OPTION_ROWS_MAX]) {
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(table, rows);
    size_t used = 0;
    for (size_t i = 0; i < count; i++)
        if (option_is_output(&rows[i]) && !is_alias(rows, i)) paths[used++] = path_at(options, &rows[i]);
    return used;
}
