/* A glTF file: its JSON, the bytes that the JSON speaks of, and the typed arrays in these. */
#pragma once

#include "tool/io/file_reader.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* ---- JSON: members are asked for by name and type, and errors say which object has the fault ----------- */

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

/* Writes "path: name: message" to the reader's error; always false. */
bool gltf_fail(const gltf_element *element, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The functions below return false after an error. A member that the file does not have is none, and leaves
 * the output as it was, unless the function's name says otherwise. */

/* The length of an array, 0 when there is none. */
bool gltf_array_length(const gltf_element *element, const char *key, size_t *length);

/* The object at `index` of the array `key`, which is called "<label> <index>" after the element's own
 * name. */
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

/* True if there is such a member, of whatever type. */
bool gltf_has(const gltf_element *element, const char *key);
/* Visits the names of all members, in the file's order. */
void gltf_visit_members(const gltf_element *element, void (*visit)(const char *name, void *user), void *user);
/* NULL when there is none, or it is no string; alive as long as the root. */
const char *gltf_string(const gltf_element *element, const char *key);
const char *gltf_string_at(const gltf_element *element, const char *key, size_t at);
bool gltf_is_true(const gltf_element *element, const char *key);

/* ---- the file ------------------------------------------------------------------------------------------ */

typedef struct gltf_buffer {
    const unsigned char *bytes; /* NULL: not loaded yet */
    size_t size;
    void *owned; /* to be freed; NULL when the bytes are the file's own */
} gltf_buffer;

typedef struct gltf_document {
    file_reader *reader; /* the caller's, open as long as the document */
    gltf_element root;
    size_t chunk_at, chunk_size; /* the bytes behind the JSON in a .glb file */
    bool has_chunk;
    gltf_buffer *buffers;
    size_t buffer_count;
} gltf_document;

/* By the first bytes, or the ending of the name. */
bool gltf_recognise(const file_reader *reader);

/* Reads the JSON, and checks the version and the extensions that the file requires. Buffers are loaded when
 * they are asked for. On false *out owns nothing, and the reader's error is set. */
bool gltf_document_open(file_reader *reader, gltf_document *out);
void gltf_document_close(gltf_document *document);

/* The bytes of a buffer below buffer_count: its byteLength, at least. */
bool gltf_document_buffer(gltf_document *document, uint32_t index, const gltf_buffer **out);

/* count elements of size bytes, all 0, or NULL and an error; the caller frees them. */
void *gltf_allocate(file_reader *reader, size_t count, size_t size);

/* ---- accessors: typed arrays in buffers, element by element as doubles --------------------------------- */

/* Types of components, as files number them. */
typedef enum gltf_component {
    GLTF_BYTE = 5120,
    GLTF_UNSIGNED_BYTE = 5121,
    GLTF_SHORT = 5122,
    GLTF_UNSIGNED_SHORT = 5123,
    GLTF_UNSIGNED_INT = 5125,
    GLTF_FLOAT = 5126
} gltf_component;

/* An array whose bounds have been checked. A zeroed struct with a count is an array of zeros. */
typedef struct gltf_accessor {
    uint32_t count;      /* elements */
    uint32_t components; /* of each: 1, 2, 3, 4 or 16 */
    gltf_component component;
    bool normalised;           /* integers stand for 0 to 1, or -1 to 1 */
    const unsigned char *data; /* NULL: zeros */
    size_t stride;
    /* Elements that replace those above, by rising index. */
    uint32_t sparse_count;
    gltf_component sparse_component; /* of their indices */
    const unsigned char *sparse_indices, *sparse_values;
} gltf_accessor;

/* The accessor that member `key` of `user` names, whose elements have this many components (1: SCALAR, 16:
 * MAT4). *given is false, and *out untouched, when there is no such member. On false the reader's error is
 * set. */
bool gltf_accessor_open(gltf_document *document, const gltf_element *user, const char *key,
                        uint32_t components, gltf_accessor *out, bool *given);

/* The same for a member that must be there. */
bool gltf_accessor_require(gltf_document *document, const gltf_element *user, const char *key,
                           uint32_t components, gltf_accessor *out);

/* The components of an element below the count. */
void gltf_accessor_get(const gltf_accessor *accessor, uint32_t element, double *components);

/* True if the components are unsigned integers that stand for themselves, as indices must. */
bool gltf_accessor_is_index(const gltf_accessor *accessor);
