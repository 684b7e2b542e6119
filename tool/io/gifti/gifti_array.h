/* A data array of a GIFTI file: what its attributes say, and its numbers. */
#pragma once

#include "tool/io/file_reader.h"
#include "tool/io/growable.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum gifti_type { GIFTI_FLOAT32, GIFTI_FLOAT64, GIFTI_INT32 } gifti_type;
typedef enum gifti_encoding { GIFTI_ASCII, GIFTI_BASE64, GIFTI_ZIPPED } gifti_encoding;

typedef struct gifti_array {
    gifti_type type;
    gifti_encoding encoding;
    bool big_endian, column_major;
    uint32_t row_count; /* of three numbers each */
    size_t line;        /* where its data begin */
    growable text;      /* of char: its data, as in the file, and a 0 that does not count */
    growable bytes; /* of unsigned char: decoded, unless it is ASCII; as numbers in this machine's order */
} gifti_array;

/* The size of a number in bytes. */
size_t gifti_type_size(gifti_type type);

/* Decodes the text. On false the reader's error is set. */
bool gifti_array_decode(gifti_array *array, file_reader *reader);

/* Number `column` of a decoded row. */
double gifti_array_number(const gifti_array *array, uint32_t row, uint32_t column);
