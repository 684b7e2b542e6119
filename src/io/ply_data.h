/* The rows of a PLY file, value by value: text and binary, either byte order. */
#pragma once

#include "src/io/ply_header.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct ply_data {
    file_reader *reader;
    ply_header header;
    const ply_element *element; /* in hand */
    int64_t row;                /* of the element */
} ply_data;

/* Reads the header. Close it in either case; on false, here and below, the reader's error is set. */
bool ply_data_open(ply_data *data, file_reader *reader);
void ply_data_close(ply_data *data);

/* A function that takes the values that are read. */
typedef struct ply_visitor {
    /* Must read or skip the property. */
    bool (*visit)(void *user, const ply_property *property);
    /* After a row's last property; errors are then placed at the row's start. */
    bool (*end_row)(void *user);
    void *user;
} ply_visitor;

/* All rows of all elements, in the order of the file, which must end there. */
bool ply_data_read(ply_data *data, const ply_visitor *visitor);

/* Inside visit. A number, or an entry of a list after its length. */
bool ply_data_number(ply_data *data, const ply_property *property, double *value);
bool ply_data_length(ply_data *data, const ply_property *property, int64_t *length);
bool ply_data_skip(ply_data *data, const ply_property *property);
