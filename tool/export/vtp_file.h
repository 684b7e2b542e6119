/* One .vtp file: polygons or lines with arrays, as VTK's XML format for ParaView has them. */
#pragma once

#include "tool/io/io_error.h"

#include <stddef.h>
#include <stdint.h>

typedef enum vtp_section {
    VTP_FIELD,
    VTP_POINT_DATA,
    VTP_CELL_DATA,
    VTP_POINTS,
    VTP_LINES,
    VTP_POLYS,
    VTP_SECTIONS
} vtp_section;

typedef enum vtp_type {
    VTP_UINT8,
    VTP_INT32,
    VTP_UINT32,
    VTP_INT64,
    VTP_FLOAT64,
    VTP_STRING /* texts, each with its NUL */
} vtp_type;

enum { VTP_ARRAYS_MAX = 40 };

typedef struct vtp_array {
    vtp_section section;
    vtp_type type;
    const char *name; /* as it may stand in XML */
    uint64_t tuples, components;
    const void *data;
    uint64_t size; /* bytes */
} vtp_array;

typedef struct vtp_file {
    uint64_t point_count, line_count, poly_count;
    vtp_array arrays[VTP_ARRAYS_MAX];
    size_t array_count;
} vtp_file;

/* Data must live until the file is written. */
void vtp_add(vtp_file *file, vtp_section section, const char *name, vtp_type type, uint64_t tuples,
             uint64_t components, const void *data);

/* count texts behind each other, each with its NUL. */
void vtp_add_texts(vtp_file *file, const char *name, uint64_t count, const char *texts, size_t size);

/* Writes the file with its numbers as they are in memory, behind the XML: the shortest form, and every double is exact. */
bool vtp_write(const vtp_file *file, const char *path, io_error *error);
