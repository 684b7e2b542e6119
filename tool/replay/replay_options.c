/* The options of `cscd replay`. */
#include "tool/replay/replay_options.h"

#include "cscd/research.h"
#include "tool/common/command.h"
#include "tool/common/methods.h"
#include "tool/common/options.h"
#include "tool/io/format_reader.h"
#include "tool/io/record.h"

static bool read_method(const char *text, void *place) {
    replay_options *o = place;
    return parse_method(text, &o->method, &o->k);
}

static bool read_mode(const char *text, void *place) {
    return cscd_from_name(CSCD_MODES, text, place);
}

static bool read_start(const char *text, void *place) {
    int start;
    if (!parse_choice(text, (const char *const[]){"prove", "vouched", "unknown"}, 3, &start)) return false;
    *(cscd_start *)place = (cscd_start)start;
    return true;
}

static bool read_volume(const char *text, void *place) {
    return cscd_from_name(CSCD_VOLUMES, text, place);
}

static bool read_simd(const char *text, void *place) {
    return cscd_from_name(CSCD_SIMDS, text, place);
}

static bool read_fail_kind(const char *text, void *place) {
    int kind;
    if (!parse_choice(text, (const char *const[]){"crossing", "touching", "contact"}, 3, &kind)) return false;
    *(fail_kind *)place = (fail_kind)(FAIL_ON_CROSSING + kind);
    return true;
}

static bool fail_on_contact(const char *text, void *place) {
    (void)text;
    *(fail_kind *)place = FAIL_ON_CONTACT;
    return true;
}

static const option_row rows[] = {
    {"contacts", "OUT.csv|OUT.jsonl", read_output_path, offsetof(replay_options, contacts_path),
     "write each contact: frame, kind, time of impact, vertices, point, normal; - is the standard output"},
    {"csv", "OUT.csv", read_output_path, offsetof(replay_options, contacts_path),
     "another name of --contacts; --csv - writes them to the standard output"},
    {"json", "OUT.json", read_output_path, offsetof(replay_options, json_path),
     "write a summary: every interval, every frame, events, timings, provenance; - is the standard output, and the text "
     "for people then goes to the standard error"},
    {"report", "OUT.html", read_output_path, offsetof(replay_options, report.path),
     "write a page that shows all of it in any browser: the motion, contacts, charge, regions, timings"},
    {"title", "TEXT", read_text, offsetof(replay_options, report.title),
     "of the report (default: the model's file)"},
    {"scenery", "MODEL", read_input_path, offsetof(replay_options, report.scenery_path),
     "of the report: another mesh (ground, stairs, a ball), drawn and never tested"},
    {"scenery-frames", "FRAMES", read_input_path, offsetof(replay_options, report.scenery_frames_path),
     "how it moves: a point cache or a pattern, of as many frames, or of one"},
    {"up", "y|z", read_up, offsetof(replay_options, report.up),
     "of the report: which axis points up (default: y of OBJ and glTF, else z)"},
    {"frames", "A:B", read_frames, offsetof(replay_options, frames),
     "only from frame A to frame B, both included (A: and :B are open ends)"},
    {"plan", "PLAN.ply", read_input_path, offsetof(replay_options, plan_path),
     "the regions that cscd preprocess found (default: MODEL.plan.ply if it fits, else made on the way: as by preprocess "
     "--method auto where that takes a tenth of the intervals at most or the triangles are few, else single)"},
    {"method", "charge|kmeans:K|single", read_method, 0,
     "leave out pairs by such a plan, that of --plan or made on the way (default: by any plan, where it pays)"},
    {"method", "none|brute", .help = "leave out none; test all pairs of features, slow"},
    {"method", "iccd",
     .help = "leave out pairs by normal cones and contours (Tang et al. 2009): to compare with"},
    {"method", "cones",
     .help = "leave out pairs by normal cones and star-shaped contours (Wang et al. 2017): to compare with"},
    {"method", "published|iccd-published", .help = "as published, which loses contacts: for comparison only"},
    {"ours", "STEP,...", read_ours, offsetof(replay_options, ours),
     "with these: take steps from charge instead: motion, starts, representatives, neighbours, tests, boxes, and of the "
     "plan charge, ranks, cuts, points"},
    {"mode", "all|earliest", read_mode, offsetof(replay_options, mode),
     "what is promised (default all: every contact; earliest: of each component with itself, the first ones only)"},
    {"start", "prove", read_start, offsetof(replay_options, start),
     "leave out pairs only where it is proven that the mesh does not intersect itself when the interval starts "
     "(default)"},
    {"start", "vouched", .help = "take your word for that; where it is wrong, contacts may be lost"},
    {"start", "unknown", .help = "leave out only what the static check of the frame has shown to be free"},
    {"min-separation", "D", read_length, offsetof(replay_options, min_separation),
     "count it as a contact when features come within D of each other, as cloth of thickness D does; a length in "
     "the files' unit (default 0: they touch); the check of single frames knows no distance"},
    {"no-check", NULL, read_flag, offsetof(replay_options, no_check),
     "skip the static check of every frame; how intervals start is then unknown"},
    {"volume", "box|kdop14", read_volume, offsetof(replay_options, volume),
     "bounding volumes of the trees (default box); the contacts are the same"},
    {"simd", "auto|scalar|avx2|avx512|neon", read_simd, offsetof(replay_options, source.simd),
     "vector instructions (default: the best here); the contacts are the same"},
    {"fail-on", "crossing|touching|contact", read_fail_kind, offsetof(replay_options, answers.fail.kind),
     "exit with 3 when triangles cross or parts share space in any frame; touching: or touch, or are there twice; contact: or come into contact between "
     "two frames"},
    {"fail-on-contact", NULL, fail_on_contact, offsetof(replay_options, answers.fail.kind),
     "another name of --fail-on contact"},
    {"reproducible", NULL, read_flag, offsetof(replay_options, reproducible),
     "leave times, dates, the machine and the command line out of --json and --report, so that two runs write the same bytes"},
    {"quiet", NULL, read_flag, offsetof(replay_options, quiet), "no progress, no warnings, no table"},
};

