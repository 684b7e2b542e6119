/* GIFTI files of a square, in every way that the format has; used inside cmocka tests. */
#pragma once

#include "tests/support/io/mesh_check.h"

#include <stdbool.h>

/* How the arrays are written. */
typedef struct gifti_style {
    int encoding; /* 0: ASCII, 1: Base64Binary, 2: GZipBase64Binary */
    bool big_endian, column_major, doubles;
    bool gzip_header; /* zipped data with the header of gzip, not of zlib */
} gifti_style;

typedef struct gifti_text {
    char text[8192];
} gifti_text;

/* The square of mesh_check_square, behind metadata, transforms, a second set of points and labels. */
void gifti_fixture_square(gifti_text *file, gifti_style style);

file_bytes gifti_fixture_file(const gifti_text *file);
