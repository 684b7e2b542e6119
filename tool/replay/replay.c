/* `cscd replay`: finds every contact of a recorded mesh with itself, interval by interval. */
#include "tool/common/command.h"
#include "tool/common/methods.h"
#include "tool/common/options.h"
#include "tool/jobs/jobs.h"
#include "tool/replay/replay_run.h"
#include "tool/replay/replay_sink.h"
#include "tool/replay/shard_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool choose_frames(replay *r, io_error *error) {
    const int32_t *numbers = r->recording.frame_numbers;
    frame_choice frames;
    if (!frame_range_choose(&r->options->frames, numbers, r->recording.frame_count, &frames, error))
        return false;
    r->first = r->whole_first = frames.first;
    r->last = r->whole_last = frames.last;
    if (r->first >= r->last)
        return io_fail(error, "an interval needs two frames, and %d to %d leave one; the recording has %u",
                       numbers[r->first], numbers[r->last], r->recording.frame_count);
    return true;
}

static bool prepare_plan(replay *r, io_error *error) {
    const replay_options *o = r->options;
    plan_request request = {.model_path = recording_options_path(&o->source),
                            .plan_path = o->plan_path,
                            .method = o->method,
                            .k = o->k,
                            .ours = ours_of_plans(o->ours),
                            .min_separation = o->min_separation};
    terminal_progress_begin(&r->progress, o->quiet);
    terminal_progress_say(&r->progress, "preprocessing");
    bool chosen = plan_choose(&request, &r->recording, &r->plan, error);
    terminal_progress_end(&r->progress);
    return chosen;
}

static bool prepare_answers(replay *r, io_error *error) {
    const answer_options *o = &r->options->answers;
    r->unit = answer_options_unit(o, &r->recording);
    if (!fail_rules_create(&o->fail, &r->unit, &r->rules, error) ||
        !answers_open(&r->recording, &r->ignored, !o->no_depths, o->limits, &r->answers, error))
        return false;
    if (o->as_given) r->answers.orientation = CSCD_ORIENTATION_AS_GIVEN;
    if (o->fail.depth.given) answers_decide_depth(&r->answers, r->rules.depth);
    return true;
}

static bool prepare_source(replay *r, io_error *error) {
    r->source.detector = (replay_detector){.options = r->options,
                                           .recording = &r->recording,
                                           .plan = r->plan.plan,
                                           .method = r->plan.steps_by,
                                           .ignored = &r->ignored,
                                           .answers = &r->answers,
                                           .takes_orientations = r->options->report.path != NULL ||
                                                                 r->options->list.shard.count > 0};
    r->source.recording = &r->recording;
    r->source.first = r->whole_first;
    r->source.shards = r->merged;
    r->source.reads_frames = r->options->report.path != NULL || export_request_any(&r->options->exports);
    if (!replay_shard_matches(r, error) || !replay_shard_prepare(r, error)) return false;
    r->source.last = r->last;
    return replay_source_open(&r->source, error);
}

/* From here on a signal may not end the process by itself, or what is half written would lie about. */
static bool open_outputs(replay *r, io_error *error) {
    interrupt_catch();
    return sinks_open(r, error);
}

/* Opens everything that can fail before the work begins. */
static bool begin_replay(replay *r, io_error *error) {
    r->inputs = r->options->source;
    r->inputs.plays_models = true;
    r->inputs.progress = (cscd_progress){terminal_progress_within, &r->progress};
    return recording_open(&r->inputs, &r->recording, error) && choose_frames(r, error) &&
           ignore_pairs_prepare(&r->options->ignored, &r->recording, &r->ignored, error) &&
           output_paths_open(&replay_table, r->options, error) && prepare_plan(r, error) &&
           prepare_answers(r, error) && prepare_source(r, error) && open_outputs(r, error);
}

static void warn_of_zero_area(const replay *r, uint32_t frame, const cscd_intersections *found) {
    if (frame == r->first && found->zero_area_triangles > 0 && !r->options->quiet)
        warn("frame %d has %u triangles of zero area (the first is %u)", r->recording.frame_numbers[frame],
             found->zero_area_triangles, recording_file_triangle(&r->recording, found->first_zero_area));
}

