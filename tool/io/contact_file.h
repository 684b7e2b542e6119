/* Contacts as rows of a CSV file or lines of a JSON Lines file. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io_error.h"

/* A contact in terms of the mesh files' own vertices. VF: a[0] touches the triangle b. EE: the edge a[0] a[1]
 * touches the edge b[0] b[1]. */
typedef struct contact_record {
    int32_t frame; /* the interval from this frame to the next, by the name that the recording gives it */
    cscd_contact_kind kind;
    uint32_t objects[2]; /* of a and of b */
    uint32_t a[2], b[3];
    double toi, u, v;
    double point[3], normal[3];
    bool bounded;
} contact_record;

typedef struct contact_file contact_file;

/* Does the extension say a format that contact_file_open knows? */
bool contact_file_names_format(const char *path);

typedef struct contact_columns {
    bool bounded; /* each row says whether its contact is bounded; else none has a place for it */
    const char *const
        *object_names; /* each row names its two objects; NULL: none does. They outlive the file */
} contact_columns;

/* The format follows from the extension: .csv or .jsonl; "-", the standard output, is CSV. On false *out is untouched. */
bool contact_file_open(const char *path, contact_columns columns, contact_file **out, io_error *error);
bool contact_file_write(contact_file *file, const contact_record *record, io_error *error);
/* Passes everything written so far to the system. That much is kept even if the disk is full later. */
bool contact_file_flush(contact_file *file, io_error *error);
/* Puts the file in its place. False when the rest could not be written. NULL does nothing and is fine. */
bool contact_file_close(contact_file *file, io_error *error);
