/* Finds jobs that would write over files of each other or of the run. */
#include "tool/jobs/output_names.h"

#include "tool/io/path_name.h"

#include <stdlib.h>
#include <string.h>

typedef struct output_name {
    char *path;
    uint32_t job;
} output_name;

bool option_name_is_output(const option_table *table, const char *name) {
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(table, rows);
    for (size_t i = 0; i < count; i++)
        if (option_is_output(&rows[i]) && strcmp(rows[i].name, name) == 0) return true;
    return false;
}

output_names output_names_begin(void) {
    return (output_names){.names = growable_of(sizeof(output_name))};
}

void output_names_free(output_names *names) {
    output_name *items = names->names.data;
    for (size_t i = 0; i < names->names.count; i++) free(items[i].path);
    growable_free(&names->names);
}

/* "./a//b" is "a/b". Links and ".." stay as they are: where they lead is not looked up for each of a million names. */
static char *plain_path(const char *path) {
    char *plain = malloc(strlen(path) + 1), *end = plain;
    for (const char *c = path; plain != NULL && *c != '\0'; c++) {
        const bool begins = end == plain || end[-1] == '/';
        while (begins && (path_is_separator(c[0]) || (c[0] == '.' && path_is_separator(c[1]))) &&
               !(c == path && path_is_separator(c[0])))
            c += path_is_separator(c[0]) ? 1 : 2;
        if (*c == '\0') break;
        *end++ = path_is_separator(*c) ? '/' : *c;
    }
    if (plain != NULL) *end = '\0';
    return plain;
}

static bool add_name(output_names *names, const char *path, uint32_t job) {
    char *plain = plain_path(path);
    output_name *name = plain != NULL ? growable_push(&names->names) : NULL;
    if (name == NULL) {
        free(plain);
        return false;
    }
    *name = (output_name){plain, job};
    return true;
}

bool output_names_add_of_run(output_names *names, const char *path) {
    return path == NULL || add_name(names, path, NAME_OF_RUN);
}

bool output_names_add(output_names *names, const option_table *table, const job_line *line, uint32_t job) {
    for (size_t i = 0; i < line->option_count; i++) {
        const job_option *option = &line->options[i];
        if (option->value == NULL || !option_name_is_output(table, option->name)) continue;
        if (!add_name(names, option->value, job)) return false;
    }
    return true;
}

static int compare_names(const void *a, const void *b) {
    const output_name *x = a, *y = b;
    const int order = strcmp(x->path, y->path);
    return order != 0 ? order : x->job < y->job ? -1 : x->job > y->job;
}

/* Within a job its command looks itself. */
bool output_names_collide(output_names *names, const char **path, uint32_t *first, uint32_t *second) {
    const output_name *items = names->names.data;
    const size_t count = names->names.count;
    if (count > 1) qsort(names->names.data, count, sizeof *items, compare_names);
    for (size_t i = 1; i < count; i++) {
        if (items[i].job == items[i - 1].job || strcmp(items[i].path, items[i - 1].path) != 0) continue;
        *path = items[i].path;
        *first = items[i - 1].job;
        *second = items[i].job;
        return true;
    }
    return false;
}
