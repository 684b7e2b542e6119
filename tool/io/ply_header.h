/* The header of a PLY file: its encoding, elements and properties. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/growable.h"
#include "tool/io/text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* The role of a property in a mesh; X, Y, Z are 0, 1, 2. A face's integer part, or label, says which part it belongs to; of
 * several the first counts. Its stiffness is a number of any type. */
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

/* Reads up to the first byte of the data. The header must have one element vertex with x, y, z and one
 * element face with vertex_indices or vertex_index. On false the reader's error is set. Free it in either
 * case. */
bool ply_header_read(file_reader *reader, ply_header *header);
void ply_header_free(ply_header *header);

size_t ply_type_size(ply_type type);
bool ply_type_is_integer(ply_type type);
