/* The JSON of a glTF file: members are asked for by name and type, and errors say which object has the fault. */
#pragma once

#include "tool/io/file_reader.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A value of the file; the root owns all others. */
typedef struct json_object gltf_value;

/* An object of the file, and what messages call it: "mesh 2, primitive 1", or "" for the root. */
typedef struct gltf_element {
    file_reader *reader;
    gltf_value *value;
    char name[96];
} gltf_element;

/* No index. */
#define GLTF_NONE UINT32_MAX

/* Parses the size bytes at `offset` of the reader's file; NULL after an error. */
gltf_value *gltf_json_parse(file_reader *reader, size_t offset, size_t size);
void gltf_json_free(gltf_value *root);

/* Writes "path: name: message" to the reader's error; always false. */
bool gltf_fail(const gltf_element *element, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The functions below return false after an error. A member that the file does not have is none, and leaves the output as it
 * was, unless the function's name says otherwise. */

/* The length of an array, 0 when there is none. */
bool gltf_array_length(const gltf_element *element, const char *key, size_t *length);

/* The object at `index` of the array `key`, which is called "<label> <index>" after the element's own name. */
bool gltf_element_at(const gltf_element *element, const char *key, const char *label, size_t index,
                     gltf_element *out);

/* The object `key`, which keeps the element's name; out->value is NULL when there is none. */
bool gltf_object(const gltf_element *element, const char *key, gltf_element *out);

/* A whole number from least to most. */
bool gltf_integer(const gltf_element *element, const char *key, int64_t least, int64_t most, int64_t *value);
bool gltf_required_integer(const gltf_element *element, const char *key, int64_t least, int64_t most,
                           int64_t *value);

/* An index below count of what the file holds ("nodes"). */
bool gltf_index(const gltf_element *element, const char *key, const char *what, size_t count,
                uint32_t *index);
/* Such an index at place `at` of the array `key`. */
bool gltf_index_at(const gltf_element *element, const char *key, size_t at, const char *what, size_t count,
                   uint32_t *index);

/* An array of exactly count finite numbers. */
bool gltf_numbers(const gltf_element *element, const char *key, size_t count, double *numbers, bool *given);

/* Whether there is such a member, of whatever type. */
bool gltf_has(const gltf_element *element, const char *key);
/* Visits the names of all members, in the file's order. */
void gltf_visit_members(const gltf_element *element, void (*visit)(const char *name, void *user), void *user);
/* NULL when there is none, or it is no string; alive as long as the root. */
const char *gltf_string(const gltf_element *element, const char *key);
const char *gltf_string_at(const gltf_element *element, const char *key, size_t at);
bool gltf_is_true(const gltf_element *element, const char *key);
