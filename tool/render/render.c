/* `cscd render`: draws frames to a PNG: plain, with the contacts of their intervals, or with a plan. */
#include "tool/render/render.h"

#include "tool/common/command.h"
#include "tool/common/options.h"
#include "tool/common/plans.h"
#include "tool/picture/picture.h"

#include <math.h>

/* ---- options ------------------------------------------------------------------------------------------- */

static bool read_colour(const char *text, void *place) {
    int colour;
    if (!parse_choice(text, (const char *const[]){"plain", "contacts", "charge", "density", "region"}, 5,
                      &colour))
        return false;
    *(colouring *)place = (colouring)colour;
    return true;
}

static const option_row rows[] = {
    {"o", "OUT.png", read_output_path, offsetof(render_options, output_path), NULL},
    {"output", "OUT.png", read_output_path, offsetof(render_options, output_path), NULL},
    {"frame", "K", read_frame_number, offsetof(render_options, frame), "one frame (default: the first)"},
    {"frames", "A:B[:STEP]", read_frames, offsetof(render_options, frames),
     "as a strip, the frames A to B, both included, or every STEP-th of them (A: and :B are open ends), each as "
     "a tile with its number in the corner; one camera for all of them that holds the whole motion"},
    {"columns", "N", read_positive, offsetof(render_options, columns),
     "tiles in a row (default: as many as there are rows, or one more)"},
    {"follow", NULL, read_flag, offsetof(render_options, follow),
     "move the camera with the body, which stays in the middle of its tile"},
    {"scenery", "MODEL", read_input_path, offsetof(render_options, scenery_path),
     "another mesh beside the body (ground, stairs, a ball): only drawn, where it is in view, and never tested"},
    {"scenery-frames", "FRAMES", read_input_path, offsetof(render_options, scenery_frames_path),
     "how it moves: a point cache or a pattern, of as many frames, or of one"},
    {"colour", "plain", read_colour, offsetof(render_options, colouring), "one colour (default)"},
    {"color", "plain", read_colour, offsetof(render_options, colouring), NULL},
    {"colour", "contacts",
     .help =
         "the contacts of the interval from frame K to K + 1 on the surface at its start: the triangles that "
         "contain a feature in contact, and a dot at each contact"},
    {"colour", "charge", .help = "charge density by rank, dark the least"},
    {"colour", "density", .help = "charge density from the least to the most of each component"},
    {"colour", "region", .help = "the regions of the plan; of a mesh at rest a dot at each detector point"},
    {"plan", "PLAN.ply", read_input_path, offsetof(render_options, plan_path),
     "which plan (default as for replay: MODEL.plan.ply, or made on the way)"},
    {"size", "WxH", read_picture_size, offsetof(render_options, picture),
     "pixels (default 1280x960), of one tile of a strip (default 400x300)"},
    {"view", "AZ,EL", read_picture_view, offsetof(render_options, picture),
     "camera: degrees around the vertical axis, degrees above the horizon"},
    {"zoom", NULL, read_flag, offsetof(render_options, zoom),
     "with contacts: only the neighbourhood of the contacts"},
    {"up", "y|z", read_up, offsetof(render_options, up),
     "which axis points up (default: y of OBJ and glTF, else z)"},
    {"wire", NULL, read_flag, offsetof(render_options, picture.wire), "draw the triangles' edges"},
    {"no-text", NULL, read_flag, offsetof(render_options, no_text),
     "leave out the lines of text in the corner"},
};

static const option_table table = {
    "render",
    "MODEL [FRAMES...] -o OUT.png [options]",
    "Draws a frame, or several side by side, with perspective and light. FRAMES as for replay; without them "
    "the animation that MODEL holds, or MODEL itself.",
    rows,
    sizeof rows / sizeof *rows,
    .shared = {{&object_rows, offsetof(render_options, source)},
               {&frame_rows, offsetof(render_options, source)},
               {&pair_rows, offsetof(render_options, ignored)}},
    .examples = {{"render body.obj body.pc2 --frame 84 --colour contacts -o contacts.png",
                  "Draw frame 84, with its contacts up to the next frame."},
                 {"render body.obj body.pc2 --frames 0:140:10 --columns 5 -o strip.png",
                  "Draw every tenth frame as a tile of one picture."},
                 {"render body.obj --colour region -o regions.png",
                  "Draw the regions of the plan, with a dot at each detector point."}}};

