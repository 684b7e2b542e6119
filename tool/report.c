/* `cscd report`: puts summaries of replays side by side on one page, or the results of many jobs. */
#include "tool/report/report.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/provenance.h"
#include "tool/replay/replay.h"
#include "tool/tool.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct report_command {
    const char *output_path, *title, *junit_path; /* NULL: not given */
    const char *const *paths;
    size_t count;
    bool quiet;
} report_command;

static const option_row rows[] = {
    {"o", "OUT.html", read_output_path, offsetof(report_command, output_path), "the page"},
    {"output", "OUT.html", read_output_path, offsetof(report_command, output_path), NULL},
    {"title", "TEXT", read_text, offsetof(report_command, title),
     "of the page (default: Comparison, or Jobs)"},
    {"junit", "OUT.xml", read_output_path, offsetof(report_command, junit_path),
     "of results: write a JUnit file for continuous integration, with a test case for each job; one that is not done is an error"},
    {"quiet", NULL, read_flag, offsetof(report_command, quiet), "nothing on the standard output"},
};

static const option_table table = {
    "report",
    "A.json [B.json ...] -o OUT.html | SHARD.jsonl... -o OUT.html",
    "Compares runs of cscd replay, by the summaries that --json wrote, on one page for any browser: which events "
    "are new, still there or fixed since the first run, and how contacts, pairs and times differ. To see the "
    "motion itself, give cscd replay --report. Of the results of jobs, which --results of check or replay wrote, it makes a table "
    "of all jobs, the worst first; jobs that are not done are named, and the exit code is 1 then, else that of cscd merge.",
    rows,
    sizeof rows / sizeof *rows,
    .examples = {
        {"report before.json after.json -o compare.html",
         "Compare two versions of an animation: which events are fixed, new, or still there."},
        {"report charge.json none.json iccd.json -o methods.html",
         "Compare the methods that replay has, on one recording."},
        {"report shard-*.jsonl -o night.html", "Put all jobs of a night on one page, the worst first."}}};

static void free_summaries(report_summary *summaries, size_t count) {
    for (size_t i = 0; summaries != NULL && i < count; i++) free((char *)summaries[i].text);
    free(summaries);
}

static report_summary *read_summaries(const report_command *c, io_error *error) {
    report_summary *summaries = calloc(c->count, sizeof *summaries);
    if (summaries == NULL) {
        io_fail(error, "out of memory");
        return NULL;
    }
    for (size_t i = 0; i < c->count; i++) {
        summaries[i] = (report_summary){c->paths[i], summary_file_read(c->paths[i], error)};
        if (summaries[i].text != NULL) continue;
        free_summaries(summaries, c->count);
        return NULL;
    }
    return summaries;
}

static bool write_page(const report_command *c, io_error *error) {
    if (!output_path_opens(c->output_path, error)) return false;
    report_summary *summaries = read_summaries(c, error);
    if (summaries == NULL) return false;
    char generator[PROVENANCE_GENERATOR_SIZE];
    provenance_generator(generator);
    report_options options = {
        .kind = REPORT_COMPARE, .title = c->title != NULL ? c->title : "Comparison", .generator = generator};
    report *page = NULL;
    bool written = report_create(&options, &page, error) &&
                   report_write(page, c->output_path, summaries, c->count, NULL, error);
    report_destroy(page);
    free_summaries(summaries, c->count);
    return written;
}

/* A pipe is not read: what is taken from it is gone. */
static bool is_shard(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode) && shard_file_recognise(path);
}

/* of_jobs: results are given, and no summaries. */
static int check_kind(const report_command *c, bool *of_jobs) {
    const char *kinds[2] = {NULL, NULL}; /* the first summary, the first results */
    for (size_t i = 0; i < c->count; i++) {
        if (is_shard(c->paths[i]))
            return fail_usage(
                "report",
                "'%s' is a shard of one recording, whose page cscd merge --report makes of all shards",
                c->paths[i]);
        const char **first = &kinds[jobs_report_takes(c->paths[i])];
        if (*first == NULL) *first = c->paths[i];
    }
    if (kinds[0] != NULL && kinds[1] != NULL)
        return fail_usage("report", "'%s' has results of jobs and '%s' has not; a page is made of either",
                          kinds[1], kinds[0]);
    *of_jobs = kinds[1] != NULL;
    if (!*of_jobs && c->junit_path != NULL)
        return fail_usage("report", "--junit needs results of jobs, and '%s' has none", kinds[0]);
    return EXIT_RAN;
}

static int check_command(const report_command *c, const given_options *given) {
    io_error error;
    if (c->count == 0)
        return fail_usage(
            "report",
            "no summary given, and no results: what --json of replay wrote, or --results of check or replay");
    if (c->output_path == NULL) return fail_usage("report", "no -o OUT.html given");
    if (!output_paths_are_safe(&table, c, given, &error)) return fail_usage("report", "%s", error.text);
    return EXIT_RAN;
}

static int report_summaries(const report_command *c) {
    io_error error = {""};
    if (!write_page(c, &error)) return fail_input("%s", error.text);
    if (!c->quiet) printf("written: %s\n", c->output_path);
    return EXIT_RAN;
}

static int report_jobs(const report_command *c) {
    const jobs_report_request request = {.paths = c->paths,
                                         .count = c->count,
                                         .output_path = c->output_path,
                                         .title = c->title,
                                         .junit_path = c->junit_path,
                                         .quiet = c->quiet};
    return jobs_report_write(&request);
}

int command_report(int argument_count, char **arguments) {
    report_command c = {0};
    given_options given;
    bool of_jobs = false;
    int code;
    if (!option_table_read(&table, argument_count, arguments, &c, &given, &code)) return code;
    c.paths = given.inputs;
    c.count = given.input_count;
    code = check_command(&c, &given);
    if (code == EXIT_RAN) code = check_kind(&c, &of_jobs);
    if (code != EXIT_RAN) return code;
    return of_jobs ? report_jobs(&c) : report_summaries(&c);
}
