/* What is said of a recording among many: the sentence of its answers, and members of its line of results. */
#pragma once

#include "tool/answers/fail_rules.h"
#include "tool/jobs/job_work.h"

/* What finished answers come to, and whether any frame fails by the rules. JOB_FAILED where nobody can rely on them: not all was
 * looked at, or in some frame no triangle has an area and nothing else was found. */
job_outcome recording_answer_outcome(const answers *a, const fail_rules *rules);
bool recording_answer_found(const answers *a, const fail_rules *rules);

/* The answers are finished. */
void recording_answer_write(const char *name, const answers *a, const length_unit *unit,
                            const fail_rules *rules, job_output *out);

/* The same of one that failed: all members but these two are null. */
void recording_answer_fail(const char *name, const char *reason, job_output *out);
