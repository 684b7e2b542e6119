/* PLY files: the header, with encoding, elements and properties, and the rows, value by value; and plans in
 * such files. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/file_reader.h"
#include "tool/io/io.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- the header ---------------------------------------------------------------------------------------- */

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_encoding;

typedef enum ply_type {
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
} ply_type;

typedef enum ply_kind { PLY_OTHER, PLY_VERTEX, PLY_FACE } ply_kind;

/* The role of a property in a mesh; X, Y, Z are 0, 1, 2. A face's integer part, or label, says which part it
 * belongs to; of several the first counts. Its stiffness is a number of any type. */
typedef enum ply_role { PLY_X, PLY_Y, PLY_Z, PLY_CORNERS, PLY_PART, PLY_STIFFNESS, PLY_IGNORED } ply_role;

typedef struct ply_property {
    text_token name;
    ply_type type; /* of a list: of its entries */
    bool is_list;
    ply_type length_type; /* of a list */
    ply_role role;
} ply_property;

typedef struct ply_element {
    text_token name;
    ply_kind kind;
    int64_t count;
    size_t first_property, property_count;
} ply_element;

typedef struct ply_header {
    ply_encoding encoding;
    growable elements;   /* of ply_element, in file order */
    growable properties; /* of ply_property, those of the first element first */
    int64_t vertex_count;
} ply_header;

/* ---- the rows ------------------------------------------------------------------------------------------ */

typedef struct ply_data {
    file_reader *reader;
    ply_header header;
    const ply_element *element; /* the current one */
    int64_t row;                /* of the element */
} ply_data;

/* Reads the header. Close it in either case; on false, here and below, the reader's error is set. */
bool ply_data_open(ply_data *data, file_reader *reader);
void ply_data_close(ply_data *data);

/* A function that takes the values that are read. */
typedef struct ply_visitor {
    /* This function must read or skip the property. */
    bool (*visit)(void *user, const ply_property *property);
    /* It is called after a row's last property; errors are then placed at the row's start. */
    bool (*end_row)(void *user);
    void *user;
} ply_visitor;

/* Reads all rows of all elements, in the order of the file, which must end there. */
bool ply_data_read(ply_data *data, const ply_visitor *visitor);

/* Call these inside visit. They read a number, or an entry of a list after its length. */
bool ply_data_number(ply_data *data, const ply_property *property, double *value);
bool ply_data_length(ply_data *data, const ply_property *property, int64_t *length);
bool ply_data_skip(ply_data *data, const ply_property *property);

/* ---- plans: the mesh at rest, charge and region per face, and a colour, which any viewer shows --------- */

/* True if the file begins as a PLY with the comment that every plan has; false too when it cannot be read. */
bool plan_file_is_plan(const char *path);

/* positions: the mesh at rest, as the plan was made from it; colours: red, green, blue per triangle. A file
 * that was there stays until the plan is whole. */
bool plan_file_write(const char *path, const cscd_mesh *mesh, const double *positions, const cscd_plan *plan,
                     const uint8_t *colours, io_error *error);

/* Reads the plan that was written, bit for bit. It refuses a plan of another mesh, and says what differs.
 * context: that of the mesh. */
bool plan_file_read(const char *path, const cscd_context *context, const cscd_mesh *mesh, cscd_plan **out,
                    io_error *error);
