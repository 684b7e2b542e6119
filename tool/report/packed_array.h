/* An array of the page: values in, compressed in memory as they come, base64 out. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct packed_array packed_array;

/* NULL: out of memory. */
packed_array *packed_array_create(void);
void packed_array_destroy(packed_array *array);

/* Little endian on every machine. False: out of memory, and the array is of no more use. */
bool packed_array_add_bytes(packed_array *array, const uint8_t *bytes, size_t count);
bool packed_array_add_u32(packed_array *array, const uint32_t *values, size_t count);
bool packed_array_add_f32(packed_array *array, const float *values, size_t count);
bool packed_array_add_f64(packed_array *array, const double *values, size_t count);

/* Bytes added so far. */
size_t packed_array_size(const packed_array *array);

/* Ends the stream (RFC 1950); nothing can be added any more. */
bool packed_array_finish(packed_array *array);

/* The finished stream, in one line of base64. False: the file refused, errno says why. */
bool packed_array_write(const packed_array *array, FILE *file);
