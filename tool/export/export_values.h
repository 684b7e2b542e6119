/* The files of exports share these: values of each vertex and triangle of a frame, as arrays with names, the
 * names of files, and the outputs of each kind. */
#pragma once

#include "tool/common/part_names.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

#include <stddef.h>
#include <stdint.h>

typedef enum export_type { EXPORT_UINT8, EXPORT_INT32, EXPORT_UINT32, EXPORT_FLOAT64 } export_type;

typedef struct export_array {
    const char *name;
    export_type type;
    void *values;
} export_array;

enum { EXPORT_ARRAYS_MAX = 16 };

typedef struct export_table {
    uint32_t count; /* of vertices or triangles */
    export_array arrays[EXPORT_ARRAYS_MAX];
    size_t array_count;
} export_table;

/* The way a triangle meets others: not; only otherwise than by crossing them; it crosses one. */
typedef enum export_meeting { EXPORT_MEETS_NONE, EXPORT_TOUCHES, EXPORT_CROSSES } export_meeting;

static inline export_meeting export_meeting_of(const cscd_intersection *pair) {
    return pair->kind == CSCD_INTERSECTION_CROSSING ? EXPORT_CROSSES : EXPORT_TOUCHES;
}

/* The share of a triangle that an object contains. */
typedef enum export_buried { EXPORT_NOT_BURIED, EXPORT_BURIED, EXPORT_CUT } export_buried;

typedef struct export_values {
    export_table vertices, triangles;
    uint32_t *kinds[5];    /* per triangle: pairs of the kind that it is in */
    uint8_t *intersecting; /* per triangle: an export_meeting */
    uint8_t *buried;       /* per triangle: an export_buried; NULL: not known */
    double *depth;         /* per vertex; NULL: not known */
    uint32_t *contacts;    /* per vertex; NULL: not counted */
} export_values;

/* The values that there are besides the pairs. */
typedef struct export_choice {
    bool contacts, depths;
} export_choice;

/* Allocates all arrays, and fills those that are the same in every frame. plan: NULL if there is none. On
 * false *out holds nothing to free. */
bool export_values_open(const recording *r, const part_names *parts, const cscd_plan *plan,
                        export_choice choice, export_values *out, io_error *error);
void export_values_free(export_values *values);

/* Counts the contacts of each vertex, those before among them, and sets the count to 0. */
void export_values_add_contacts(export_values *values, const cscd_contacts *contacts);
void export_values_clear_contacts(export_values *values);

/* Fills the others. */
void export_values_set_frame(export_values *values, const cscd_intersections *found);

size_t export_type_size(export_type type);

/* The path without that ending, if it has it; to be freed. NULL when out of memory. */
char *export_names_stem(const char *path, const char *ending);

/* STEM_0017.ply of frame 17; NULL when out of memory. To be freed. */
char *export_names_frame(const char *stem, int32_t number, const char *ending);

/* STEM and the ending behind each other. To be freed. */
char *export_names_join(const char *stem, const char *ending);

typedef struct vtk_choice {
    double fps; /* frames a second; 0: times are frame numbers */
    bool curves;
} vtk_choice;

/* Curves have files of their own, because an array of VTK says something of every cell of its file, and what
 * is said of curves and of triangles differs; in ParaView they are then an object of their own, with its own
 * width, colour and eye. */
typedef struct vtk_output {
    char *stem; /* NULL: nothing was asked for */
    vtk_choice choice;
    const recording *recording;
    const export_values *values;
    int64_t *corners, *ends; /* of all triangles */
    growable part_texts, object_texts;
    uint32_t part_count;
    growable frames; /* int32_t, the numbers of those that are written */
} vtk_output;

/* On false *out holds nothing to free. */
bool vtk_output_open(const char *path, vtk_choice choice, const recording *r, const part_names *parts,
                     const export_values *values, vtk_output *out, io_error *error);
/* curves: if they were chosen. */
bool vtk_output_add_frame(vtk_output *v, int32_t number, const double *positions, const cscd_curves *curves,
                          io_error *error);

/* Writes the .pvd files of the frames that are there. */
bool vtk_output_finish(vtk_output *v, io_error *error);
void vtk_output_free(vtk_output *v);

typedef struct ply_output {
    char *stem; /* NULL: nothing was asked for */
    const recording *recording;
    const part_names *parts;
    const export_values *values;
} ply_output;

/* No file that a frame would be written to may be a mesh that this module has not written. On false *out
 * holds nothing to free. */
bool ply_output_open(const char *path, const recording *r, const part_names *parts,
                     const export_values *values, ply_output *out, io_error *error);
bool ply_output_add_frame(const ply_output *p, int32_t number, const double *positions, io_error *error);
void ply_output_free(ply_output *p);

typedef struct selection_output {
    const char *path; /* NULL: nothing was asked for */
    recording *recording;
    const part_names *parts;
    output_file file;
    json out;
    uint8_t *now, *ever; /* per triangle: a set of what it is listed for, in this frame and in any one */
    uint32_t *listed;    /* the triangles of now, and at last of ever */
    uint32_t *numbers;   /* of one list */
} selection_output;

/* Opens the file, and writes what its numbers refer to. On false *out holds nothing to close. */
bool selection_output_open(const char *path, recording *r, const part_names *parts, selection_output *out,
                           io_error *error);
bool selection_output_add_frame(selection_output *s, int32_t number, const cscd_intersections *found,
                                io_error *error);

/* Writes the union of all frames, and puts the file in its place, if it is to be kept. */
bool selection_output_close(selection_output *s, bool kept, io_error *error);

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

/* Writes the file with its numbers as they are in memory, behind the XML: the shortest form, and every double
 * is exact. */
bool vtp_write(const vtp_file *file, const char *path, io_error *error);
