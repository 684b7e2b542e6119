/* `cscd merge`: brings the results of shards together, of a list or of one recording. */
#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/terminal.h"
#include "tool/io/output_file.h"
#include "tool/jobs/jobs.h"
#include "tool/replay/replay.h"

#include <errno.h>
#include <sys/stat.h>

typedef struct merge_options {
    const char *output_path, *junit_path;                                      /* NULL: not given */
    const char *contacts_path, *json_path, *events_path, *report_path, *title; /* of a recording */
    bool quiet, reproducible;
} merge_options;

static const option_row rows[] = {
    {"o", "OUT.jsonl", read_output_path, offsetof(merge_options, output_path),
     "the lines of all jobs in the order of the list; - is the standard output. Without it they are only proven to be "
     "there"},
    {"output", "OUT.jsonl", read_output_path, offsetof(merge_options, output_path), NULL},
    {"junit", "OUT.xml", read_output_path, offsetof(merge_options, junit_path),
     "write a JUnit file for continuous integration, with a test case for each job; one fails by the rules of its run"},
    {"contacts", "OUT.csv|OUT.jsonl", read_output_path, offsetof(merge_options, contacts_path),
     "of a recording: what cscd replay writes by the same option"},
    {"json", "OUT.json", read_output_path, offsetof(merge_options, json_path), "the same"},
    {"events", "OUT.csv", read_output_path, offsetof(merge_options, events_path), "the same"},
    {"report", "OUT.html", read_output_path, offsetof(merge_options, report_path), "the same"},
    {"title", "TEXT", read_text, offsetof(merge_options, title), "of the report"},
    {"reproducible", NULL, read_flag, offsetof(merge_options, reproducible),
     "of a recording: leave times, dates, the machine and the command line out of --json and --report"},
    {"quiet", NULL, read_flag, offsetof(merge_options, quiet), "nothing but errors"},
};

static const option_table table = {
    "merge",
    "SHARD... [options]",
    "Brings together what shards wrote by --results: of a list (check or replay --list --shard) or of one recording (replay "
    "--shard). It proves that each job or interval is there exactly once; what is missing, there twice or of something else is "
    "named, and nothing is written then. The exit code is that of one run of the whole.",
    rows,
    sizeof rows / sizeof *rows,
    .examples = {
        {"merge shard-*.jsonl -o night.jsonl", "Put the results of all shards of a night in one file."},
        {"merge shard-*.jsonl", "Find out whether all shards are done, and what is missing."},
        {"merge shard-*.jsonl -o - --quiet", "Hand all results to another program."}}};

/* The files that are written, as the lines come. */
typedef struct merge_files {
    const merge_options *options;
    output_file lines, junit; /* their files are NULL when not asked for */
} merge_files;

static bool open_file(const char *path, output_file *file, io_error *error) {
    return path == NULL || output_file_open(path, file) || io_fail_write(error, path);
}

static bool close_file(const char *path, output_file *file, bool whole, io_error *error) {
    if (file->file == NULL) return true;
    return output_file_close(file, whole ? OUTPUT_WHOLE : OUTPUT_ABANDONED) || !whole ||
           io_fail_write(error, path);
}

/* Looks after each line: what follows changes errno. */
static bool still_writes(const char *path, output_file *file, io_error *error) {
    return file->file == NULL || output_file_writes(file) || io_fail_write(error, path);
}

static bool take_line(void *user, const char *line, size_t length, const job_record *record,
                      io_error *error) {
    merge_files *files = user;
    if (files->lines.file != NULL) {
        fwrite(line, 1, length, files->lines.file);
        fputc('\n', files->lines.file);
    }
    if (!still_writes(files->options->output_path, &files->lines, error)) return false;
    if (files->junit.file != NULL && !job_junit_add(files->junit.file, line, length, record))
        return io_fail(error, "out of memory");
    return still_writes(files->options->junit_path, &files->junit, error);
}

