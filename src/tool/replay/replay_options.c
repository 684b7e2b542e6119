/* The options of `cscd replay`. */
#include "src/tool/replay/replay_options.h"

#include "src/io/contact_file.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: cscd replay MODEL FRAMES... [options]\n"
    "\n"
    "Finds every place where the mesh MODEL (OBJ, PLY, OFF) runs into itself between one frame and the "
    "next.\n"
    "FRAMES: one .pc2 or .mdd point cache, a pattern like f_%04d.obj, a folder, or a list of mesh files.\n"
    "\n"
    "  --contacts OUT.csv|OUT.jsonl  write each contact: frame, kind, time of impact, vertices, point, "
    "normal\n"
    "  --json OUT.json               write a summary: every interval, every frame, timings, provenance\n"
    "  --report OUT.html             write a page that shows all of it in any browser: the motion, contacts, "
    "charge,\n"
    "                                regions, timings\n"
    "  --scenery MODEL               of the report: another mesh (ground, stairs, a ball), drawn and never "
    "tested\n"
    "  --scenery-frames FRAMES       how it moves: a point cache or a pattern, of as many frames, or of one\n"
    "  --up y|z                      of the report: which axis points up (default z)\n"
    "  --frames A:B                  only from frame A to frame B, both included (A: and :B are open ends)\n"
    "  --plan PLAN.ply               the regions that cscd preprocess found (default: MODEL.plan.ply if it "
    "fits,\n"
    "                                else made on the way: by charge up to 6000 triangles, else single)\n"
    "  --method charge|kmeans:K|single  cull by such a plan, that of --plan or made on the way\n"
    "  --method none|brute           no culling; all pairs of features, slow\n"
    "  --method iccd                 cull by normal cones and contours (Tang et al. 2009): to compare with\n"
    "  --method published|iccd-published  as published, which loses contacts: for comparison only\n"
    "  --mode all|earliest           what is promised (default all: every contact; earliest: of each closed\n"
    "                                component that starts free of crossings, the first with itself)\n"
    "  --start prove|vouched|unknown  what is done to know that a start is free of crossings: the static\n"
    "                                check (default), nothing since you know that it is, nothing\n"
    "  --min-separation D            a contact is coming within D, a length in the files' unit, not "
    "touching\n"
    "                                (default 0); the static check stays one of crossing and touching\n"
    "  --no-check                    skip the static check of every frame; how intervals start is then "
    "unknown\n"
    "  --weld exact|EPS              join vertices that coincide, or lie within EPS, in the first frame\n"
    "  --ignore-rest                 leave out triangle pairs that touch or cross in the first frame\n"
    "  --ignore LIST                 leave out the pairs of a file: lines 'A B' (triangles) or 'components A "
    "B'\n"
    "  --threads N                   default 1; 0: one per processor\n"
    "  --volume box|kdop14           bounding volumes of the trees (default box); the contacts are the same\n"
    "  --simd auto|scalar|avx2|avx512  vector instructions (default: the best here); the contacts are the "
    "same\n"
    "  --fail-on-contact             exit with 3 when there was a contact\n"
    "  --quiet                       no progress, no warnings, no table\n";

enum option_id {
    OPTION_CONTACTS = 1,
    OPTION_JSON,
    OPTION_REPORT,
    OPTION_SCENERY,
    OPTION_SCENERY_FRAMES,
    OPTION_UP,
    OPTION_FRAMES,
    OPTION_PLAN,
    OPTION_METHOD,
    OPTION_MODE,
    OPTION_START,
    OPTION_MIN_SEPARATION,
    OPTION_NO_CHECK,
    OPTION_WELD,
    OPTION_IGNORE_REST,
    OPTION_IGNORE,
    OPTION_THREADS,
    OPTION_VOLUME,
    OPTION_SIMD,
    OPTION_FAIL,
    OPTION_QUIET,
    OPTION_HELP
};

static const struct option long_options[] = {
    {"contacts", required_argument, NULL, OPTION_CONTACTS},
    {"json", required_argument, NULL, OPTION_JSON},
    {"report", required_argument, NULL, OPTION_REPORT},
    {"scenery", required_argument, NULL, OPTION_SCENERY},
    {"scenery-frames", required_argument, NULL, OPTION_SCENERY_FRAMES},
    {"up", required_argument, NULL, OPTION_UP},
    {"frames", required_argument, NULL, OPTION_FRAMES},
    {"plan", required_argument, NULL, OPTION_PLAN},
    {"method", required_argument, NULL, OPTION_METHOD},
    {"mode", required_argument, NULL, OPTION_MODE},
    {"start", required_argument, NULL, OPTION_START},
    {"min-separation", required_argument, NULL, OPTION_MIN_SEPARATION},
    {"no-check", no_argument, NULL, OPTION_NO_CHECK},
    {"weld", required_argument, NULL, OPTION_WELD},
    {"ignore-rest", no_argument, NULL, OPTION_IGNORE_REST},
    {"ignore", required_argument, NULL, OPTION_IGNORE},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"volume", required_argument, NULL, OPTION_VOLUME},
    {"simd", required_argument, NULL, OPTION_SIMD},
    {"fail-on-contact", no_argument, NULL, OPTION_FAIL},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, OPTION_HELP},
    {NULL, 0, NULL, 0},
};

static bool parse_start(const char *text, cscd_start *out) {
    static const char *const names[] = {"prove", "vouched", "unknown"};
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = (cscd_start)i;
        return true;
    }
    return false;
}