/* Options that contradict each other. */
static int check_options(const render_options *o, const given_options *given) {
    if (o->strip && option_given(&table, given, "frame"))
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

/* False: *code is the exit code to end with (0 after --help). */
static bool render_options_parse(int argument_count, char **arguments, render_options *out, int *code) {
    render_options o = {.picture = picture_options_defaults()};
    given_options given;
    io_error error;
    if (!option_table_read(&table, argument_count, arguments, &o, &given, code)) return false;
    o.strip = option_given(&table, &given, "frames");
    if (given.input_count < 1 && o.source.objects.count == 0)
        *code = fail_usage("render", "no MODEL given");
    else if (o.output_path == NULL)
        *code = fail_usage("render", "no -o OUT.png given");
    if (*code == EXIT_RAN) *code = check_options(&o, &given);
    if (*code == EXIT_RAN && !output_paths_are_safe(&table, &o, &given, &error))
        *code = fail_usage("render", "%s", error.text);
    if (*code != EXIT_RAN) return false;
    if (o.strip && !option_given(&table, &given, "size")) {
        o.picture.width = 400;
        o.picture.height = 300;
    }
    recording_options_take(&o.source, &given);
    o.picture.y_up = up_axis_choose(o.up, recording_options_path(&o.source)) == UP_Y;
    *out = o;
    return true;
}

/* ---- the command --------------------------------------------------------------------------------------- */

/* To draw charge, the plan must have some. Detector points belong to the mesh at rest, which is drawn
 * without FRAMES. */
static bool paint_plan(const render_options *o, const recording *r, contact_picture *picture,
                       plan_legend *legend, io_error *error) {
    const bool by_charge = o->colouring == COLOUR_CHARGE || o->colouring == COLOUR_DENSITY,
               at_rest = !recording_moves(r);
    if (!by_charge && o->colouring != COLOUR_REGION) return true;
    plan_request request = {.model_path = recording_options_path(&o->source),
                            .plan_path = o->plan_path,
                            .method = by_charge ? CSCD_METHOD_CHARGE : CSCD_METHOD_AUTO,
                            .insists_on_plan = true};
    plan_choice choice;
    if (!plan_choose(&request, r, &choice, error)) return false;
    bool painted = plan_picture_paint(picture, legend, r, choice.plan, o->colouring, error) &&
                   (by_charge || !at_rest || plan_picture_mark(picture, legend, choice.plan, error));
    plan_choice_free(&choice);
    return painted;
}

static bool draw_frame(const render_options *o, recording *r, contact_picture *picture,
                       picture_scenery *beside, io_error *error) {
    bool contacts = o->colouring == COLOUR_CONTACTS;
    uint32_t frame = 0;
    if (o->frame.given && !frame_range_find(o->frame.value, r->frame_numbers, r->frame_count, &frame, error))
        return false;
    if (contacts && frame + 1 >= r->frame_count)
        return io_fail(error, "--frame %d with its contacts needs the next one, and it is the last",
                       r->frame_numbers[frame]);
    plan_legend legend;
    if (!contact_picture_show(picture, r, frame, contacts, error) ||
        (beside != NULL && !picture_scenery_read(beside, frame, error)) ||
        !paint_plan(o, r, picture, &legend, error))
        return false;
    picture_options options = o->picture;
    if (o->no_text) options.text_scale = 0.0;
    if (o->zoom) contact_picture_focus(picture, &options);
    return picture_render(&picture->scene, &options, o->output_path, error);
}

static bool draw_strip(const render_options *o, recording *r, contact_picture *picture,
                       picture_scenery *beside, io_error *error) {
    plan_legend legend;
    return paint_plan(o, r, picture, &legend, error) && strip_draw(o, r, picture, beside, error);
}

/* A round length, about a quarter of the model at rest, so that it is the same for all its frames. */
static double square_side(const recording *r) {
    double extent = 0.0;
    const double *first = r->objects[0].file.positions;
    for (uint32_t i = 0; i < r->object_count; i++) {
        const mesh_file *file = &r->objects[i].file;
        for (size_t k = 0; k < (size_t)file->vertex_count * 3; k++)
            extent = fmax(extent, fabs(file->positions[k] - first[k % 3]));
    }
    if (!(extent > 0.0)) return 0.0;
    double power = pow(10.0, floor(log10(0.25 * extent))), share = 0.25 * extent / power;
    return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

static bool draw_picture(render_options *o, recording *r, io_error *error) {
    ignore_pairs ignored;
    if (!ignore_pairs_prepare(&o->ignored, r, &ignored, error)) return false;
    contact_picture picture = {.ignored = &ignored};
    picture_scenery other = {0};
    picture_scenery *beside = o->scenery_path != NULL ? &other : NULL;
    o->picture.square = square_side(r);
    bool drawn = (beside == NULL || picture_scenery_open(o->scenery_path, o->scenery_frames_path,
                                                         r->frame_count, beside, error)) &&
                 contact_picture_load(&picture, r, error);
    if (beside != NULL) picture.scene.scenery = &beside->mesh;
    drawn = drawn && (o->strip ? draw_strip : draw_frame)(o, r, &picture, beside, error);
    contact_picture_free(&picture);
    ignore_pairs_free(&ignored);
    picture_scenery_close(&other);
    return drawn;
}

int command_render(int argument_count, char **arguments) {
    render_options options;
    recording r;
    io_error error = {""};
    int code;
    if (!render_options_parse(argument_count, arguments, &options, &code)) return code;
    options.source.plays_models = true;
    if (!recording_open(&options.source, &r, &error)) return fail_input("%s", error.text);
    bool drawn = draw_picture(&options, &r, &error);
    recording_close(&r);
    return drawn ? EXIT_RAN : fail_input("%s", error.text);
}
