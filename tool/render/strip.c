/* Several frames of a recording side by side in one picture. */
#include "tool/render/render.h"

#include "tool/picture/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct strip {
    const render_options *options;
    recording *recording;
    contact_picture *picture;
    picture_scenery *beside; /* or NULL */
    frame_choice frames;
    uint32_t count;
    picture_camera camera; /* following: of a body whose middle is the origin */
    picture_sheet sheet;
} strip;

/* The middle of the body's box if the camera follows it, else the origin. */
static void find_middle(const strip *s, double out[3]) {
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < s->picture->scene.vertex_count; v++) {
            low = fmin(low, s->picture->positions[(size_t)v * 3 + (size_t)k]);
            high = fmax(high, s->picture->positions[(size_t)v * 3 + (size_t)k]);
        }
        out[k] = s->options->follow ? 0.5 * (low + high) : 0.0;
    }
}

static uint32_t frame_of(const strip *s, uint32_t tile) {
    return s->frames.first + tile * s->frames.step;
}

/* Places the camera so that it holds all frames that are drawn, each seen from its middle. */
static bool place_camera(strip *s, io_error *error) {
    const picture_options *o = &s->options->picture;
    const size_t each = PICTURE_OUTERMOST;
    double(*points)[3] = malloc(s->count * each * sizeof *points);
    if (points == NULL) return io_fail(error, "out of memory");
    bool read = true;
    for (uint32_t tile = 0; tile < s->count && read; tile++) {
        double middle[3];
        read = contact_picture_show(s->picture, s->recording, frame_of(s, tile), false, error);
        if (!read) break;
        find_middle(s, middle);
        picture_camera_outermost(s->picture->positions, s->picture->scene.vertex_count, o->azimuth,
                                 o->elevation, o->y_up, o->width, o->height, points + tile * each);
        for (size_t i = 0; i < each; i++)
            for (int k = 0; k < 3; k++) points[tile * each + i][k] -= middle[k];
    }
    if (read)
        picture_camera_frame(points[0], s->count * each, o->azimuth, o->elevation, o->y_up, o->width,
                             o->height, &s->camera);
    free(points);
    return read;
}

enum { LABEL_LINES = 2 };

/* A strip is often looked at smaller than it is. */
static const double label_scale = 1.5;

/* The frame's number, and below it how many contacts of a kind there are, with the colour of their dots. */
static void label_tile(contact_picture *picture, int32_t frame, picture_legend lines[LABEL_LINES],
                       char texts[LABEL_LINES][32]) {
    const uint64_t counts[LABEL_LINES] = {picture->vf_count, picture->ee_count};
    const char *const names[LABEL_LINES] = {"VF", "EE"};
    size_t used = 0;
    for (int kind = 0; kind < LABEL_LINES; kind++) {
        if (counts[kind] == 0) continue;
        snprintf(texts[used], sizeof texts[used], "%llu %s", (unsigned long long)counts[kind], names[kind]);
        contact_picture_kind_colour(kind, lines[used].colour);
        lines[used].text = texts[used];
        used++;
    }
    snprintf(picture->caption, sizeof picture->caption, "%d", frame);
    picture->scene.legend = lines;
    picture->scene.legend_count = used;
}

static bool draw_tile(strip *s, uint32_t tile, io_error *error) {
    uint32_t frame = frame_of(s, tile);
    bool contacts = s->options->colouring == COLOUR_CONTACTS;
    if (contacts) contact_picture_clear(s->picture);
    contacts = contacts && frame + 1 < s->recording->frame_count;
    if (!contact_picture_show(s->picture, s->recording, frame, contacts, error) ||
        (s->beside != NULL && !picture_scenery_read(s->beside, frame, error)))
        return false;
    picture_legend lines[LABEL_LINES];
    char texts[LABEL_LINES][32];
    label_tile(s->picture, s->recording->frame_numbers[frame], lines, texts);
    picture_options options = s->options->picture;
    picture_camera camera = s->camera;
    double middle[3];
    find_middle(s, middle);
    for (int k = 0; k < 3; k++) camera.eye[k] += middle[k];
    options.camera = &camera;
    options.text_scale = s->options->no_text ? 0.0 : label_scale;
    picture_image image;
    bool drawn = picture_render_image(&s->picture->scene, &options, &image, error);
    s->picture->scene.legend_count = 0; /* its lines end here */
    if (!drawn) return false;
    picture_sheet_place(&s->sheet, tile, &image);
    picture_image_free(&image);
    return true;
}

static uint32_t default_columns(uint32_t count) {
    uint32_t columns = (uint32_t)ceil(sqrt(count));
    return columns > 0 ? columns : 1;
}

bool strip_draw(const render_options *options, recording *r, contact_picture *picture,
                picture_scenery *beside, io_error *error) {
    strip s = {.options = options, .recording = r, .picture = picture, .beside = beside};
    if (!frame_range_choose(&options->frames, r->frame_numbers, r->frame_count, &s.frames, error))
        return false;
    s.count = frame_choice_count(&s.frames);
    uint32_t columns = options->columns > 0 ? options->columns : default_columns(s.count);
    if (columns > s.count) columns = s.count;
    if (!picture_sheet_create(s.count, columns, options->picture.width, options->picture.height, &s.sheet,
                              error))
        return false;
    bool drawn = place_camera(&s, error);
    for (uint32_t tile = 0; tile < s.count && drawn; tile++) drawn = draw_tile(&s, tile, error);
    drawn = drawn && picture_image_write_png(options->output_path, &s.sheet.image, error);
    picture_image_free(&s.sheet.image);
    return drawn;
}