/* False when the value does not fit. */
static bool set_option(int id, const char *value, replay_options *o) {
    switch (id) {
    case OPTION_CONTACTS:
        o->contacts_path = value;
        return true;
    case OPTION_JSON:
        o->json_path = value;
        return true;
    case OPTION_REPORT:
        o->report.path = value;
        return true;
    case OPTION_SCENERY:
        o->report.scenery_path = value;
        return true;
    case OPTION_SCENERY_FRAMES:
        o->report.scenery_frames_path = value;
        return true;
    case OPTION_UP:
        return report_request_parse_up(value, &o->report.up_axis);
    case OPTION_FRAMES:
        return frame_range_parse(value, &o->frames);
    case OPTION_METHOD:
        return parse_method(value, &o->method, &o->k);
    case OPTION_PLAN:
        o->plan_path = value;
        return true;
    case OPTION_START:
        return parse_start(value, &o->start);
    case OPTION_MODE:
        return cscd_mode_from_name(value, &o->mode);
    case OPTION_MIN_SEPARATION:
        return parse_length(value, &o->min_separation);
    case OPTION_NO_CHECK:
        return o->no_check = true;
    case OPTION_WELD:
        return parse_weld(value, &o->weld, &o->weld_epsilon);
    case OPTION_IGNORE_REST:
        return o->ignore_rest = true;
    case OPTION_IGNORE:
        o->ignore_path = value;
        return true;
    case OPTION_THREADS:
        return parse_unsigned(value, &o->thread_count) && o->thread_count <= 256;
    case OPTION_VOLUME:
        return cscd_volume_from_name(value, &o->volume);
    case OPTION_SIMD:
        return cscd_simd_from_name(value, &o->simd);
    case OPTION_FAIL:
        return o->fail_on_contact = true;
    case OPTION_QUIET:
        return o->quiet = true;
    default:
        return false;
    }
}

/* Reads the options; MODEL and FRAMES are left in arguments from optind on. */
static int read_options(int argument_count, char **arguments, replay_options *o, bool *help_wanted) {
    opterr = 0;
    optind = 1;
    int id, index = 0;
    while ((id = getopt_long(argument_count, arguments, ":", long_options, &index)) != -1) {
        if (id == OPTION_HELP) {
            *help_wanted = true;
            return EXIT_RAN;
        }
        if (id == ':' || id == '?') return fail_option("replay", id, arguments);
        if (!set_option(id, optarg, o))
            return fail_usage("replay", "--%s cannot be '%s'", long_options[index].name, optarg);
    }
    return EXIT_RAN;
}

/* Outputs are not inputs, and not each other. */
static bool outputs_are_safe(const replay_options *o, const char *const *inputs, size_t input_count) {
    const char *others[] = {o->plan_path, o->ignore_path, o->contacts_path, o->json_path};
    io_error error;
    if (!output_path_is_safe(o->contacts_path, inputs, input_count, &error) ||
        !output_path_is_safe(o->contacts_path, others, 2, &error)) {
        fail_usage("replay", "--contacts %s", error.text);
        return false;
    }
    if (!output_path_is_safe(o->json_path, inputs, input_count, &error) ||
        !output_path_is_safe(o->json_path, others, 3, &error)) {
        fail_usage("replay", "--json %s", error.text);
        return false;
    }
    if (!report_request_is_safe(&o->report, inputs, input_count, &error) ||
        !report_request_is_safe(&o->report, others, 4, &error)) {
        fail_usage("replay", "%s", error.text);
        return false;
    }
    return true;
}

bool replay_options_parse(int argument_count, char **arguments, replay_options *out, int *code) {
    bool help_wanted = false;
    replay_options o = {.method = CSCD_METHOD_AUTO,
                        .mode = CSCD_MODE_ALL,
                        .frames = frame_range_all(),
                        .thread_count = 1,
                        .report.up_axis = 2,
                        .argument_count = argument_count,
                        .arguments = arguments};
    *code = read_options(argument_count, arguments, &o, &help_wanted);
    if (help_wanted) fputs(help, stdout);
    if (help_wanted || *code != EXIT_RAN) return false;
    int rest = argument_count - optind;
    if (rest < 2) *code = fail_usage("replay", rest < 1 ? "no MODEL given" : "no FRAMES given");
    if (o.contacts_path != NULL && !contact_file_names_format(o.contacts_path))
        *code = fail_usage("replay", "--contacts '%s': expected a name that ends in .csv or .jsonl",
                           o.contacts_path);
    if (*code == EXIT_RAN && o.plan_path != NULL &&
        (o.method == CSCD_METHOD_NONE || o.method == CSCD_METHOD_BRUTE))
        *code = fail_usage("replay", "--plan is of no use with --method %s", cscd_method_name(o.method));
    if (*code == EXIT_RAN && o.frames.step != 1)
        *code = fail_usage("replay",
                           "--frames with a step of %u: a contact lies between one frame and the next, so "
                           "replay takes A:B only",
                           o.frames.step);
    const char *const *inputs = (const char *const *)(arguments + optind);
    if (*code == EXIT_RAN && !outputs_are_safe(&o, inputs, (size_t)rest)) *code = EXIT_USAGE;
    if (*code != EXIT_RAN) return false;
    o.model_path = arguments[optind];
    o.frame_paths = inputs + 1;
    o.frame_path_count = (size_t)rest - 1;
    *out = o;
    return true;
}
