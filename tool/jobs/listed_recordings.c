/* Jobs that are commands of the tool: their options are those of the command line and their own. */
#include "tool/jobs/jobs.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/terminal.h"
#include "tool/io/io.h"
#include "tool/jobs/job_list.h"

#include <stdlib.h>
#include <string.h>

/* ---- finds jobs that would write over files of each other or of the run -------------------------------- */

typedef struct output_names {
    growable names; /* of output_name */
} output_names;

#define NAME_OF_RUN UINT32_MAX /* as a job: a file of the whole run */

typedef struct output_name {
    char *path;
    uint32_t job;
} output_name;

/* Does the option of that name say which file the command writes? */
static bool option_name_is_output(const option_table *table, const char *name) {
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(table, rows);
    for (size_t i = 0; i < count; i++)
        if (option_is_output(&rows[i]) && strcmp(rows[i].name, name) == 0) return true;
    return false;
}

static output_names output_names_begin(void) {
    return (output_names){.names = growable_of(sizeof(output_name))};
}

static void output_names_free(output_names *names) {
    output_name *items = names->names.data;
    for (size_t i = 0; i < names->names.count; i++) free(items[i].path);
    growable_free(&names->names);
}

/* "./a//b" is "a/b". Links and ".." stay as they are: where they lead is not looked up for each of a million
 * names. */
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

/* Adds a file of the whole run; NULL: none. False if memory is short. */
static bool output_names_add_of_run(output_names *names, const char *path) {
    return path == NULL || add_name(names, path, NAME_OF_RUN);
}

