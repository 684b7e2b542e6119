/* The jobs on Windows, which has no fork: one after another in the calling process, with the threads of
 * all. */
#include "tool/jobs/job_list.h"

#include "tool/common/terminal.h"

#include <stdlib.h>
#include <string.h>

/* False: no further job is to begin. */
static bool run_one_job(const job_set *set, uint32_t job, uint32_t *done) {
    char *text = NULL;
    size_t size = 0;
    FILE *result = open_memstream(&text, &size);
    const bool ran = result != NULL && set->run(set->user, job, result);
    const bool whole = result != NULL && !ferror(result) && fclose(result) == 0;
    bool goes_on = false;
    if (!whole)
        goes_on = set->fail(set->user, job, "out of memory for its result");
    else if (ran)
        goes_on = set->take(set->user, job, text, size);
    *done += !whole || ran;
    free(text);
    return goes_on;
}

bool jobs_run(const job_set *set, uint32_t *done, io_error *error) {
    *done = 0;
    if (set->seconds > 0.0)
        return io_fail(error,
                       "a time limit for a job needs processes, which are not used on Windows; leave it out");
    if (!set->begin(set->user, error)) return false;
    for (uint32_t i = 0; i < set->count && !interrupted(); i++)
        if (!run_one_job(set, i, done)) break;
    return true;
}
