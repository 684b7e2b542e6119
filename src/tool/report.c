/* `cscd report`: puts summaries of replays side by side on one page. */
#include "src/tool/report/report.h"

#include "src/tool/common/command.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/provenance.h"
#include "src/tool/summary_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct report_command {
    const char *output_path, *title;
    const char *const *paths;
    size_t count;
    bool quiet;
} report_command;

static const option_row rows[] = {
    {"o", "OUT.html", read_text, offsetof(report_command, output_path), "the page"},
    {"output", "OUT.html", read_text, offsetof(report_command, output_path), NULL},
    {"title", "TEXT", read_text, offsetof(report_command, title), "of the page (default: Comparison)"},
    {"quiet", NULL, read_flag, offsetof(report_command, quiet), "nothing on the standard output"},
};

static const option_table table = {
    "report",
    "A.json [B.json ...] -o OUT.html",
    "Compares runs of cscd replay, by the summaries that --json wrote, on one page for any browser: which events "
    "are new, still there or fixed since the first run, and how contacts, pairs and times differ. To see the "
    "motion itself, give cscd replay --report.",
    rows,
    sizeof rows / sizeof *rows,
    .examples = {{"report before.json after.json -o compare.html",
                  "Compare two versions of an animation: which events are fixed, new, or still there."},
                 {"report charge.json none.json iccd.json -o methods.html",
                  "Compare the methods that replay has, on one recording."},
                 {"report runs/*.json -o runs.html --quiet",
                  "Put all runs of a folder on one page, and print nothing."}}};

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

static int check_command(const report_command *c) {
    io_error error;
    if (c->count == 0) return fail_usage("report", "no summary given: what cscd replay --json wrote");
    if (c->output_path == NULL) return fail_usage("report", "no -o OUT.html given");
    if (!output_path_is_safe(c->output_path, c->paths, c->count, &error) ||
        !output_path_fits(c->output_path, ".html", &error))
        return fail_usage("report", "-o %s", error.text);
    return EXIT_RAN;
}

int command_report(int argument_count, char **arguments) {
    report_command c = {0};
    given_options given;
    io_error error = {""};
    int code;
    if (!option_table_read(&table, argument_count, arguments, &c, &given, &code)) return code;
    c.paths = given.inputs;
    c.count = given.input_count;
    code = check_command(&c);
    if (code != EXIT_RAN) return code;
    if (!write_page(&c, &error)) return fail_input("%s", error.text);
    if (!c.quiet) printf("written: %s\n", c.output_path);
    return EXIT_RAN;
}