/* The intersections of a frame, unless nothing was looked for. */
static bool take_frame(replay *r, uint32_t frame, frame_check *check, frame_state *state, io_error *error) {
    *state = FRAME_UNCHECKED;
    recording_add_hashes(&r->recording, check->hashes);
    if (!check->checked)
        return answers_skip_frame(&r->answers, frame, error) && sinks_add_frame(r, frame, NULL, error);
    io_error reason;
    cscd_intersections found = check->found;
    if (!answers_add_found(&r->answers, frame, &found, check->ms, &reason))
        return io_fail(error, "frame %d: %s", r->recording.frame_numbers[frame], reason.text);
    answers_add_turned(&r->answers, frame, check->turned);
    warn_of_zero_area(r, frame, &found);
    const frame_answer *answer = answers_frames(&r->answers) + answers_frame_count(&r->answers) - 1;
    if (frame_answer_checked(answer)) {
        const bool meets = found.crossing + found.coplanar + found.folded + found.touching > 0;
        *state = meets ? FRAME_CROSSING : FRAME_EMBEDDED;
        r->totals.frames_checked++;
        r->totals.frames_crossing += found.crossing > 0;
        r->totals.frames_touching += meets && found.crossing == 0;
    }
    return sinks_add_frame(r, frame, &found, error);
}

static interval_state state_of(const replay *r, size_t contact_count) {
    if (r->start_state == FRAME_CROSSING) return INTERVAL_PENETRATING;
    if (contact_count > 0) return INTERVAL_CONTACT;
    return r->start_state == FRAME_EMBEDDED ? INTERVAL_CLEAN : INTERVAL_UNKNOWN;
}

static bool any_collapsed(const replay *r, const cscd_guarantee *guarantees) {
    for (uint32_t i = 0; i < cscd_mesh_component_count(r->recording.mesh); i++)
        if (guarantees[i].reason == CSCD_REASON_COLLAPSED) return true;
    return false;
}

/* A mesh that is embedded at the start and intersects itself at the end had a contact in between. Pairs that
 * are left out may hide it, and those of what appears out of a point. */
static void alarm_contradiction(replay *r, const interval_result *result) {
    if (ignore_options_any(&r->options->ignored) || result->state != INTERVAL_CLEAN ||
        r->end_state != FRAME_CROSSING || any_collapsed(r, result->guarantees))
        return;
    r->totals.contradictions++;
    if (method_facts_of(r->plan.method).loses_contacts) return; /* which such a method may have */
    warn(
        "the interval from frame %d starts free of intersections and ends with one, but no contact was found: a "
        "contact was lost, please report this recording",
        result->frame);
}

/* An interval, and the frame at its end. */
static bool run_interval(replay *r, uint32_t k, io_error *error) {
    interval_step step;
    r->progress.may_stop = true; /* nothing of the interval is written yet */
    const bool found = replay_source_step(&r->source, k, &step, error);
    r->progress.may_stop = false;
    if (!found) return false;
    const cscd_contacts *contacts = &step.contacts;
    interval_result result = {.frame = r->recording.frame_numbers[k],
                              .contact_count = contacts->count + step.unlisted,
                              .earliest_toi = contacts->count > 0 ? contacts->items[0].toi : NAN,
                              .guarantees = step.guarantees,
                              .timings = step.timings,
                              .counters = step.counters};
    frame_check check;
    if (step.unlisted > 0) answers_leave_out_contacts(&r->answers, k, step.unlisted);
    if (!sinks_add_interval(r, k, &step, error) || !answers_add_contacts(&r->answers, contacts, error) ||
        !replay_source_check(&r->source, k, &check, error) ||
        !take_frame(r, k + 1, &check, &r->end_state, error))
        return false;
    result.timings.check_ms = check.ms;
    result.state = state_of(r, result.contact_count);
    totals_add(&r->totals, &result, r->recording.mesh);
    alarm_contradiction(r, &result);
    if (result.contact_count > 0 && !frame_list_add(&r->contact_frames, k))
        return io_fail(error, "out of memory");
    return sinks_end_interval(r, &result, error);
}

static bool run_intervals(replay *r, io_error *error) {
    frame_check check;
    if (r->first == r->last) return true; /* a shard without intervals */
    answers_expect(&r->answers, (size_t)(r->last - r->first) + 1);
    r->progress.may_stop = true;
    const bool begun = replay_source_begin(&r->source, r->first, &check, error);
    r->progress.may_stop = false;
    if (!begun) return false;
    if (!take_frame(r, r->first, &check, &r->start_state, error)) return false;
    for (uint32_t k = r->first; k < r->last && !interrupted(); k++) {
        terminal_progress_update(&r->progress, k - r->first, r->last - r->first, "replay");
        if (!run_interval(r, k, error)) return false;
        r->start_state = r->end_state;
    }
    return true;
}

/* Writes what was found, be it of all intervals or not. Without a frame nothing was. */
static bool close_outputs(replay *r, const char *stopped_by, io_error *error) {
    if (!r->sinks_are_open) return sinks_close(r, NULL);
    if (stopped_by != NULL) answers_leave_unfinished(&r->answers, "%s", stopped_by);
    const bool finished = answers_finish(&r->answers, error);
    return sinks_close(r, finished ? error : NULL) && finished;
}

