/* Values of options that more than one command has. */
#pragma once

#include "cscd/cscd.h"
#include "src/tool/picture/scene.h"

/* --weld exact|EPS */
bool parse_weld(const char *text, bool *weld, double *epsilon);

/* --method NAME|kmeans:K. Without a K, *k stays as it is. */
bool parse_method(const char *text, cscd_method *method, uint32_t *k);

/* A length that the library takes: 0, or from 2^-300 to 2^300. */
bool parse_length(const char *text, double *out);

/* --size WxH, --view AZ,EL and --up y|z of a picture. */
bool parse_picture_size(const char *text, picture_options *picture);
bool parse_picture_view(const char *text, picture_options *picture);
bool parse_picture_up(const char *text, picture_options *picture);
