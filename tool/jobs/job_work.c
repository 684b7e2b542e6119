/* Runs a job and packs its answer, or why there is none, into bytes. */
#include "tool/jobs/job_work.h"

#include <stdlib.h>
#include <string.h>

/* Packed results begin with this; the text comes behind it, and then the line. */
typedef struct sent_result {
    job_record record;
    uint64_t text_size; /* with its 0 */
} sent_result;

/* A text that is written to as a file. */
typedef struct memory_text {
    FILE *file;
    char *text;
    size_t size;
} memory_text;

static bool open_text(memory_text *t) {
    *t = (memory_text){.file = NULL};
    t->file = open_memstream(&t->text, &t->size);
    return t->file != NULL;
}

static bool close_text(memory_text *t) {
    const bool good = t->file != NULL && fclose(t->file) == 0 && t->text != NULL;
    t->file = NULL;
    return good;
}

typedef struct job_texts {
    memory_text text, members;
    json out;
    job_output output;
} job_texts;

static bool open_texts(job_texts *t) {
    *t = (job_texts){.out = {.depth = 1, .has_items = {true, true}}};
    const bool good = open_text(&t->text) && open_text(&t->members);
    t->out.file = t->members.file;
    t->output = (job_output){.text = t->text.file, .members = &t->out};
    return good;
}

static void free_texts(job_texts *t) {
    close_text(&t->text);
    close_text(&t->members);
    free(t->text.text);
    free(t->members.text);
}

/* Writes what is sent of a job. False: memory is short. */
static bool write_result(const job_work *work, uint32_t job, job_texts *t, FILE *out) {
    if (!close_text(&t->text) || !close_text(&t->members)) return false;
    if (t->text.size > 0 && t->text.text[t->text.size - 1] == '\n') t->text.text[--t->text.size] = '\0';
    const sent_result sent = {.record = {.list = work->hash,
                                         .jobs = work->list->count,
                                         .job = job,
                                         .outcome = t->output.outcome,
                                         .found = t->output.found},
                              .text_size = t->text.size + 1};
    json line = {.file = out};
    fwrite(&sent, sizeof sent, 1, out);
    fwrite(t->text.text, 1, sent.text_size, out);
    job_record_write(&line, &sent.record);
    fwrite(t->members.text, 1, t->members.size, out);
    json_end_object(&line);
    fputc('\n', out);
    return ferror(out) == 0;
}

void job_work_fail(const job_work *work, uint32_t job, const char *reason, FILE *out) {
    job_line line;
    job_texts texts;
    io_error error;
    const bool named = job_list_line(work->list, job, &line, &error);
    if (open_texts(&texts)) {
        texts.output.outcome = JOB_FAILED;
        work->kind->fail(work->kind->user, named ? line.name : "", reason, &texts.output);
        write_result(work, job, &texts, out);
    }
    free_texts(&texts);
    if (named) job_line_free(&line);
}

bool job_work_run(const job_work *work, uint32_t job, FILE *out) {
    job_line line;
    job_texts texts;
    io_error error = {"out of memory"};
    if (!job_list_line(work->list, job, &line, &error)) {
        job_work_fail(work, job, error.text, out);
        return true;
    }
    const bool ran =
        open_texts(&texts) && work->kind->run(work->kind->user, &line, work->context, &texts.output, &error);
    const bool given_up = texts.output.given_up;
    if (ran) write_result(work, job, &texts, out);
    free_texts(&texts);
    job_line_free(&line);
    if (!ran && !given_up) job_work_fail(work, job, error.text, out);
    return !given_up;
}

job_result job_work_unpack(const char *bytes, size_t size) {
    sent_result sent;
    memcpy(&sent, bytes, sizeof sent);
    const char *text = bytes + sizeof sent, *line = text + sent.text_size;
    return (job_result){
        .record = sent.record, .text = text, .line = line, .line_size = size - (size_t)(line - bytes)};
}
