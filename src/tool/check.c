/* `cscd check`: finds where a mesh intersects or touches itself, frame by frame. */
#include "src/tool/answers/answer_options.h"
#include "src/tool/answers/answer_words.h"
#include "src/tool/check_output.h"
#include "src/tool/common/command.h"
#include "src/tool/common/frame_range.h"
#include "src/tool/common/ignore_pairs.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/shared_options.h"
#include "src/tool/common/terminal.h"
#include "src/tool/each/check_each.h"
#include "src/tool/export/exports.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct check_options {
    recording_options source;
    frame_range frames;
    const char *json_path, *csv_path;
    ignore_options ignored;
    answer_options answers;
    export_request exports;
    bool each, quiet;
} check_options;

static bool read_fail_kind(const char *text, void *place) {
    int kind;
    if (!parse_choice(text, (const char *const[]){"crossing", "touching"}, 2, &kind)) return false;
    *(fail_kind *)place = kind == 0 ? FAIL_ON_CROSSING : FAIL_ON_TOUCHING;
    return true;
}

static bool fail_on_touching(const char *text, void *place) {
    (void)text;
    *(fail_kind *)place = FAIL_ON_TOUCHING;
    return true;
}

static const option_row rows[] = {
    {"json", "OUT.json", read_text, offsetof(check_options, json_path),
     "write the pairs of every frame (triangles and faces as in MODEL, from 0) and the events; - is the standard "
     "output, and the text for people then goes to the standard error"},
    {"csv", "OUT.csv", read_text, offsetof(check_options, csv_path),
     "write the pairs as a table; - as above"},
    {"each", NULL, read_flag, offsetof(check_options, each),
     "the inputs are different meshes, and each is checked alone: a line for each of them, and with --json a line of "
     "JSON"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(check_options, frames),
     "only the frames A to B, both included, or every STEP-th of them"},
    {"fail-on", "crossing|touching", read_fail_kind, offsetof(check_options, answers.fail.kind),
     "exit with 3 when triangles cross in any frame; touching: or touch"},
    {"fail-on-contact", NULL, fail_on_touching, offsetof(check_options, answers.fail.kind),
     "another name of --fail-on touching"},
    {"quiet", NULL, read_flag, offsetof(check_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

static const option_table table = {
    "check",
    "MODEL [FRAMES...] [options]\n       cscd check --each MODEL... [options]",
    "Finds where triangles cross or touch at each frame, and says which parts do, from when to when, and how deep. "
    "Features that share a vertex do not count. Exact: the answer is that of the given coordinates, without "
    "rounding. FRAMES as for replay; without them MODEL itself is checked.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(check_options, source)},
               {&frame_rows, offsetof(check_options, source)},
               {&pair_rows, offsetof(check_options, ignored)},
               {&answer_rows, offsetof(check_options, answers)},
               {&export_rows, offsetof(check_options, exports)}},
    .examples = {
        {"check body.obj",
         "Find out whether a mesh crosses or touches itself: which parts, how deep, with how many triangles."},
        {"check body.obj body.pc2 --frames 80:90 --json pairs.json",
         "Look at the frames 80 to 90, and write all pairs of triangles to a file."},
        {"check body.obj body.pc2 --ignore-rest=parts --fail-on crossing",
         "Fail, as a test does, when parts cross that are apart in the first frame, as an eye and its lid are not."}}};

/* A run of the command. */
typedef struct check_run {
    const check_options *options;
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
} check_run;

static size_t frames_done(const check_run *c) {
    return answers_frame_count(&c->answers);
}

static bool check_frame(check_run *c, uint32_t frame, io_error *error) {
    cscd_intersection_pairs found;
    io_error reason;
    if (!recording_read(&c->recording, frame, c->positions, error)) return false;
    if (!answers_add_frame(&c->answers, c->detector, frame, c->positions, &found, &reason))
        return io_fail(error, "frame %d: %s", c->recording.frame_numbers[frame], reason.text);
    return check_output_add(&c->output, &c->answers, &found, error) &&
           exports_add_frame(&c->exports, frame, c->positions, &found, error);
}

static bool create_detector(check_run *c, io_error *error) {
    cscd_detector_options options = cscd_detector_defaults();
    ignore_pairs_choose(&c->ignored, &options);
    if (cscd_detector_create(c->recording.context, c->recording.mesh, NULL, &options, &c->detector) !=
        CSCD_OK)
        return io_fail(error, "%s", cscd_context_detail(c->recording.context));
    c->positions = malloc((size_t)cscd_mesh_vertex_count(c->recording.mesh) * 3 * sizeof *c->positions);
    return (c->positions != NULL || io_fail(error, "out of memory")) &&
           answers_open(&c->recording, &c->ignored, !c->options->answers.no_depths, &c->answers, error) &&
           answers_prepare(&c->answers, c->detector, error);
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
    for (uint32_t i = 0; i < count && !interrupted(); i++) {
        terminal_progress_update(&c->progress, i, count, "check");
        if (!check_frame(c, c->frames.first + i * c->frames.step, error)) return false;
    }
    return true;
}

static void print_answers(const check_run *c) {
    if (c->options->quiet || frames_done(c) == 0) return;
    answers_print_sentence(stdout, &c->answers, &c->unit);
    answers_print_events(&c->answers, &c->unit);
    if (c->options->answers.timings) answers_print_frames(&c->answers, &c->unit);
}

/* Writes what was found, be it of all frames or not. */
static bool close_check(check_run *c, const char *stopped_by, io_error *error) {
    const check_options *o = c->options;
    const char *suite = recording_options_path(&o->source);
    bool finished = answers_finish(&c->answers, error);
    if (finished) print_answers(c);
    if (!o->quiet) {
        recording_warn(&c->recording);
        recording_note_animations(&c->recording);
    }
    bool closed = check_output_close(&c->output, &c->answers, &c->unit, stopped_by, finished ? error : NULL);
    bool written = answer_outputs_close(&c->files, finished ? &c->answers : NULL, &c->rules, suite,
                                        finished && closed ? error : NULL);
    bool exported = exports_close(&c->exports, finished && closed && written ? error : NULL);
    return finished && closed && written && exported;
}

static void tell_interrupt(const check_run *c) {
    const check_options *o = c->options;
    const uint32_t done = (uint32_t)frames_done(c);
    const int32_t *numbers = c->recording.frame_numbers;
    const char *const paths[] = {o->json_path,          o->csv_path,         o->answers.events_path,
                                 o->answers.junit_path, o->exports.vtk_path, o->exports.ply_path,
                                 o->exports.select_path};
    interrupt_tell(
        &(interrupt_kept){.done = done,
                          .whole = frame_choice_count(&c->frames),
                          .what = "frames",
                          .first = numbers[c->frames.first],
                          .last = numbers[c->frames.first + (done > 0 ? done - 1 : 0) * c->frames.step],
                          .paths = paths,
                          .path_count = sizeof paths / sizeof *paths});
}

static int end_check(check_run *c, bool ran, const io_error *error) {
    io_error close_error = {""};
    if (!close_check(c, ran ? (interrupted() ? "interrupted" : NULL) : error->text, &close_error) && ran)
        return fail_input("%s", close_error.text);
    if (!ran) return fail_input("%s", error->text);
    if (interrupted()) {
        tell_interrupt(c);
        return interrupt_exit_code();
    }
    return fail_rules_apply(&c->rules, &c->answers) ? EXIT_CONTACT : EXIT_RAN;
}

static int run_check(const check_options *options) {
    check_run c = {.options = options};
    io_error error = {""};
    int code;
    if (!recording_open(&options->source, &c.recording, &error)) return fail_input("%s", error.text);
    interrupt_catch();
    if (prepare_check(&c, &error)) {
        terminal_progress_begin(&c.progress, options->quiet);
        bool ran = check_frames(&c, &error);
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

/* Outputs are not inputs, and not each other. */
static int check_outputs(const check_options *o, const given_options *given) {
    const char *inputs[] = {o->ignored.path, o->ignored.parts_path};
    const char *outputs[] = {o->json_path, o->csv_path};
    io_error error;
    if (!output_path_is_safe(o->json_path, given->inputs, given->input_count, &error) ||
        !output_path_is_safe(o->json_path, inputs, 2, &error) ||
        !output_path_fits(o->json_path, ".json", &error))
        return fail_usage("check", "--json %s", error.text);
    if (!output_path_is_safe(o->csv_path, given->inputs, given->input_count, &error) ||
        !output_path_is_safe(o->csv_path, inputs, 2, &error) ||
        !output_path_differs(o->csv_path, outputs, 1, &error) ||
        !output_path_fits(o->csv_path, ".csv", &error))
        return fail_usage("check", "--csv %s", error.text);
    if (!answer_options_are_safe(&o->answers, given->inputs, given->input_count, outputs, 2, &error) ||
        !answer_options_are_safe(&o->answers, inputs, 2, NULL, 0, &error))
        return fail_usage("check", "%s", error.text);
    const char *tables[] = {o->answers.events_path, o->answers.junit_path};
    if (!export_request_fits(&o->exports, given->inputs, given->input_count, &error) ||
        !export_request_fits(&o->exports, inputs, 2, &error) ||
        !export_request_fits(&o->exports, outputs, 2, &error) ||
        !export_request_fits(&o->exports, tables, 2, &error))
        return fail_usage("check", "%s", error.text);
    return EXIT_RAN;
}

int command_check(int argument_count, char **arguments) {
    check_options options = {.frames = frame_range_all()};
    given_options given;
    int code;
    if (!option_table_read(&table, argument_count, arguments, &options, &given, &code)) return code;
    if (options.each)
        return check_each(&table, &given,
                          &(each_request){.weld = options.source.weld,
                                          .ignored = options.ignored,
                                          .json_path = options.json_path,
                                          .thread_count = options.source.thread_count,
                                          .fail_on_crossing = options.answers.fail.kind == FAIL_ON_CROSSING,
                                          .fail_on_touching = options.answers.fail.kind == FAIL_ON_TOUCHING,
                                          .quiet = options.quiet});
    if (given.input_count < 1 && options.source.objects.count == 0)
        return fail_usage("check", "no MODEL given");
    code = check_outputs(&options, &given);
    if (code != EXIT_RAN) return code;
    recording_options_take(&options.source, &given);
    options.exports.no_depths = options.answers.no_depths;
    return run_check(&options);
}
