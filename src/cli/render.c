/* `cscd render`: draws a frame to a PNG: plain, with the contacts of its interval, or with a plan. */
#include "src/cli/command.h"
#include "src/cli/contact_picture.h"
#include "src/cli/output_path.h"
#include "src/cli/plan_choice.h"
#include "src/cli/plan_picture.h"
#include "src/cli/replay_options.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char help[] =
    "usage: cscd render MODEL [FRAMES...] -o OUT.png [options]\n"
    "\n"
    "Draws one frame with perspective and light. FRAMES as for replay; without them the model itself.\n"
    "\n"
    "  --frame K              which frame (default 0)\n"
    "  --colour plain         one colour (default)\n"
    "  --colour contacts      the contacts of the interval from frame K to K + 1 on the surface at its "
    "start:\n"
    "                         the triangles that contain a touching feature, and a dot at each contact\n"
    "  --colour charge        charge density by rank, dark the least\n"
    "  --colour region        the regions of the plan; without FRAMES a dot at each detector point\n"
    "  --plan PLAN.ply        which plan (default as for replay: MODEL.plan.ply, or made on the way)\n"
    "  --size WxH             pixels (default 1280x960)\n"
    "  --view AZ,EL           camera: degrees around the vertical axis, degrees above the horizon\n"
    "  --zoom                 with contacts: only the neighbourhood of the contacts\n"
    "  --up y|z               which axis points up (default z)\n"
    "  --wire                 draw the triangles' edges\n"
    "  --weld exact|EPS       join vertices that coincide, or lie within EPS, in the first frame\n";

typedef enum colouring { COLOUR_PLAIN, COLOUR_CONTACTS, COLOUR_CHARGE, COLOUR_REGION } colouring;

typedef struct render_options {
    recording_options source;
    const char *output_path, *plan_path;
    uint32_t frame;
    colouring colouring;
    bool zoom;
    picture_options picture;
} render_options;

static bool load(const render_options *o, recording *r, contact_picture *picture, io_error *error) {
    bool contacts = o->colouring == COLOUR_CONTACTS;
    uint32_t needed = contacts ? o->frame + 1 : o->frame;
    if (needed >= r->frame_count)
        return io_fail(error, "--frame %u%s: there are the frames 0 to %u", o->frame,
                       contacts ? " with its contacts needs the next one" : "", r->frame_count - 1);
    return contact_picture_load(picture, r, o->frame, contacts, error);
}

/* Charge wants a plan that has some; without FRAMES the mesh is at rest, where the detector points belong. */
static bool paint_plan(const render_options *o, const recording *r, contact_picture *picture,
                       plan_legend *legend, io_error *error) {
    bool by_charge = o->colouring == COLOUR_CHARGE, at_rest = o->source.frame_path_count == 0;
    plan_request request = {.model_path = o->source.model_path,
                            .plan_path = o->plan_path,
                            .method = by_charge ? CSCD_METHOD_CHARGE : CSCD_METHOD_PUBLISHED};
    plan_choice choice;
    if (!plan_choose(&request, r, &choice, error)) return false;
    bool painted = plan_picture_paint(picture, legend, r, choice.plan, by_charge, error) &&
                   (by_charge || !at_rest || plan_picture_mark(picture, legend, choice.plan, error));
    plan_choice_free(&choice);
    return painted;
}

static int draw(const render_options *o) {
    recording r;
    contact_picture picture = {0};
    plan_legend legend;
    picture_options options = o->picture;
    io_error error = {""};
    if (!recording_open(&o->source, &r, &error)) return fail_input("%s", error.text);
    bool drawn = load(o, &r, &picture, &error);
    if (o->colouring == COLOUR_CHARGE || o->colouring == COLOUR_REGION)
        drawn = drawn && paint_plan(o, &r, &picture, &legend, &error);
    if (drawn) {
        if (o->zoom) contact_picture_focus(&picture, &options);
        drawn = picture_render(&picture.scene, &options, o->output_path, &error);
    }
    contact_picture_free(&picture);
    recording_close(&r);
    return drawn ? EXIT_RAN : fail_input("%s", error.text);
}

static bool parse_colour(const char *text, render_options *o) {
    static const char *const names[] = {"plain", "contacts", "charge", "region"};
    for (int i = 0; i < 4; i++) {
        if (strcmp(text, names[i]) != 0) continue;
        o->colouring = (colouring)i;
        return true;
    }
    return false;
}

static bool parse_size(const char *text, picture_options *picture) {
    char end = '\0';
    return sscanf(text, "%5ux%5u%c", &picture->width, &picture->height, &end) == 2 && picture->width >= 16 &&
           picture->height >= 16 && picture->width <= 8192 && picture->height <= 8192;
}

static bool parse_view(const char *text, picture_options *picture) {
    char end = '\0';
    return sscanf(text, "%lf,%lf%c", &picture->azimuth, &picture->elevation, &end) == 2 &&
           picture->elevation >= -90.0 && picture->elevation <= 90.0 && picture->azimuth >= -1e6 &&
           picture->azimuth <= 1e6;
}

static bool parse_up(const char *text, picture_options *picture) {
    picture->y_up = strcmp(text, "y") == 0;
    return picture->y_up || strcmp(text, "z") == 0;
}

static bool set_option(int id, const char *value, render_options *o) {
    switch (id) {
    case 'o':
        o->output_path = value;
        return true;
    case 'f':
        return parse_unsigned(value, &o->frame);
    case 'c':
        return parse_colour(value, o);
    case 'p':
        o->plan_path = value;
        return true;
    case 's':
        return parse_size(value, &o->picture);
    case 'v':
        return parse_view(value, &o->picture);
    case 'z':
        return o->zoom = true;
    case 'u':
        return parse_up(value, &o->picture);
    case 'e':
        return o->picture.wire = true;
    case 'w':
        return parse_weld(value, &o->source.weld, &o->source.weld_epsilon);
    default:
        return false;
    }
}

int command_render(int argument_count, char **arguments) {
    static const struct option long_options[] = {{"output", required_argument, NULL, 'o'},
                                                 {"frame", required_argument, NULL, 'f'},
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
    render_options options = {.source = {.thread_count = 1}, .picture = picture_options_defaults()};
    opterr = 0;
    optind = 1;
    for (int id, index = 0;
         (id = getopt_long(argument_count, arguments, ":o:", long_options, &index)) != -1;) {
        if (id == 'h') {
            fputs(help, stdout);
            return EXIT_RAN;
        }
        if (id == ':' || id == '?') return fail_option("render", id, arguments);
        if (!set_option(id, optarg, &options))
            return fail_usage("render", "--%s cannot be '%s'", long_options[index].name, optarg);
    }
    if (argument_count - optind < 1) return fail_usage("render", "no MODEL given");
    if (options.output_path == NULL) return fail_usage("render", "no -o OUT.png given");
    const char *const *inputs = (const char *const *)(arguments + optind);
    io_error error;
    if (!output_path_is_safe(options.output_path, inputs, (size_t)(argument_count - optind), &error) ||
        !output_path_differs(options.output_path, &options.plan_path, 1, &error))
        return fail_usage("render", "-o %s", error.text);
    options.source.model_path = inputs[0];
    options.source.frame_paths = inputs + 1;
    options.source.frame_path_count = (size_t)(argument_count - optind - 1);
    return draw(&options);
}
