/* `cscd check`: finds where a mesh intersects or touches itself, frame by frame. */
#include "src/io/output_file.h"
#include "src/tool/common/command.h"
#include "src/tool/common/frame_list.h"
#include "src/tool/common/frame_range.h"
#include "src/tool/common/ignore_pairs.h"
#include "src/tool/common/option_table.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"
#include "src/tool/common/provenance.h"
#include "src/tool/common/shared_options.h"
#include "src/tool/common/terminal.h"
#include "src/tool/each/check_each.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct check_options {
    recording_options source;
    frame_range frames;
    const char *json_path;
    ignore_options ignored;
    bool each, fail_on_contact, quiet;
} check_options;

static const option_row rows[] = {
    {"json", "OUT.json", read_text, offsetof(check_options, json_path),
     "write the pairs of every frame (triangles as in MODEL, from 0); - is the standard output, and the text for "
     "people then goes to the standard error"},
    {"each", NULL, read_flag, offsetof(check_options, each),
     "the inputs are different meshes, and each is checked alone: a line for each of them, and with --json a line of "
     "JSON"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(check_options, frames),
     "only the frames A to B, both included, or every STEP-th of them"},
    {"fail-on-contact", NULL, read_flag, offsetof(check_options, fail_on_contact),
     "exit with 3 when any frame has such a pair"},
    {"quiet", NULL, read_flag, offsetof(check_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

static const option_table table = {
    "check",
    "MODEL [FRAMES...] [options]\n       cscd check --each MODEL... [options]",
    "Finds the pairs of triangles that intersect or touch at each frame, features that share a vertex aside. "
    "Exact: the answer is that of the given coordinates, without rounding. FRAMES as for replay; without them "
    "MODEL itself is checked.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(check_options, source)},
               {&frame_rows, offsetof(check_options, source)},
               {&pair_rows, offsetof(check_options, ignored)}},
    .examples = {
        {"check body.obj", "Find the triangles of a mesh that intersect or touch each other."},
        {"check body.obj body.pc2 --frames 80:90 --json pairs.json",
         "Find those of the frames 80 to 90, and write them to a file."},
        {"check body.obj body.pc2 --ignore-rest=parts --fail-on-contact",
         "Fail, as a test does, when parts meet that are apart in the first frame, as an eye and its lid are not."}}};

/* A run of the command. */
typedef struct check_run {
    const check_options *options;
    recording recording;
    ignore_pairs ignored;
    cscd_detector *detector;
    double *positions;
    output_file file; /* its file is NULL when not asked for */
    json out;
    terminal_progress progress;
    frame_choice frames;
    uint32_t frames_checked;
    frame_list intersecting;
} check_run;

/* Triangles are numbered as in MODEL. The smaller comes first, because welding keeps the order. */
static void write_frame(check_run *c, uint32_t frame, const cscd_intersections *found) {
    json *out = &c->out;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_signed(out, "frame", c->recording.frame_numbers[frame]);
    json_boolean(out, "crossing", found->count > 0);
    json_integer(out, "zero_area_triangles", found->zero_area_triangles);
    json_begin_array(out, "pairs");
    for (size_t i = 0; i < found->count; i++) {
        json_begin_array(out, NULL);
        json_integer(out, NULL, recording_file_triangle(&c->recording, found->items[i].a));
        json_integer(out, NULL, recording_file_triangle(&c->recording, found->items[i].b));
        json_end_array(out);
    }
    json_end_array(out);
    json_end_object(out);
    output_file_flush(&c->file);
}

static bool check_frame(check_run *c, uint32_t frame, io_error *error) {
    cscd_intersections found;
    if (!recording_read(&c->recording, frame, c->positions, error)) return false;
    if (cscd_detector_check(c->detector,
                            CSCD_DOUBLES(c->positions, cscd_mesh_vertex_count(c->recording.mesh)),
                            &found) != CSCD_OK)
        return io_fail(error, "frame %d: %s", c->recording.frame_numbers[frame],
                       cscd_context_detail(c->recording.context));
    c->frames_checked++;
    if (found.count > 0 && !frame_list_add(&c->intersecting, frame)) return io_fail(error, "out of memory");
    if (found.count > 0 && !c->options->quiet)
        printf("frame %d: %zu triangle pairs intersect or touch, the first %u and %u\n",
               c->recording.frame_numbers[frame], found.count,
               recording_file_triangle(&c->recording, found.items[0].a),
               recording_file_triangle(&c->recording, found.items[0].b));
    if (c->out.file != NULL) write_frame(c, frame, &found);
    return true;
}

static bool prepare_check(check_run *c, io_error *error) {
    const check_options *o = c->options;
    if (!frame_range_choose(&o->frames, c->recording.frame_numbers, c->recording.frame_count, &c->frames,
                            error))
        return false;
    cscd_detector_options options = cscd_detector_defaults();
    if (!ignore_pairs_prepare(&o->ignored, &c->recording, &c->ignored, error)) return false;
    ignore_pairs_choose(&c->ignored, &options);
    if (cscd_detector_create(c->recording.context, c->recording.mesh, NULL, &options, &c->detector) !=
        CSCD_OK)
        return io_fail(error, "%s", cscd_context_detail(c->recording.context));
    c->positions = malloc((size_t)cscd_mesh_vertex_count(c->recording.mesh) * 3 * sizeof *c->positions);
    if (c->positions == NULL) return io_fail(error, "out of memory");
    if (o->json_path == NULL) return true;
    if (!output_file_open(o->json_path, &c->file))
        return io_fail(error, "%s: cannot write: %s", o->json_path, strerror(errno));
    c->out.file = c->file.file;
    json_begin_object(&c->out, NULL);
    json_begin_array(&c->out, "frames");
    return true;
}

static bool check_frames(check_run *c, io_error *error) {
    uint32_t count = frame_choice_count(&c->frames);
    for (uint32_t i = 0; i < count && !interrupted(); i++) {
        terminal_progress_update(&c->progress, i, count, "check");
        if (!check_frame(c, c->frames.first + i * c->frames.step, error)) return false;
    }
    return true;
}

static bool close_json(check_run *c, const char *stopped_by, io_error *error) {
    json *out = &c->out;
    if (out->file == NULL) return true;
    json_end_array(out);
    json_break_line(out);
    json_boolean(out, "complete", stopped_by == NULL);
    if (stopped_by != NULL) json_string(out, "stopped_by", stopped_by);
    json_end_object(out);
    fputc('\n', out->file);
    return output_file_close(&c->file, OUTPUT_WHOLE) ||
           io_fail(error, "%s: cannot write: %s", c->options->json_path, strerror(errno));
}

static void tell_interrupt(const check_run *c) {
    const uint32_t done = c->frames_checked > 0 ? c->frames_checked - 1 : 0;
    const int32_t *numbers = c->recording.frame_numbers;
    interrupt_tell(&(interrupt_kept){.done = c->frames_checked,
                                     .whole = frame_choice_count(&c->frames),
                                     .what = "frames",
                                     .first = numbers[c->frames.first],
                                     .last = numbers[c->frames.first + done * c->frames.step],
                                     .paths = &c->options->json_path,
                                     .path_count = 1});
}

static int run_check(const check_options *options) {
    check_run c = {.options = options};
    io_error error = {""}, close_error = {""};
    if (!recording_open(&options->source, &c.recording, &error)) return fail_input("%s", error.text);
    if (!options->quiet) recording_warn(&c.recording);
    interrupt_catch();
    terminal_progress_begin(&c.progress, options->quiet);
    bool ran = prepare_check(&c, &error) && check_frames(&c, &error);
    terminal_progress_end(&c.progress);
    bool closed = close_json(&c, ran ? (interrupted() ? "interrupted" : NULL) : error.text, &close_error);
    if (c.frames_checked > 0 && !options->quiet) {
        printf("%s: %u of %u frames intersect or touch themselves", recording_options_path(&options->source),
               frame_list_frames(&c.intersecting), c.frames_checked);
        frame_list_print(&c.intersecting, c.recording.frame_numbers, ": ");
    }
    if (ran && closed && interrupted()) tell_interrupt(&c);
    int code = !ran                                                   ? fail_input("%s", error.text)
               : !closed                                              ? fail_input("%s", close_error.text)
               : interrupted()                                        ? EXIT_INTERRUPTED
               : options->fail_on_contact && c.intersecting.count > 0 ? EXIT_CONTACT
                                                                      : EXIT_RAN;
    cscd_detector_destroy(c.detector);
    ignore_pairs_free(&c.ignored);
    recording_close(&c.recording);
    frame_list_free(&c.intersecting);
    free(c.positions);
    return code;
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
                                          .fail_on_contact = options.fail_on_contact,
                                          .quiet = options.quiet});
    if (given.input_count < 1 && options.source.objects.count == 0)
        return fail_usage("check", "no MODEL given");
    io_error error;
    if (!output_path_is_safe(options.json_path, given.inputs, given.input_count, &error) ||
        !output_path_is_safe(options.json_path, &options.ignored.path, 1, &error) ||
        !output_path_fits(options.json_path, ".json", &error))
        return fail_usage("check", "--json %s", error.text);
    recording_options_take(&options.source, &given);
    return run_check(&options);
}
