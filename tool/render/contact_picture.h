/* A frame of a recording as a scene, with the contacts of its interval if they are wanted. */
#pragma once

#include "tool/common/ignore_pairs.h"
#include "tool/picture/picture.h"

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

/* Takes the mesh, in one colour. *out: zeroed but for ignored, which outlives it. Whatever this returns, contact_picture_free is due. */
bool contact_picture_load(contact_picture *out, const recording *r, io_error *error);

/* Shows a frame, with the caption that belongs to it. With contacts: those of the interval to the next frame,
 * which must be there; they take the place of any colours and markers that were there. */
bool contact_picture_show(contact_picture *picture, recording *r, uint32_t frame, bool contacts,
                          io_error *error);

/* Forgets the contacts shown. */
void contact_picture_clear(contact_picture *picture);

/* Red, green, blue of the dots of a cscd_contact_kind. */
void contact_picture_kind_colour(int kind, uint8_t rgb[3]);

/* Zooms to the contacts and their neighbourhood, a tenth of the body at least; does nothing without contacts. */
void contact_picture_focus(const contact_picture *picture, picture_options *options);

void contact_picture_free(contact_picture *picture);