const option_table replay_table = {
    "replay",
    "MODEL FRAMES... [options]\n       cscd replay --list JOBS.jsonl [options]",
    "Finds every contact of the mesh MODEL (" MESH_FORMAT_NAMES
    ") with itself between one frame and the next, and what "
    "crosses or touches at each frame, as check does.\n"
    "FRAMES: one .pc2 or .mdd point cache, one .glb or .gltf file, a pattern like f_%04d.obj, a folder, or a "
    "list of mesh files.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(replay_options, source)},
               {&frame_rows, offsetof(replay_options, source)},
               {&pair_rows, offsetof(replay_options, ignored)},
               {&answer_rows, offsetof(replay_options, answers)},
               {&export_rows, offsetof(replay_options, exports)},
               {&list_rows, offsetof(replay_options, list)}},
    .examples = {
        {"replay body.obj body.pc2 --report body.html",
         "Find every contact between one frame and the next, and show them on a page for any browser."},
        {"replay body.obj body.pc2 --object Shirt=shirt.obj --frames-of Shirt=shirt.pc2 --only Shirt,body",
         "Find where a shirt and the body under it meet, each with a cache of its own."},
        {"replay body.obj 'f_%04d.obj' --weld exact --ignore-rest --fail-on contact",
         "Fail, as a test does, when a body with split seams touches itself where it does not in the first frame."}}};

/* Without FRAMES the files of objects may hold an animation. */
static bool objects_may_move(const replay_options *o) {
    const named_paths *objects = &o->source.objects;
    bool may = false;
    for (uint32_t i = 0; i < objects->count; i++) may |= gltf_recognise_path(objects->items[i].path);
    return may && !o->source.rest;
}

/* Options that contradict each other or ask for what replay does not do. */
static int check_options(const replay_options *o, size_t input_count) {
    if (input_count < 1 && o->source.objects.count == 0) return fail_usage("replay", "no MODEL given");
    if (input_count < 2 && o->source.frames_of.count == 0 && !objects_may_move(o))
        return fail_usage("replay", "no FRAMES given");
    if (o->contacts_path != NULL && !contact_file_names_format(o->contacts_path))
        return fail_usage("replay", "--contacts '%s': expected a name that ends in .csv or .jsonl, or -",
                          o->contacts_path);
    if (o->plan_path != NULL && o->method != CSCD_METHOD_AUTO && !method_facts_of(o->method).by_regions)
        return fail_usage("replay", "--plan is of no use with --method %s", cscd_method_name(o->method));
    io_error error;
    if (!ours_agrees(o->method, o->ours, &error)) return fail_usage("replay", "%s", error.text);
    if (o->plan_path != NULL && ours_of_plans(o->ours) != 0)
        return fail_usage("replay",
                          "--ours charge, ranks, cuts and points say how a plan is made, and --plan "
                          "brings one; leave out either");
    if (!report_request_agrees(&o->report, &error) || !export_request_fits(&o->exports, &error))
        return fail_usage("replay", "%s", error.text);
    if (o->no_check && export_request_any(&o->exports))
        return fail_usage("replay",
                          "--vtk, --ply and --select tell what intersects, which --no-check leaves out");
    const fail_options *fail = &o->answers.fail;
    if (o->no_check && (fail->depth.given || fail->faces_limited || fail->kind == FAIL_ON_CROSSING ||
                        fail->kind == FAIL_ON_TOUCHING))
        return fail_usage("replay",
                          "the rules that fail a run ask what intersects, which --no-check leaves out");
    if (!o->no_check && !answer_options_agree(&o->answers, &error))
        return fail_usage("replay", "%s", error.text);
    if (o->frames.step != 1)
        return fail_usage("replay",
                          "--frames with a step of %u: a contact lies between one frame and the next, so "
                          "replay takes A:B only",
                          o->frames.step);
    return EXIT_RAN;
}

