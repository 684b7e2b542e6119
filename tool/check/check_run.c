/* A run of `cscd check`: frame by frame, what intersects. */
#include "tool/check/check_run.h"

#include "tool/answers/answers.h"
#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/terminal.h"
#include "tool/jobs/jobs.h"

#include <stdlib.h>

/* A run of the command. */
typedef struct check_run {
    const check_options *options;
    const char *name; /* of a job among many, */
    job_output *job;  /* and its output; NULL: it is none */
    recording recording;
    ignore_pairs ignored;
    length_unit unit;
    fail_rules rules;
    answers answers;
    cscd_detector *detector;
    double *positions;
    check_output output;
    answer_outputs files;
    exports exports;
    terminal_progress progress;
    frame_choice frames;
    bool printed; /* the sentence has been printed */
} check_run;

static size_t frames_done(const check_run *c) {
    return answers_frame_count(&c->answers);
}

static bool check_frame(check_run *c, uint32_t frame, io_error *error) {
    cscd_intersections found;
    io_error reason;
    if (!recording_read(&c->recording, frame, c->positions, error)) return false;
    c->progress.may_stop = true; /* nothing of the frame is written yet */
    bool looked = answers_find(&c->answers, c->detector, c->positions, &found, &reason);
    c->progress.may_stop = false;
    if (!looked ||
        !answers_add_found(&c->answers, frame, &found, cscd_detector_timings(c->detector).check_ms, &reason))
        return io_fail(error, "frame %d: %s", c->recording.frame_numbers[frame], reason.text);
    answers_add_turned(&c->answers, frame, found.patches != NULL ? found.patches->turned : NULL);
    return check_output_add(&c->output, &c->answers, &found, error) &&
           exports_add_frame(&c->exports, frame, c->positions, &found, error);
}

static bool open_answers(check_run *c, io_error *error) {
    const answer_options *o = &c->options->answers;
    if (!answers_open(&c->recording, &c->ignored, !o->no_depths, o->limits, &c->answers, error)) return false;
    if (o->as_given) c->answers.orientation = CSCD_ORIENTATION_AS_GIVEN;
    return true;
}

static bool create_detector(check_run *c, io_error *error) {
    cscd_detector_options options = cscd_detector_defaults();
    ignore_pairs_choose(&c->ignored, &options);
    if (cscd_detector_create(c->recording.context, c->recording.mesh, NULL, &options, &c->detector) !=
        CSCD_OK)
        return io_fail(error, "%s", cscd_context_detail(c->recording.context));
    c->positions = malloc((size_t)cscd_mesh_vertex_count(c->recording.mesh) * 3 * sizeof *c->positions);
    if (c->positions == NULL) return io_fail(error, "out of memory");
    if (!open_answers(c, error)) return false;
    if (c->rules.options.depth.given) answers_decide_depth(&c->answers, c->rules.depth);
    return answers_prepare(&c->answers, c->detector, error);
}

/* Everything that can fail before the work begins. */
static bool prepare_check(check_run *c, io_error *error) {
    const check_options *o = c->options;
    c->unit = answer_options_unit(&o->answers, &c->recording);
    return frame_range_choose(&o->frames, c->recording.frame_numbers, c->recording.frame_count, &c->frames,
                              error) &&
           fail_rules_create(&o->answers.fail, &c->unit, &c->rules, error) &&
           ignore_pairs_prepare(&o->ignored, &c->recording, &c->ignored, error) &&
           create_detector(c, error) &&
           exports_open(&o->exports, &c->recording, &c->ignored.parts, NULL, &c->exports, error) &&
           answer_outputs_open(&o->answers, &c->files, error) &&
           check_output_open(o->json_path, o->csv_path, &c->output, error);
}

static bool check_frames(check_run *c, io_error *error) {
    uint32_t count = frame_choice_count(&c->frames);
    answers_expect(&c->answers, count);
    for (uint32_t i = 0; i < count && !interrupted(); i++) {
        terminal_progress_update(&c->progress, i, count, "check");
        if (!check_frame(c, c->frames.first + i * c->frames.step, error)) return false;
    }
    return true;
}

