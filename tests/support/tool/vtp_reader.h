/* Reads the .vtp files that the tool writes: binary data behind the XML. */
#pragma once

#include <stddef.h>

typedef struct vtp_reader {
    char *bytes;
    size_t size;
    const char *data; /* behind the mark where the arrays begin */
} vtp_reader;

/* All functions fail the test when the file has something else. */
vtp_reader vtp_reader_open(const char *path);
void vtp_reader_close(vtp_reader *reader);

/* NumberOfPoints and the like. */
size_t vtp_reader_count(const vtp_reader *reader, const char *attribute);

/* Has the section (PointData) that array? */
int vtp_reader_has(const vtp_reader *reader, const char *section, const char *name);

/* The data of an array, which must have the type; size: bytes. They are as aligned as malloc's; to be freed. */
void *vtp_reader_array(const vtp_reader *reader, const char *section, const char *name, const char *type,
                       size_t *size);
