/* What a page says of a job, from its line of results: of recordings and of meshes. */
#pragma once

#include "tool/jobs/job_record.h"

/* Numbers that a line does not have are NaN, texts are "". */
typedef struct job_row {
    const char *name;
    const char *answer; /* the sentence of a job, or why it has failed */
    const char *report; /* the path of its page, from the folder where the job ran */
    double frames, crossing_frames, events, depth, crossing_pairs;
    double seconds;
    void *memory; /* of the texts */
} job_row;

/* False: memory is short, or this is no JSON, and *out holds nothing to free. */
bool job_row_read(const char *line, size_t length, job_row *out);

void job_row_free(job_row *row);