static void tell_interrupt(const replay *r) {
    const replay_options *o = r->options;
    const char *paths[OPTION_ROWS_MAX + 1];
    size_t count = output_paths_of(&replay_table, o, paths);
    for (size_t i = 0; i < count; i++)
        if (paths[i] == o->report.path && r->totals.intervals == 0) paths[i] = NULL; /* there is none */
    paths[count++] = o->list.results_path;
    interrupt_tell(&(interrupt_kept){.done = r->totals.intervals,
                                     .whole = r->last - r->first,
                                     .what = "intervals",
                                     .first = r->recording.frame_numbers[r->first],
                                     .last = r->recording.frame_numbers[r->first + r->totals.intervals],
                                     .paths = paths,
                                     .path_count = count});
}

static void end_replay(replay *r) {
    replay_source_close(&r->source);
    shard_series_close(&r->resumed);
    answers_close(&r->answers);
    plan_choice_free(&r->plan);
    ignore_pairs_free(&r->ignored);
    if (r->recording.mesh != NULL) recording_close(&r->recording);
    frame_list_free(&r->contact_frames);
    free(r->summary_text);
}

/* Says so when no report was written: an older page may lie at its path. */
static int fail_replay(const replay *r, bool begun, bool printed, const char *reason) {
    bool unreported = begun && r->options->report.path != NULL && r->totals.intervals == 0;
    if (!unreported) return fail_unfinished(&r->answers, printed, reason);
    return fail_input("%s; no report was written", reason);
}

int replay_run(const replay_options *options, shard_series *merged, const char *name, job_output *job) {
    replay r = {.options = options, .merged = merged, .name = name, .job = job};
    io_error error = {""}, close_error = {""};
    int code = EXIT_RAN;
    bool begun = begin_replay(&r, &error), ran = false;
    if (begun) {
        terminal_progress_begin(&r.progress, options->quiet);
        ran = run_intervals(&r, &error) || interrupt_ended_wait();
        terminal_progress_end(&r.progress);
    }
    const char *stopped_by = ran ? (interrupted() ? "interrupted" : NULL) : error.text;
    bool closed = replay_shard_close(&r, &close_error);
    closed = close_outputs(&r, stopped_by, closed ? &close_error : NULL) && closed;
    const bool printed = begun && !options->quiet && r.first < r.last;
    if (printed) replay_print_results(&r);
    if (begun && r.first == r.last && !options->quiet)
        note("shard %u/%u has no intervals, since there are fewer chunks of %d than shards",
             options->list.shard.index, options->list.shard.count, CHUNK_INTERVALS);
    if (begun && !options->quiet) replay_print_remarks(&r);
    if (!ran) code = fail_replay(&r, begun, printed, error.text);
    if (!ran && begun && job == NULL && fail_rules_failed(&r.rules, &r.answers)) code = EXIT_CONTACT;
    if (!closed && (ran || strcmp(close_error.text, error.text) != 0)) /* what ended the run was said above */
        code = fail_input("%s", close_error.text);
    if (code == EXIT_RAN && interrupted()) {
        if (job == NULL) tell_interrupt(&r);
        code = interrupt_exit_code();
    }
    if (code == EXIT_RAN && job != NULL)
        recording_answer_write(name, &r.answers, &r.unit, &r.rules, job);
    else if (code == EXIT_RAN)
        code = fail_rules_exit_code(&r.rules, &r.answers, printed);
    end_replay(&r);
    return code;
}

static int run_listed(void *options, given_options *given, const char *name, cscd_context *context,
                      job_output *out) {
    replay_options *o = options;
    o->source.context = context;
    o->quiet = true;
    const int code = replay_options_finish(o, given);
    o->list = (list_options){.path = NULL}; /* shards of the list are not shards of the recording */
    return code == EXIT_RAN ? replay_run(o, NULL, name, out) : code;
}

static int run_list(const replay_options *options, const given_options *given) {
    const list_command command = {.table = &replay_table,
                                  .options = options,
                                  .options_size = sizeof *options,
                                  .given = given,
                                  .list = &options->list,
                                  .thread_count = options->source.thread_count,
                                  .quiet = options->quiet,
                                  .run = run_listed};
    return run_listed_recordings(&command);
}

int command_replay(int argument_count, char **arguments) {
    replay_options options;
    given_options given;
    int code;
    if (!replay_options_read(argument_count, arguments, &options, &given, &code)) return code;
    if (options.list.path != NULL) return run_list(&options, &given);
    code = replay_options_finish(&options, &given);
    return code == EXIT_RAN ? replay_run(&options, NULL, NULL, NULL) : code;
}