static void print_answers(check_run *c) {
    if (c->options->quiet) return;
    c->printed = true;
    answers_print_sentence(stdout, &c->answers, &c->unit);
    answers_print_events(&c->answers, &c->unit);
    if (c->options->answers.timings) answers_print_frames(&c->answers, &c->unit);
}

/* Writes what was found, be it of all frames or not. */
static bool close_check(check_run *c, const char *stopped_by, io_error *error) {
    const check_options *o = c->options;
    const char *suite = recording_options_path(&o->source);
    if (stopped_by != NULL) answers_leave_unfinished(&c->answers, "%s", stopped_by);
    bool finished = answers_finish(&c->answers, error);
    if (finished) print_answers(c);
    if (!o->quiet) {
        recording_warn(&c->recording);
        turned_parts_tell(&c->answers.turned);
    }
    bool closed = check_output_close(&c->output, &c->answers, &c->unit, finished ? error : NULL);
    bool written = answer_outputs_close(&c->files, finished ? &c->answers : NULL, &c->rules, suite,
                                        finished && closed ? error : NULL);
    bool exported = exports_close(&c->exports, finished && closed && written ? error : NULL);
    return finished && closed && written && exported;
}

static void tell_interrupt(const check_run *c) {
    const check_options *o = c->options;
    const uint32_t done = (uint32_t)frames_done(c);
    const int32_t *numbers = c->recording.frame_numbers;
    const char *paths[OPTION_ROWS_MAX];
    const size_t path_count = output_paths_of(&check_table, o, paths);
    interrupt_tell(
        &(interrupt_kept){.done = done,
                          .whole = frame_choice_count(&c->frames),
                          .what = "frames",
                          .first = numbers[c->frames.first],
                          .last = numbers[c->frames.first + (done > 0 ? done - 1 : 0) * c->frames.step],
                          .paths = paths,
                          .path_count = path_count});
}

static int end_check(check_run *c, bool ran, const io_error *error) {
    io_error close_error = {""};
    if (!close_check(c, ran ? (interrupted() ? "interrupted" : NULL) : error->text, &close_error) && ran)
        return fail_input("%s", close_error.text);
    if (!ran) {
        const int code = fail_unfinished(&c->answers, c->printed, error->text);
        return c->job == NULL && fail_rules_failed(&c->rules, &c->answers) ? EXIT_CONTACT : code;
    }
    if (interrupted()) {
        if (c->job == NULL) tell_interrupt(c);
        return interrupt_exit_code();
    }
    if (c->job != NULL) {
        recording_answer_write(c->name, &c->answers, &c->unit, &c->rules, c->job);
        return EXIT_RAN;
    }
    return fail_rules_exit_code(&c->rules, &c->answers, c->printed);
}

int check_run_on(const check_options *options, const char *name, job_output *job) {
    check_run c = {.options = options, .name = name, .job = job};
    io_error error = {""};
    int code;
    recording_options source = options->source;
    source.plays_models = true;
    source.progress = (cscd_progress){terminal_progress_within, &c.progress};
    if (!recording_open(&source, &c.recording, &error)) return fail_input("%s", error.text);
    interrupt_catch();
    if (prepare_check(&c, &error)) {
        terminal_progress_begin(&c.progress, options->quiet);
        bool ran = check_frames(&c, &error) || interrupt_ended_wait();
        terminal_progress_end(&c.progress);
        code = end_check(&c, ran, &error);
    } else {
        check_output_abandon(&c.output);
        answer_outputs_close(&c.files, NULL, &c.rules, NULL, NULL);
        code = fail_input("%s", error.text);
    }
    exports_close(&c.exports, NULL);
    answers_close(&c.answers);
    cscd_detector_destroy(c.detector);
    ignore_pairs_free(&c.ignored);
    recording_close(&c.recording);
    free(c.positions);
    return code;
}
