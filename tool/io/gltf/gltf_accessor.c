/* Accessors of a glTF file: typed arrays in its buffers, element by element as doubles. */
#include "tool/io/gltf/gltf_document.h"

#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <string.h>

/* Offsets and lengths are below this, so that sums of a few never overflow. */
#define SIZE_LIMIT (INT64_C(1) << 53)

static size_t component_size(gltf_component component) {
    switch (component) {
    case GLTF_BYTE:
    case GLTF_UNSIGNED_BYTE:
        return 1;
    case GLTF_SHORT:
    case GLTF_UNSIGNED_SHORT:
        return 2;
    case GLTF_UNSIGNED_INT:
    case GLTF_FLOAT:
        break;
    }
    return 4;
}

/* ---- views of buffers -------------------------------------------------------------------------------- */

typedef struct buffer_view {
    const unsigned char *bytes;
    int64_t size, stride; /* stride 0: elements follow each other */
} buffer_view;

static bool open_view(gltf_document *document, const gltf_element *user, buffer_view *out) {
    uint32_t index = GLTF_NONE, buffer = GLTF_NONE;
    size_t view_count;
    gltf_element view;
    int64_t offset = 0, length = 0, stride = 0;
    const gltf_buffer *loaded;
    if (!gltf_array_length(&document->root, "bufferViews", &view_count) ||
        !gltf_index(user, "bufferView", "buffer views", view_count, &index))
        return false;
    if (index == GLTF_NONE) return gltf_fail(user, "bufferView is missing");
    if (!gltf_element_at(&document->root, "bufferViews", "buffer view", index, &view) ||
        !gltf_index(&view, "buffer", "buffers", document->buffer_count, &buffer) ||
        !gltf_integer(&view, "byteOffset", 0, SIZE_LIMIT, &offset) ||
        !gltf_required_integer(&view, "byteLength", 1, SIZE_LIMIT, &length) ||
        !gltf_integer(&view, "byteStride", 1, INT32_MAX, &stride))
        return false;
    if (buffer == GLTF_NONE) return gltf_fail(&view, "buffer is missing");
    if (!gltf_document_buffer(document, buffer, &loaded)) return false;
    if (offset + length > (int64_t)loaded->size)
        return gltf_fail(&view,
                         "byteOffset %" PRId64 " and byteLength %" PRId64
                         " reach beyond the %zu bytes of buffer %" PRIu32,
                         offset, length, loaded->size, buffer);
    *out = (buffer_view){loaded->bytes + offset, length, stride};
    return true;
}

/* Finds the beginning of count elements of this size in the view of `user`, and how far apart they are. */
static bool locate_elements(gltf_document *document, const gltf_element *user, int64_t count, size_t size,
                            const unsigned char **data, size_t *stride) {
    buffer_view view = {0};
    int64_t offset = 0;
    if (!open_view(document, user, &view) || !gltf_integer(user, "byteOffset", 0, SIZE_LIMIT, &offset))
        return false;
    const int64_t step = view.stride != 0 ? view.stride : (int64_t)size;
    if (step < (int64_t)size)
        return gltf_fail(user, "byteStride %" PRId64 " is shorter than an element of %zu bytes", step, size);
    const int64_t end = offset + (count - 1) * step + (int64_t)size;
    if (end > view.size)
        return gltf_fail(user,
                         "%" PRId64 " elements end at byte %" PRId64 " of a buffer view of %" PRId64 " bytes",
                         count, end, view.size);
    *data = view.bytes + offset;
    *stride = (size_t)step;
    return true;
}

/* ---- accessors --------------------------------------------------------------------------------------- */