/* stopped: an interrupt came before the files took their places, so they do not. */
static bool write_files(const job_merge *merge, const merge_options *o, bool *stopped, io_error *error) {
    merge_files files = {.options = o};
    *stopped = interrupted();
    if (o->output_path == NULL && o->junit_path == NULL) return true;
    bool good =
        open_file(o->output_path, &files.lines, error) && open_file(o->junit_path, &files.junit, error);
    errno = 0;
    if (good && files.junit.file != NULL) job_junit_begin(files.junit.file, merge->paths[0], &merge->sums);
    good = good && job_merge_visit(merge, take_line, &files, error);
    if (good && files.junit.file != NULL) job_junit_end(files.junit.file);
    *stopped = interrupted();
    const bool whole = good && !*stopped;
    good = close_file(o->output_path, &files.lines, whole, good ? error : NULL) && good;
    return close_file(o->junit_path, &files.junit, whole, good ? error : NULL) && good;
}

static int end_merge(const job_merge *merge, const merge_options *o, bool stopped) {
    const uint32_t failed = merge->sums.outcomes[JOB_FAILED];
    if (stopped) {
        note("interrupted; %s was written",
             output_file_is_standard(o->output_path) ? "not every line" : "nothing");
        return interrupt_exit_code();
    }
    if (!o->quiet) job_sums_print(stdout, &merge->sums, "job", "jobs");
    if (failed > 0) return fail_input("%u of %u jobs have failed", failed, merge->jobs);
    return merge->sums.found > 0 ? EXIT_CONTACT : EXIT_RAN;
}

static int merge_recording(const merge_options *o, const given_options *given, int argument_count,
                           char **arguments) {
    const merged_output outputs[] = {{"contacts", o->contacts_path}, {"json", o->json_path},
                                     {"events", o->events_path},     {"junit", o->junit_path},
                                     {"report", o->report_path},     {"title", o->title}};
    if (o->output_path != NULL)
        return fail_usage("merge", "-o is for the results of a list; a recording has --contacts, --json, "
                                   "--events, --junit and --report");
    const merge_request request = {.paths = given->inputs,
                                   .path_count = given->input_count,
                                   .outputs = outputs,
                                   .output_count = sizeof outputs / sizeof *outputs,
                                   .quiet = o->quiet,
                                   .reproducible = o->reproducible,
                                   .argument_count = argument_count,
                                   .arguments = arguments};
    return replay_merge(&request);
}

static int merge_list(const merge_options *o, const given_options *given) {
    static const char *const of_lists[] = {"o", "output", "junit", "quiet"};
    io_error error = {""};
    job_merge merge;
    bool stopped;
    const char *other = option_given_beside(&table, given, of_lists, sizeof of_lists / sizeof *of_lists);
    if (other != NULL)
        return fail_usage("merge", "--%s is for the shards of one recording, and %s has results of a list",
                          other, given->inputs[0]);
    interrupt_catch();
    if (!job_merge_read(given->inputs, given->input_count, MERGE_WHOLE, &merge, &error))
        return fail_input("%s", error.text);
    const int code = write_files(&merge, o, &stopped, &error) ? end_merge(&merge, o, stopped)
                                                              : fail_input("%s", error.text);
    job_merge_free(&merge);
    return code;
}

/* A pipe has the results of a list; what is read of it now would be missing later. */
static bool is_shard_of_recording(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode) && shard_file_recognise(path);
}

int command_merge(int argument_count, char **arguments) {
    merge_options o = {.output_path = NULL};
    given_options given;
    io_error error = {""};
    int code;
    if (!option_table_read(&table, argument_count, arguments, &o, &given, &code)) return code;
    if (given.input_count == 0)
        return fail_usage("merge", "no results given: what --results of check or replay wrote");
    if (!output_paths_are_safe(&table, &o, &given, &error)) return fail_usage("merge", "%s", error.text);
    if (is_shard_of_recording(given.inputs[0])) return merge_recording(&o, &given, argument_count, arguments);
    return merge_list(&o, &given);
}