/* Adds what a job writes. False if memory is short. */
static bool output_names_add(output_names *names, const option_table *table, const job_line *line,
                             uint32_t job) {
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
/* Finds a file that two jobs write, or a job (`first`) and the run (`second` is NAME_OF_RUN); false: there is
 * none. */
static bool output_names_collide(output_names *names, const char **path, uint32_t *first, uint32_t *second) {
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

/* ---- what may stand where ------------------------------------------------------------------------------ */

static bool name_among(const char *name, const char *const *names) {
    while (*names != NULL && strcmp(*names, name) != 0) names++;
    return *names != NULL;
}

/* Options of the whole run. */
static const char *const of_run[] = {"list", "shard",   "results", "resume", "job-timeout",
                                     "each", "threads", "quiet",   NULL};

static bool option_fits_job(const list_command *c, const job_option *option, io_error *error) {
    if (name_among(option->name, of_run))
        return io_fail(error, "--%s is for the whole list; give it on the command line", option->name);
    if (option->value != NULL && strcmp(option->value, "-") == 0 &&
        option_name_is_output(c->table, option->name))
        return io_fail(error, "--%s: a job among many has no standard output; name a file", option->name);
    return true;
}

static bool take_options(const list_command *c, const job_line *line, void *options, given_options *given,
                         io_error *error) {
    for (size_t i = 0; i < line->option_count; i++) {
        const job_option *option = &line->options[i];
        if (!option_fits_job(c, option, error) ||
            !option_table_set(c->table, option->name, option->value, options, given, error))
            return false;
    }
    given->inputs = line->inputs;
    given->input_count = line->input_count;
    return true;
}

/* ---- a job --------------------------------------------------------------------------------------------- */

/* The page of the job, for the page of all jobs. */
static void write_report(const job_line *line, json *out) {
    const char *path = NULL;
    for (size_t i = 0; i < line->option_count; i++)
        if (strcmp(line->options[i].name, "report") == 0) path = line->options[i].value;
    if (path != NULL)
        json_string(out, "report", path);
    else
        json_null(out, "report");
}

static bool run_command(const void *user, const job_line *line, cscd_context *context, job_output *out,
                        io_error *error) {
    const list_command *c = user;
    given_options given = *c->given;
    void *options = malloc(c->options_size);
    if (options == NULL) return io_fail(error, "out of memory");
    memcpy(options, c->options, c->options_size);
    int code = EXIT_BAD_INPUT;
    if (take_options(c, line, options, &given, error)) {
        failures_keep(error);
        code = c->run(options, &given, line->name, context, out);
        failures_keep(NULL);
    }
    free(options);
    out->given_up = interrupted();
    if (out->given_up || (code != EXIT_RAN && code != EXIT_CONTACT)) return false;
    write_report(line, out->members);
    return true;
}

static void fail_command(const void *user, const char *name, const char *reason, job_output *out) {
    (void)user;
    recording_answer_fail(name, reason, out);
}

/* ---- the list ------------------------------------------------------------------------------------------ */

/* The files of all jobs together, and the options that one is tried on. */
typedef struct list_check {
    output_names names;
    void *options;
} list_check;

static bool check_line(const list_command *c, const job_list *list, uint32_t job, list_check *check,
                       io_error *error) {
    given_options given = *c->given;
    job_line line;
    io_error reason;
    memcpy(check->options, c->options, c->options_size);
    if (!job_list_line(list, job, &line, &reason)) return job_list_fail(list, job, reason.text, error);
    bool good = take_options(c, &line, check->options, &given, &reason);
    if (good && !output_names_add(&check->names, c->table, &line, job))
        good = io_fail(&reason, "out of memory");
    job_line_free(&line);
    return good || job_list_fail(list, job, reason.text, error);
}

static bool check_outputs(list_check *check, const list_command *c, const job_list *list, io_error *error) {
    const char *path;
    uint32_t first, second;
    char reason[sizeof error->text];
    if (!output_names_add_of_run(&check->names, c->list->path) ||
        !output_names_add_of_run(&check->names, c->list->results_path))
        return io_fail(error, "out of memory");
    if (!output_names_collide(&check->names, &path, &first, &second)) return true;
    if (second == NAME_OF_RUN) {
        snprintf(reason, sizeof reason,
                 "'%.800s' is the list itself or its file of results; name another file", path);
        return job_list_fail(list, first, reason, error);
    }
    snprintf(reason, sizeof reason,
             "'%.800s' is written by line %zu as well; give each job a file of its own", path,
             list->jobs[first].line);
    return job_list_fail(list, second, reason, error);
}

/* A fault in the list is found before any job runs. */
static bool check_lines(const list_command *c, const job_list *list, io_error *error) {
    list_check check = {.names = output_names_begin(), .options = malloc(c->options_size)};
    bool good = check.options != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; i < list->count && good; i++) good = check_line(c, list, i, &check, error);
    good = good && check_outputs(&check, c, list, error);
    output_names_free(&check.names);
    free(check.options);
    return good;
}

static int refuse_options(const list_command *c) {
    io_error error;
    option_row rows[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(c->table, rows);
    for (size_t i = 0; i < count; i++)
        if (c->given->rows[i] && option_is_output(&rows[i]))
            return fail_usage(
                c->table->command,
                "--%s names one file, and each job of a list needs its own: write {\"outputs\": {\"%s\": ...}} "
                "in the list",
                rows[i].name, rows[i].name);
    if (c->given->input_count > 0)
        return fail_usage(c->table->command, "--list: '%s' is no input; the list has the models",
                          c->given->inputs[0]);
    if (!list_options_are_safe(c->list, NULL, 0, &error))
        return fail_usage(c->table->command, "--results %s", error.text);
    if (c->list->resume != RESUME_NOTHING && c->list->results_path == NULL)
        return fail_usage(c->table->command, "--resume needs --results, the file that it goes on with");
    return EXIT_RAN;
}

int run_listed_recordings(const list_command *c) {
    job_list list;
    io_error error;
    int code = refuse_options(c);
    if (code != EXIT_RAN) return code;
    if (!job_list_read(c->list->path, &list, &error)) return fail_jobs("%s", error.text);
    jobs_request request = list_options_request(c->list, &list, c->table, c->given);
    request.thread_count = c->thread_count;
    request.quiet = c->quiet;
    const job_kind kind = {
        .one = "recording", .several = "recordings", .user = c, .run = run_command, .fail = fail_command};
    code = check_lines(c, &list, &error) ? run_jobs(&request, &kind) : fail_jobs("%s", error.text);
    job_list_free(&list);
    return code;
}