static double load_component(const unsigned char *at, gltf_component component) {
    const uint32_t two = component_size(component) >= 2 ? at[0] | (uint32_t)at[1] << 8 : at[0];
    uint32_t bits;
    float single;
    switch (component) {
    case GLTF_BYTE:
        return (int8_t)at[0];
    case GLTF_SHORT:
        return (int16_t)two;
    case GLTF_UNSIGNED_BYTE:
    case GLTF_UNSIGNED_SHORT:
        return two;
    case GLTF_UNSIGNED_INT:
    case GLTF_FLOAT:
        break;
    }
    bits = two | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    if (component == GLTF_UNSIGNED_INT) return bits;
    memcpy(&single, &bits, sizeof single);
    return (double)single;
}

static bool read_component(const gltf_element *element, gltf_component *out) {
    int64_t number = 0;
    if (!gltf_required_integer(element, "componentType", 0, INT32_MAX, &number)) return false;
    if (number < GLTF_BYTE || number > GLTF_FLOAT || number == 5124)
        return gltf_fail(element, "componentType is %" PRId64 ", expected 5120 to 5123, 5125 or 5126",
                         number);
    *out = (gltf_component)number;
    return true;
}

static bool check_sparse_indices(const gltf_element *sparse, const gltf_accessor *accessor) {
    double before = -1;
    for (uint32_t i = 0; i < accessor->sparse_count; i++) {
        const size_t place = i * component_size(accessor->sparse_component);
        const double index = load_component(accessor->sparse_indices + place, accessor->sparse_component);
        if (index <= before)
            return gltf_fail(sparse, "sparse index %" PRIu32 " is %.0f, after %.0f: expected rising indices",
                             i, index, before);
        if (index >= accessor->count)
            return gltf_fail(sparse, "sparse index %" PRIu32 " is %.0f, but there are %" PRIu32 " elements",
                             i, index, accessor->count);
        before = index;
    }
    return true;
}

static bool read_sparse(gltf_document *document, const gltf_element *element, gltf_accessor *accessor) {
    gltf_element sparse, indices, values;
    int64_t count = 0;
    size_t stride;
    if (!gltf_object(element, "sparse", &sparse)) return false;
    if (sparse.value == NULL) return true;
    if (!gltf_required_integer(&sparse, "count", 1, accessor->count, &count) ||
        !gltf_object(&sparse, "indices", &indices) || !gltf_object(&sparse, "values", &values))
        return false;
    if (indices.value == NULL || values.value == NULL)
        return gltf_fail(element, "sparse has no indices or no values");
    accessor->sparse_count = (uint32_t)count;
    if (!read_component(&indices, &accessor->sparse_component)) return false;
    if (accessor->sparse_component == GLTF_FLOAT)
        return gltf_fail(element, "sparse indices are floating-point numbers");
    const size_t index_size = component_size(accessor->sparse_component);
    const size_t value_size = accessor->components * component_size(accessor->component);
    if (!locate_elements(document, &indices, count, index_size, &accessor->sparse_indices, &stride))
        return false;
    if (stride != index_size) return gltf_fail(element, "sparse indices have a byteStride, expected none");
    if (!locate_elements(document, &values, count, value_size, &accessor->sparse_values, &stride))
        return false;
    if (stride != value_size) return gltf_fail(element, "sparse values have a byteStride, expected none");
    return check_sparse_indices(element, accessor);
}

/* Fails unless the elements have as many components as the user expects. */
static bool check_type(const gltf_element *element, const gltf_element *user, const char *key,
                       uint32_t components) {
    static const struct {
        const char *name;
        uint32_t components;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const char *type = gltf_string(element, "type"), *expected = "";
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (types[i].components != components) continue;
        expected = types[i].name;
        if (type != NULL && strcmp(type, expected) == 0) return true;
    }
    return gltf_fail(element, "type is %.*s, expected %s for %s of %s",
                     TEXT_CUT(type != NULL ? type : "missing", 20), expected, key, user->name);
}

/* Elements without a buffer view are zeros, which take no room in the file: a few bytes could claim billions
 * of them. */
