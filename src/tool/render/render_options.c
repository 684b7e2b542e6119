/* The options of `cscd render`. */
#include "src/tool/render/render_options.h"

#include "src/tool/common/command.h"
#include "src/tool/common/option_values.h"
#include "src/tool/common/output_path.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

static const char help[] =
    "usage: cscd render MODEL [FRAMES...] -o OUT.png [options]\n"
    "\n"
    "Draws a frame, or several side by side, with perspective and light. FRAMES as for replay; without them\n"
    "the model itself.\n"
    "\n"
    "  --frame K              one frame (default 0)\n"
    "  --frames A:B[:STEP]    a strip: the frames A to B, both included, or every STEP-th of them (A: and "
    ":B\n"
    "                         are open ends), each as a tile with its number in the corner; one camera for\n"
    "                         all of them that holds the whole motion\n"
    "  --columns N            tiles in a row (default: as many as there are rows, or one more)\n"
    "  --follow               move the camera with the body, which stays in the middle of its tile\n"
    "  --scenery MODEL        another mesh beside the body (ground, stairs, a ball): only drawn, where it "
    "is\n"
    "                         in view, and never tested\n"
    "  --scenery-frames FRAMES  how it moves: a point cache or a pattern, of as many frames, or of one\n"
    "  --colour plain         one colour (default)\n"
    "  --colour contacts      the contacts of the interval from frame K to K + 1 on the surface at its "
    "start:\n"
    "                         the triangles that contain a touching feature, and a dot at each contact\n"
    "  --colour charge        charge density by rank, dark the least\n"
    "  --colour region        the regions of the plan; without FRAMES a dot at each detector point\n"
    "  --plan PLAN.ply        which plan (default as for replay: MODEL.plan.ply, or made on the way)\n"
    "  --size WxH             pixels (default 1280x960), of one tile of a strip (default 400x300)\n"
    "  --view AZ,EL           camera: degrees around the vertical axis, degrees above the horizon\n"
    "  --zoom                 with contacts: only the neighbourhood of the contacts\n"
    "  --up y|z               which axis points up (default z)\n"
    "  --wire                 draw the triangles' edges\n"
    "  --weld exact|EPS       join vertices that coincide, or lie within EPS, in the first frame\n";

static const struct option long_options[] = {{"output", required_argument, NULL, 'o'},
                                             {"frame", required_argument, NULL, 'f'},
                                             {"frames", required_argument, NULL, 'F'},
                                             {"columns", required_argument, NULL, 'n'},
                                             {"follow", no_argument, NULL, 'l'},
                                             {"scenery", required_argument, NULL, 'g'},
                                             {"scenery-frames", required_argument, NULL, 'G'},
                                             {"colour", required_argument, NULL, 'c'},
                                             {"color", required_argument, NULL, 'c'},
                                             {"plan", required_argument, NULL, 'p'},
                                             {"size", required_argument, NULL, 's'},
                                             {"view", required_argument, NULL, 'v'},
                                             {"zoom", no_argument, NULL, 'z'},
                                             {"up", required_argument, NULL, 'u'},
                                             {"wire", no_argument, NULL, 'e'},
                                             {"weld", required_argument, NULL, 'w'},
                                             {"help", no_argument, NULL, 'h'},
                                             {NULL, 0, NULL, 0}};

static bool parse_colour(const char *text, colouring *out) {
    static const char *const names[] = {"plain", "contacts", "charge", "region"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(text, names[i]) != 0) continue;
        *out = (colouring)i;
        return true;
    }
    return false;
}

/* Which options were given where their values do not say it. */
typedef struct given_options {
    bool frame, size, help;
} given_options;

static bool set_option(int id, const char *value, render_options *o, given_options *given) {
    switch (id) {
    case 'h':
        return given->help = true;
    case 'o':
        o->output_path = value;
        return true;
    case 'f':
        given->frame = true;
        return parse_unsigned(value, &o->frame);
    case 'F':
        o->strip = true;
        return frame_range_parse(value, &o->frames);
    case 'n':
        return parse_unsigned(value, &o->columns) && o->columns > 0;
    case 'l':
        return o->follow = true;
    case 'g':
        o->scenery_path = value;
        return true;
    case 'G':
        o->scenery_frames_path = value;
        return true;
    case 'c':
        return parse_colour(value, &o->colouring);
    case 'p':
        o->plan_path = value;
        return true;
    case 's':
        given->size = true;
        return parse_picture_size(value, &o->picture);
    case 'v':
        return parse_picture_view(value, &o->picture);
    case 'z':
        return o->zoom = true;
    case 'u':
        return parse_picture_up(value, &o->picture);
    case 'e':
        return o->picture.wire = true;
    case 'w':
        return parse_weld(value, &o->source.weld, &o->source.weld_epsilon);
    default:
        return false;
    }
}

static int read_options(int argument_count, char **arguments, render_options *o, given_options *given) {
    opterr = 0;
    optind = 1;
    for (int id, index = 0;
         !given->help && (id = getopt_long(argument_count, arguments, ":o:", long_options, &index)) != -1;) {
        if (id == ':' || id == '?') return fail_option("render", id, arguments);
        if (!set_option(id, optarg, o, given))
            return fail_usage("render", "--%s cannot be '%s'", long_options[index].name, optarg);
    }
    return EXIT_RAN;
}

/* What does not go together. */
static int check_options(const render_options *o, const given_options *given) {
    if (o->strip && given->frame)
        return fail_usage("render", "--frame and --frames: give one of them, a single picture or a strip");
    if (o->columns > 0 && !o->strip)
        return fail_usage("render", "--columns is for a strip; say which frames with --frames A:B[:STEP]");
    if (o->follow && !o->strip)
        return fail_usage("render", "--follow is for a strip; say which frames with --frames A:B[:STEP]");
    if (o->strip && o->zoom)
        return fail_usage("render", "--zoom is for a single picture; give --frame K instead of --frames");
    if (o->scenery_frames_path != NULL && o->scenery_path == NULL)
        return fail_usage("render", "--scenery-frames moves the mesh of --scenery MODEL, which is missing");
    return EXIT_RAN;
}

static int check_paths(const render_options *o, const char *const *inputs, size_t input_count) {
    const char *others[] = {o->plan_path, o->scenery_path, o->scenery_frames_path};
    io_error error;
    if (!output_path_is_safe(o->output_path, inputs, input_count, &error) ||
        !output_path_differs(o->output_path, others, 3, &error))
        return fail_usage("render", "-o %s", error.text);
    return EXIT_RAN;
}

bool render_options_parse(int argument_count, char **arguments, render_options *out, int *code) {
    given_options given = {0};
    render_options o = {.source = {.thread_count = 1}, .picture = picture_options_defaults()};
    *code = read_options(argument_count, arguments, &o, &given);
    if (given.help) fputs(help, stdout);
    if (given.help || *code != EXIT_RAN) return false;
    const char *const *inputs = (const char *const *)(arguments + optind);
    if (argument_count - optind < 1)
        *code = fail_usage("render", "no MODEL given");
    else if (o.output_path == NULL)
        *code = fail_usage("render", "no -o OUT.png given");
    if (*code == EXIT_RAN) *code = check_options(&o, &given);
    if (*code == EXIT_RAN) *code = check_paths(&o, inputs, (size_t)(argument_count - optind));
    if (*code != EXIT_RAN) return false;
    if (o.strip && !given.size) o.picture.width = 400, o.picture.height = 300;
    o.source.model_path = inputs[0];
    o.source.frame_paths = inputs + 1;
    o.source.frame_path_count = (size_t)(argument_count - optind - 1);
    *out = o;
    return true;
}
