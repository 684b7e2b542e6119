/* `cscd report`: summaries of replays side by side, as one page. */
#include "src/tool/report/report.h"

#include "src/tool/common/command.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/provenance.h"
#include "src/tool/summary_file.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: cscd report A.json [B.json ...] -o OUT.html\n"
    "\n"
    "Puts the summaries that cscd replay --json wrote side by side on one page for any browser: the thesis'\n"
    "table, times, contacts and pairs of every interval, and whether the contacts agree. To see the motion\n"
    "itself, give cscd replay --report.\n"
    "\n"
    "  -o OUT.html            the page\n"
    "  --quiet                nothing on the standard output\n";

typedef struct report_command {
    const char *output_path;
    const char *const *paths;
    size_t count;
    bool quiet, help_wanted;
} report_command;

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
    report_options options = {.kind = REPORT_COMPARE, .title = "Comparison", .generator = generator};
    report *page = NULL;
    bool written = report_create(&options, &page, error) &&
                   report_write(page, c->output_path, summaries, c->count, NULL, error);
    report_destroy(page);
    free_summaries(summaries, c->count);
    return written;
}

static int read_options(int argument_count, char **arguments, report_command *c) {
    static const struct option long_options[] = {{"output", required_argument, NULL, 'o'},
                                                 {"quiet", no_argument, NULL, 'q'},
                                                 {"help", no_argument, NULL, 'h'},
                                                 {NULL, 0, NULL, 0}};
    opterr = 0;
    optind = 1;
    for (int id; (id = getopt_long(argument_count, arguments, ":o:", long_options, NULL)) != -1;) {
        if (id == ':' || id == '?') return fail_option("report", id, arguments);
        if (id == 'h') c->help_wanted = true;
        if (id == 'q') c->quiet = true;
        if (id == 'o') c->output_path = optarg;
    }
    if (c->help_wanted) return EXIT_RAN;
    c->paths = (const char *const *)(arguments + optind);
    c->count = (size_t)(argument_count - optind);
    if (c->count == 0) return fail_usage("report", "no summary given: what cscd replay --json wrote");
    if (c->output_path == NULL) return fail_usage("report", "no -o OUT.html given");
    io_error error;
    if (!output_path_is_safe(c->output_path, c->paths, c->count, &error))
        return fail_usage("report", "-o %s", error.text);
    return EXIT_RAN;
}

int command_report(int argument_count, char **arguments) {
    report_command c = {0};
    io_error error = {""};
    int code = read_options(argument_count, arguments, &c);
    if (c.help_wanted) fputs(help, stdout);
    if (code != EXIT_RAN || c.help_wanted) return code;
    if (!write_page(&c, &error)) return fail_input("%s", error.text);
    if (!c.quiet) printf("written: %s\n", c.output_path);
    return EXIT_RAN;
}
