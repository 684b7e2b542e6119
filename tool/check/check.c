/* `cscd check`: finds where a mesh intersects or touches itself, frame by frame. */
#include "tool/check/check_run.h"
#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/jobs/jobs.h"

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
    {"json", "OUT.json", read_output_path, offsetof(check_options, json_path),
     "write the pairs of every frame (triangles and faces as in MODEL, from 0) and the events; - is the standard "
     "output, and the text for people then goes to the standard error"},
    {"csv", "OUT.csv", read_output_path, offsetof(check_options, csv_path),
     "write the pairs as a table; - as above"},
    {"each", NULL, read_flag, offsetof(check_options, each),
     "the inputs are different meshes, and each is checked alone: a line for each of them, and with --json a line of "
     "JSON"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(check_options, frames),
     "only the frames A to B, both included, or every STEP-th of them"},
    {"fail-on", "crossing|touching", read_fail_kind, offsetof(check_options, answers.fail.kind),
     "exit with 3 when triangles cross or parts share space in any frame; touching: or touch, or are there twice"},
    {"fail-on-touching", NULL, fail_on_touching, offsetof(check_options, answers.fail.kind),
     "another name of --fail-on touching"},
    {"fail-on-contact", NULL, fail_on_touching, offsetof(check_options, answers.fail.kind), NULL},
    {"reproducible", NULL, read_flag, offsetof(check_options, reproducible),
     "leave times out of the lines of --each, so that two runs write the same bytes; nothing else has any"},
    {"quiet", NULL, read_flag, offsetof(check_options, quiet),
     "no progress, no warnings, nothing on the standard output"},
};

const option_table check_table = {
    "check",
    "MODEL [FRAMES...] [options]\n       cscd check --each MODEL... [options]\n       cscd check --list JOBS.jsonl [options]",
    "Finds where triangles cross or touch at each frame, and says which parts do, from when to when, and how deep. "
    "Features that share a vertex do not count. Exact: the answer is that of the given coordinates, without "
    "rounding. FRAMES as for replay; without them the animation that MODEL holds, or MODEL itself is checked.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(check_options, source)},
               {&frame_rows, offsetof(check_options, source)},
               {&pair_rows, offsetof(check_options, ignored)},
               {&answer_rows, offsetof(check_options, answers)},
               {&export_rows, offsetof(check_options, exports)},
               {&list_rows, offsetof(check_options, list)}},
    .examples = {
        {"check body.obj",
         "Find out whether a mesh crosses or touches itself: which parts, how deep, with how many triangles."},
        {"check body.obj body.pc2 --frames 80:90 --json pairs.json",
         "Look at the frames 80 to 90, and write all pairs of triangles to a file."},
        {"check body.obj body.pc2 --ignore-rest=parts --fail-on crossing",
         "Fail, as a test does, when parts cross that are apart in the first frame, as an eye and its lid are not."}}};

/* Runs the command with options whose inputs are those given. */
static int run_recording(check_options *options, const given_options *given, const char *name,
                         job_output *job) {
    if (given->input_count < 1 && options->source.objects.count == 0)
        return fail_usage("check", "no MODEL given");
    io_error error;
    if (!export_request_fits(&options->exports, &error) ||
        !output_paths_are_safe(&check_table, options, given, &error))
        return fail_usage("check", "%s", error.text);
    recording_options_take(&options->source, given);
    options->exports.no_depths = options->answers.no_depths;
    return check_run_on(options, name, job);
}

/* ---- many ---------------------------------------------------------------------------------------------- */

static int run_listed(void *options, given_options *given, const char *name, cscd_context *context,
                      job_output *out) {
    check_options *o = options;
    o->source.context = context;
    o->quiet = true;
    return run_recording(o, given, name, out);
}

static int run_list(const check_options *options, const given_options *given) {
    const list_command command = {.table = &check_table,
                                  .options = options,
                                  .options_size = sizeof *options,
                                  .given = given,
                                  .list = &options->list,
                                  .thread_count = options->source.thread_count,
                                  .quiet = options->quiet,
                                  .run = run_listed};
    return run_listed_recordings(&command);
}

static int refuse_beside_each(const check_options *o, const given_options *given) {
    static const char *const own[] = {"each",
                                      "json",
                                      "weld",
                                      "ignore-parts",
                                      "only",
                                      "threads",
                                      "fail-on",
                                      "fail-on-contact",
                                      "fail-on-touching",
                                      "fail-depth",
                                      "max-faces",
                                      "unit",
                                      "no-depths",
                                      "max-memory",
                                      "max-work",
                                      "fps",
                                      "animation",
                                      "rest",
                                      "quiet",
                                      "shard",
                                      "results",
                                      "resume",
                                      "job-timeout",
                                      "reproducible",
                                      "parts-by",
                                      "orientation"};
    io_error error;
    const char *foreign = option_given_beside(&check_table, given, own, sizeof own / sizeof *own);
    if (foreign != NULL)
        return fail_usage("check", "--each checks each mesh alone, and --%s says nothing about that",
                          foreign);
    if (given->input_count == 0) return fail_usage("check", "--each: no meshes given");
    if (!output_path_is_safe(o->json_path, given->inputs, given->input_count, &error) ||
        (!output_path_fits(o->json_path, ".json", NULL) && !output_path_fits(o->json_path, ".jsonl", &error)))
        return fail_usage("check", "--json %s", error.text);
    if (o->json_path != NULL && o->list.resume != RESUME_NOTHING)
        return fail_usage(
            "check",
            "--json would lack the meshes that --resume passes over; leave it out, and let cscd merge %s -o %s "
            "write all lines",
            o->list.results_path != NULL ? o->list.results_path : "RESULTS.jsonl", o->json_path);
    if (!list_options_are_safe(&o->list, given->inputs, given->input_count, &error))
        return fail_usage("check", "--results %s", error.text);
    return EXIT_RAN;
}

static int run_each(const check_options *o, const given_options *given) {
    const mesh_kind_options meshes = {.source = &o->source,
                                      .ignored = &o->ignored,
                                      .answers = &o->answers,
                                      .reproducible = o->reproducible};
    const job_kind jobs = mesh_kind_of(&meshes);
    job_list list;
    io_error error;
    const int code = refuse_beside_each(o, given);
    if (code != EXIT_RAN) return code;
    if (!job_list_of_names(given->inputs, given->input_count, &list, &error))
        return fail_jobs("%s", error.text);
    jobs_request request = list_options_request(&o->list, &list, &check_table, given);
    request.lines_path = o->json_path;
    request.thread_count = o->source.thread_count;
    request.quiet = o->quiet;
    const int end = run_jobs(&request, &jobs);
    job_list_free(&list);
    return end;
}

int command_check(int argument_count, char **arguments) {
    check_options options = {.frames = frame_range_all()};
    given_options given;
    int code;
    if (!option_table_read(&check_table, argument_count, arguments, &options, &given, &code)) return code;
    io_error error;
    if (!answer_options_agree(&options.answers, &error)) return fail_usage("check", "%s", error.text);
    if (options.list.path != NULL) return run_list(&options, &given);
    if (options.each) return run_each(&options, &given);
    const char *lone = list_option_without_list(&check_table, &given);
    if (lone != NULL) return fail_usage("check", "--%s is for --list or --each", lone);
    return run_recording(&options, &given, NULL, NULL);
}