static bool check_zeros(const gltf_document *document, const gltf_element *element,
                        const gltf_accessor *accessor) {
    uint64_t size = document->reader->size;
    for (size_t i = 0; i < document->buffer_count; i++) size += document->buffers[i].size;
    if (accessor->data != NULL || accessor->count <= size) return true;
    return gltf_fail(element,
                     "has %" PRIu32 " elements without a bufferView, expected at most %" PRIu64
                     ", the bytes of the file",
                     accessor->count, size);
}

bool gltf_accessor_open(gltf_document *document, const gltf_element *user, const char *key,
                        uint32_t components, gltf_accessor *out, bool *given) {
    uint32_t index = GLTF_NONE;
    size_t accessor_count;
    gltf_element element;
    int64_t count = 0;
    if (!gltf_array_length(&document->root, "accessors", &accessor_count) ||
        !gltf_index(user, key, "accessors", accessor_count, &index))
        return false;
    *given = index != GLTF_NONE;
    if (!*given) return true;
    gltf_accessor accessor = {.components = components};
    if (!gltf_element_at(&document->root, "accessors", "accessor", index, &element) ||
        !check_type(&element, user, key, components) || !read_component(&element, &accessor.component) ||
        !gltf_required_integer(&element, "count", 1, INT32_MAX, &count))
        return false;
    accessor.count = (uint32_t)count;
    accessor.normalised = gltf_is_true(&element, "normalized");
    const size_t size = components * component_size(accessor.component);
    if (gltf_has(&element, "bufferView") &&
        !locate_elements(document, &element, count, size, &accessor.data, &accessor.stride))
        return false;
    if (!read_sparse(document, &element, &accessor) || !check_zeros(document, &element, &accessor))
        return false;
    *out = accessor;
    return true;
}

bool gltf_accessor_require(gltf_document *document, const gltf_element *user, const char *key,
                           uint32_t components, gltf_accessor *out) {
    bool given;
    if (!gltf_accessor_open(document, user, key, components, out, &given)) return false;
    return given || gltf_fail(user, "%s is missing", key);
}

/* ---- elements ---------------------------------------------------------------------------------------- */

/* The element's bytes; NULL: it is 0. */
static const unsigned char *find_element(const gltf_accessor *accessor, uint32_t element) {
    const size_t index_size = component_size(accessor->sparse_component);
    uint32_t low = 0, high = accessor->sparse_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const double index =
            load_component(accessor->sparse_indices + middle * index_size, accessor->sparse_component);
        if (index == element)
            return accessor->sparse_values +
                   (size_t)middle * accessor->components * component_size(accessor->component);
        if (index < element)
            low = middle + 1;
        else
            high = middle;
    }
    return accessor->data == NULL ? NULL : accessor->data + element * accessor->stride;
}

/* A normalised -128 stands for -1, as -127 does. */
static double normalise_integer(double value, gltf_component component) {
    switch (component) {
    case GLTF_BYTE:
        return value < -127 ? -1 : value / 127;
    case GLTF_UNSIGNED_BYTE:
        return value / 255;
    case GLTF_SHORT:
        return value < -32767 ? -1 : value / 32767;
    case GLTF_UNSIGNED_SHORT:
        return value / 65535;
    case GLTF_UNSIGNED_INT:
        return value / 4294967295.0;
    case GLTF_FLOAT:
        break;
    }
    return value;
}

void gltf_accessor_get(const gltf_accessor *accessor, uint32_t element, double *components) {
    const unsigned char *at = find_element(accessor, element);
    const size_t size = component_size(accessor->component);
    for (uint32_t i = 0; i < accessor->components; i++) {
        double value = at == NULL ? 0 : load_component(at + i * size, accessor->component);
        components[i] = accessor->normalised ? normalise_integer(value, accessor->component) : value;
    }
}

bool gltf_accessor_is_index(const gltf_accessor *accessor) {
    return !accessor->normalised &&
           (accessor->component == GLTF_UNSIGNED_BYTE || accessor->component == GLTF_UNSIGNED_SHORT ||
            accessor->component == GLTF_UNSIGNED_INT);
}
