/* Pictures of recordings: the options of `cscd render`, a frame with its contacts or a plan as a scene, and
 * several frames side by side. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/options.h"
#include "tool/picture/picture.h"

/* ---- options ------------------------------------------------------------------------------------------- */

typedef enum colouring {
    COLOUR_PLAIN,
    COLOUR_CONTACTS,
    COLOUR_CHARGE,
    COLOUR_DENSITY,
    COLOUR_REGION
} colouring;

typedef struct render_options {
    recording_options source;
    const char *output_path, *plan_path;            /* NULL: not given */
    const char *scenery_path, *scenery_frames_path; /* NULL: not given */
    frame_number frame;                             /* of a single picture; not given: the first */
    bool strip;                                     /* several frames in one picture: */
    frame_range frames;
    uint32_t columns; /* 0: not given */
    bool follow;
    colouring colouring;
    bool zoom, no_text;
    picture_options picture;
    up_axis up;
    ignore_options ignored;
} render_options;

/* ---- a frame ------------------------------------------------------------------------------------------- */

typedef struct contact_picture {
    picture_scene scene; /* points into the arrays below */
    double *positions;   /* of the frame */
    uint32_t *triangles;
    uint8_t *colours; /* RGB per triangle */
    picture_marker *markers;
    char caption[160];
    uint64_t vf_count, ee_count; /* contacts shown */
    ignore_pairs *ignored;       /* pairs that are left out; NULL: none */
    cscd_detector *detector;     /* made when contacts are first wanted, with the room for an end */
    double *end;
} contact_picture;

/* Takes the mesh, in one colour. *out: zeroed except for ignored, which outlives it. Whatever this returns,
 * contact_picture_free is due. */
bool contact_picture_load(contact_picture *out, const recording *r, io_error *error);

/* Shows a frame, with the caption that belongs to it. With contacts: those of the interval to the next frame,
 * which must be there; they take the place of any colours and markers that were there. */
bool contact_picture_show(contact_picture *picture, recording *r, uint32_t frame, bool contacts,
                          io_error *error);

/* Forgets the contacts shown. */
void contact_picture_clear(contact_picture *picture);

/* Red, green, blue of the dots of a cscd_contact_kind. */
void contact_picture_kind_colour(int kind, uint8_t rgb[3]);

/* Zooms to the contacts and their neighbourhood, a tenth of the body at least; does nothing without
 * contacts. */
void contact_picture_focus(const contact_picture *picture, picture_options *options);

void contact_picture_free(contact_picture *picture);

/* ---- plans --------------------------------------------------------------------------------------------- */

enum { PLAN_LEGEND_REGIONS = 10, PLAN_LEGEND_LINES = PLAN_LEGEND_REGIONS + 2 };

typedef struct plan_legend {
    picture_legend lines[PLAN_LEGEND_LINES];
    char texts[PLAN_LEGEND_LINES][40];
} plan_legend;

/* Colours a loaded picture by CHARGE, DENSITY or REGION, and writes its caption and legend, which must live
 * until the picture is drawn. */
bool plan_picture_paint(contact_picture *picture, plan_legend *legend, const recording *r,
                        const cscd_plan *plan, colouring by, io_error *error);

/* Adds a dot at each detector point, for the mesh at rest. Call it after plan_picture_paint. */
bool plan_picture_mark(contact_picture *picture, plan_legend *legend, const cscd_plan *plan, io_error *error);

/* ---- several frames ------------------------------------------------------------------------------------ */

/* picture: loaded, and painted unless contacts are wanted. beside: NULL for none. Writes the file of the
 * options. */
bool strip_draw(const render_options *options, recording *r, contact_picture *picture,
                picture_scenery *beside, io_error *error);
