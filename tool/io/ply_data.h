/* The rows of a PLY file, value by value: text and binary, either byte order. */
#pragma once

#include "tool/io/ply_header.h"

#include <stdbool.h>
#include <stdint.h>

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
