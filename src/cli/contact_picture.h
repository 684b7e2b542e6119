/* One frame of a recording as a scene, the contacts of its interval marked when wanted. */
#ifndef CSCD_CONTACT_PICTURE_H
#define CSCD_CONTACT_PICTURE_H

#include "src/cli/recording.h"
#include "src/picture/scene.h"

typedef struct contact_picture {
    picture_scene scene; /* points into the arrays below */
    double *positions;   /* of the frame */
    uint32_t *triangles;
    uint8_t *colours; /* RGB per triangle */
    picture_marker *markers;
    char caption[160];
} contact_picture;

/* *out: zeroed. Whatever this returns, contact_picture_free is due. */
bool contact_picture_load(contact_picture *out, recording *r, uint32_t frame, bool contacts, io_error *error);

/* Zooms to the contacts and their neighbourhood; does nothing without contacts. */
void contact_picture_focus(const contact_picture *picture, picture_options *options);

void contact_picture_free(contact_picture *picture);

#endif
