/* Options about lists, shards, results and time limits. */
#include "tool/jobs/list_options.h"

#include "tool/common/options.h"
#include "tool/common/provenance.h"
#include "tool/io/output_file.h"

#include <string.h>

static bool read_resume(const char *text, void *place) {
    if (text != NULL && strcmp(text, "failed") != 0) return false;
    *(resume_choice *)place = text == NULL ? RESUME_ALL : RESUME_FAILED;
    return true;
}

static const option_row rows[] = {
    {"list", "JOBS.jsonl", read_text, offsetof(list_options, path),
     "many recordings, a job a line: {\"model\": ..., \"frames\": ..., \"options\": ..., \"outputs\": ...}; each has its "
     "answer in a line, and one that fails stops no other"},
    {"shard", "I/N", read_shard, offsetof(list_options, shard),
     "only the I-th of N shards, I from 1, of the list's jobs, or of the intervals of one recording (replay): each machine takes "
     "another, and cscd merge brings them together"},
    {"results", "OUT", read_text, offsetof(list_options, results_path),
     "append a line of JSON for each job as soon as it is done, or a record of each interval; each shard has a file of its own"},
    {"resume", "[=failed]", read_resume, offsetof(list_options, resume),
     "go on where the file of results ends, whatever stopped the run; =failed: run jobs again that have failed"},
    {"job-timeout", "S", read_seconds, offsetof(list_options, seconds),
     "a job that takes longer than S seconds has failed (default: any time)"},
};

const option_list list_rows = {"Many jobs:", rows, sizeof rows / sizeof *rows};

static const char *const names[] = {"list", "shard", "results", "resume", "job-timeout"};
enum { NAMES = sizeof names / sizeof *names };

/* The hash of a list and of the options that were given beside it, those left out that change no result. */
static uint64_t hash_work(const job_list *list, const option_table *table, const given_options *given) {
    static const char *const harmless[] = {"list", "shard",   "results", "resume", "job-timeout",
                                           "each", "threads", "quiet",   "json"};
    const uint64_t options = option_hash_beside(table, given, harmless, sizeof harmless / sizeof *harmless);
    const uint64_t hash = provenance_hash(list->hash, table->command, strlen(table->command) + 1);
    return provenance_hash_numbers(hash, &options, 1, sizeof options);
}

jobs_request list_options_request(const list_options *o, const job_list *list, const option_table *table,
                                  const given_options *given) {
    return (jobs_request){.list = list,
                          .hash = hash_work(list, table, given),
                          .shard = o->shard,
                          .results_path = o->results_path,
                          .resume = o->resume,
                          .seconds = o->seconds};
}

const char *list_option_without_list(const option_table *table, const given_options *given) {
    for (int i = 1; i < NAMES; i++)
        if (option_given(table, given, names[i])) return names[i];
    return NULL;
}

bool list_options_are_safe(const list_options *o, const char *const *inputs, size_t input_count,
                           io_error *error) {
    const char *others[] = {o->path};
    if (output_file_is_standard(o->results_path))
        return io_fail(error, "-: results are kept in a file, which --resume goes on with; name one");
    return output_path_is_safe(o->results_path, inputs, input_count, error) &&
           output_path_is_safe(o->results_path, others, 1, error) &&
           output_path_fits(o->results_path, ".jsonl", error);
}
