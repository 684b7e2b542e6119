/* `cscd render`: draws frames to a PNG: plain, with the contacts of their intervals, or with a plan. */
#include "tool/common/command.h"
#include "tool/common/plans.h"
#include "tool/picture/picture.h"
#include "tool/render/contact_picture.h"
#include "tool/render/plan_picture.h"
#include "tool/render/render_options.h"
#include "tool/render/strip.h"

#include <math.h>

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