/* The first option that was given and says what is written, or what a report shows; NULL: there is none. */
static const char *option_of_outputs(const given_options *given) {
    static const char *const of_reports[] = {"title", "scenery", "scenery-frames", "up"};
    option_row all[OPTION_ROWS_MAX];
    const size_t count = option_table_rows(&replay_table, all);
    for (size_t i = 0; i < count; i++)
        if (given->rows[i] && option_is_output(&all[i])) return all[i].name;
    for (size_t i = 0; i < sizeof of_reports / sizeof *of_reports; i++)
        if (option_given(&replay_table, given, of_reports[i])) return of_reports[i];
    return NULL;
}

/* A shard of one recording, or all of it as one. What it finds is in its results, and written by merge. */
static int check_shard(replay_options *o, const given_options *given, const char *const *inputs,
                       size_t input_count) {
    const list_options *list = &o->list;
    io_error error;
    if (option_given(&replay_table, given, "job-timeout"))
        return fail_usage("replay", "--job-timeout is for --list");
    if (list->results_path == NULL && (list->shard.count > 0 || list->resume != RESUME_NOTHING))
        return fail_usage("replay", "--%s needs --results OUT, the file of what is found",
                          list->shard.count > 0 ? "shard" : "resume");
    if (list->results_path == NULL) return EXIT_RAN;
    if (list->resume == RESUME_FAILED) return fail_usage("replay", "--resume=failed is for --list");
    const char *merged = option_of_outputs(given);
    if (merged != NULL)
        return fail_usage("replay",
                          "--%s: with --results it is written by cscd merge, from the files of all shards",
                          merged);
    const char *files[] = {o->plan_path, o->ignored.path, o->ignored.parts_path};
    if (!output_path_is_safe(list->results_path, inputs, input_count, &error) ||
        !output_path_is_safe(list->results_path, files, 3, &error))
        return fail_usage("replay", "--results %s", error.text);
    if (list->shard.count == 0) o->list.shard = (shard_choice){1, 1};
    return EXIT_RAN;
}

static uint64_t hash_options(const given_options *given) {
    static const char *const harmless[] = {"shard", "results", "resume", "threads",      "quiet",
                                           "simd",  "plan",    "frames", "reproducible", "timings"};
    return option_hash_beside(&replay_table, given, harmless, sizeof harmless / sizeof *harmless);
}

bool replay_options_read(int argument_count, char **arguments, replay_options *out, given_options *given,
                         int *code) {
    *out = (replay_options){.method = CSCD_METHOD_AUTO,
                            .mode = CSCD_MODE_ALL,
                            .frames = frame_range_all(),
                            .argument_count = argument_count,
                            .arguments = arguments};
    if (!option_table_read(&replay_table, argument_count, arguments, out, given, code)) return false;
    out->hash = hash_options(given);
    return true;
}

int replay_options_finish(replay_options *o, given_options *given) {
    /* A glTF file holds the model and its frames. */
    static const char *both[2]; /* as long as the options, of which there is one at a time */
    if (given->input_count == 1 && !o->source.rest && gltf_recognise_path(given->inputs[0])) {
        both[0] = both[1] = given->inputs[0];
        given->inputs = both;
        given->input_count = 2;
    }
    io_error error;
    int code = check_options(o, given->input_count);
    if (code == EXIT_RAN && o->list.path == NULL)
        code = check_shard(o, given, given->inputs, given->input_count);
    if (code == EXIT_RAN && !output_paths_are_safe(&replay_table, o, given, &error))
        code = fail_usage("replay", "%s", error.text);
    recording_options_take(&o->source, given);
    o->exports.no_depths = o->answers.no_depths;
    o->exports.contacts = true;
    return code;
}
