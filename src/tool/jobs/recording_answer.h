/* What is said of a recording among many: the sentence of its answers, and members of its line of results. */
#pragma once

#include "src/tool/answers/fail_rules.h"
#include "src/tool/jobs/job_work.h"

/* The answers are finished. */
void recording_answer_write(const char *name, const answers *a, const length_unit *unit,
                            const fail_rules *rules, job_output *out);

/* The same of one that failed: all members but these two are null. */
void recording_answer_fail(const char *name, const char *reason, job_output *out);
