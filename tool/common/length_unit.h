/* Units of length: what one unit of a recording's coordinates is, and lengths as people write and read them. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>

typedef struct length_unit {
    const char *name; /* "mm"; NULL: nobody knows */
    double metres;    /* of one of them */
} length_unit;

/* um, mm, cm, dm, m, km, in, ft; false, and *out untouched, for another text. */
bool length_unit_from_name(const char *text, length_unit *out);

/* A length of the command line: `2mm`, or `2`, which is in the files' unit. */
typedef struct length_given {
    bool given;
    double value;
    length_unit unit; /* its name is NULL: that of the files */
} length_given;

/* False for a text that is no length, or a negative one. */
bool length_given_parse(const char *text, length_given *out);

/* The length in the unit of the files. The error says that nobody knows what that is. */
bool length_given_convert(const length_given *length, const length_unit *files, double *out, io_error *error);

enum { LENGTH_TEXT_SIZE = 40 };

/* A length of the files for people, three digits of it: "12.4 mm", or "0.0124" where nobody knows the unit. Metric lengths are
 * given in um, mm, m or km, whichever suits. Returns the text. */
const char *length_text(double length, const length_unit *files, char text[LENGTH_TEXT_SIZE]);
