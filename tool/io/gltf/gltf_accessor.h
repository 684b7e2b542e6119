/* Accessors of a glTF file: typed arrays in its buffers, element by element as doubles. */
#pragma once

#include "tool/io/gltf/gltf_document.h"

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

/* The accessor that member `key` of `user` names, whose elements have this many components (1: SCALAR, 16: MAT4). *given is
 * false, and *out untouched, when there is no such member. On false the reader's error is set. */
bool gltf_accessor_open(gltf_document *document, const gltf_element *user, const char *key,
                        uint32_t components, gltf_accessor *out, bool *given);

/* The same for a member that must be there. */
bool gltf_accessor_require(gltf_document *document, const gltf_element *user, const char *key,
                           uint32_t components, gltf_accessor *out);

/* The components of an element below the count. */
void gltf_accessor_get(const gltf_accessor *accessor, uint32_t element, double *components);

/* Whether the components are unsigned integers that stand for themselves, as indices must. */
bool gltf_accessor_is_index(const gltf_accessor *accessor);
