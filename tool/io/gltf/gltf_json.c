/* The JSON of a glTF file: members are asked for by name and type, and errors say which object has the fault. */
#include "tool/io/gltf/gltf_json.h"

#include "tool/io/json_room.h"
#include "tool/io/text_escape.h"

#include <inttypes.h>
#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Objects inside each other: "extras" of programs may go deep, but freeing them takes a call for each level. */
enum { DEPTH_MAX = 512 };

/* ---- parsing ---------------------------------------------------------------------------------------- */

/* Places the reader at the byte where the parser stopped: .gltf files have lines, .glb files bytes. */
static bool fail_parse(file_reader *reader, size_t offset, size_t place, enum json_tokener_error cause) {
    const char *text = json_tokener_error_desc(cause);
    if (cause == json_tokener_continue) text = "the JSON ends too early";
    reader->mark = offset + place;
    for (size_t i = offset; i < reader->mark && i < reader->size; i++)
        reader->line += reader->bytes[i] == '\n';
    return file_reader_fail_here(reader, "no valid JSON: %s", text);
}

gltf_value *gltf_json_parse(file_reader *reader, size_t offset, size_t size) {
    if (size > INT_MAX) {
        file_reader_fail(reader, "the JSON has %zu bytes, expected %d at most", size, INT_MAX);
        return NULL;
    }
    if (!json_has_room(reader->bytes + offset, size)) {
        file_reader_fail(reader,
                         "the JSON has more objects than one in ten bytes, expected that of a glTF file");
        return NULL;
    }
    json_tokener *parser = json_tokener_new_ex(DEPTH_MAX);
    if (parser == NULL) {
        file_reader_fail(reader, "out of memory");
        return NULL;
    }
    gltf_value *root = json_tokener_parse_ex(parser, reader->bytes + offset, (int)size);
    enum json_tokener_error cause = json_tokener_get_error(parser);
    const size_t end = json_tokener_get_parse_end(parser);
    json_tokener_free(parser);
    if (cause != json_tokener_success) {
        fail_parse(reader, offset, end, cause);
        return NULL;
    }
    if (json_object_get_type(root) == json_type_object) return root;
    json_object_put(root);
    file_reader_fail(reader, "the JSON is no object, expected that of a glTF file");
    return NULL;
}

void gltf_json_free(gltf_value *root) {
    json_object_put(root);
}

bool gltf_fail(const gltf_element *element, const char *format, ...) {
    char message[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (element->name[0] == '\0') return file_reader_fail(element->reader, "%s", message);
    return file_reader_fail(element->reader, "%s: %s", element->name, message);
}

/* ---- members ---------------------------------------------------------------------------------------- */

/* NULL: not there, or null. */
static gltf_value *find_member(const gltf_element *element, const char *key) {
    gltf_value *found = NULL;
    if (!json_object_object_get_ex(element->value, key, &found)) return NULL;
    return found;
}

/* NULL: there is none. */
static gltf_value *find_item(gltf_value *array, size_t at) {
    return json_object_get_type(array) == json_type_array ? json_object_array_get_idx(array, at) : NULL;
}

bool gltf_has(const gltf_element *element, const char *key) {
    return find_member(element, key) != NULL;
}

bool gltf_array_length(const gltf_element *element, const char *key, size_t *length) {
    gltf_value *array = find_member(element, key);
    *length = 0;
    if (array == NULL) return true;
    if (json_object_get_type(array) != json_type_array) return gltf_fail(element, "%s is no array", key);
    *length = json_object_array_length(array);
    return true;
}

bool gltf_element_at(const gltf_element *element, const char *key, const char *label, size_t index,
                     gltf_element *out) {
    gltf_value *array = find_member(element, key);
    gltf_element found = {.reader = element->reader, .value = find_item(array, index)};
    snprintf(found.name, sizeof found.name, "%.60s%s%s %zu", element->name,
             element->name[0] != '\0' ? ", " : "", label, index);
    if (json_object_get_type(found.value) != json_type_object) return gltf_fail(&found, "is no object");
    *out = found;
    return true;
}

bool gltf_object(const gltf_element *element, const char *key, gltf_element *out) {
    gltf_element found = *element;
    found.value = find_member(element, key);
    if (found.value != NULL && json_object_get_type(found.value) != json_type_object)
        return gltf_fail(element, "%s is no object", key);
    *out = found;
    return true;
}

/* ---- numbers ---------------------------------------------------------------------------------------- */

/* What a message shows of a value; NULL is null, and a value has no text when memory runs out. */
static const char *text_of(gltf_value *value) {
    const char *text = json_object_get_string(value);
    return text != NULL ? text : "null";
}

/* Some exporters write 3.0 for 3. */
static bool whole_number(gltf_value *value, int64_t *number) {
    const enum json_type type = json_object_get_type(value);
    if (type == json_type_int) {
        *number = json_object_get_int64(value);
        return true;
    }
    const double real = json_object_get_double(value);
    if (type != json_type_double || !(fabs(real) <= 0x1p53) || real != floor(real)) return false;
    *number = (int64_t)real;
    return true;
}

static bool take_integer(const gltf_element *element, const char *key, gltf_value *value, int64_t least,
                         int64_t most, int64_t *out) {
    int64_t number = 0;
    if (!whole_number(value, &number))
        return gltf_fail(element, "%s is %.*s, expected a whole number", key, TEXT_CUT(text_of(value), 40));
    if (number < least || number > most)
        return gltf_fail(element, "%s is %" PRId64 ", expected %" PRId64 " to %" PRId64, key, number, least,
                         most);
    *out = number;
    return true;
}

bool gltf_integer(const gltf_element *element, const char *key, int64_t least, int64_t most, int64_t *value) {
    gltf_value *found = find_member(element, key);
    return found == NULL || take_integer(element, key, found, least, most, value);
}

bool gltf_required_integer(const gltf_element *element, const char *key, int64_t least, int64_t most,
                           int64_t *value) {
    if (!gltf_has(element, key)) return gltf_fail(element, "%s is missing", key);
    return gltf_integer(element, key, least, most, value);
}

static bool take_index(const gltf_element *element, const char *key, gltf_value *value, const char *what,
                       size_t count, uint32_t *index) {
    int64_t number = 0;
    if (!take_integer(element, key, value, 0, INT64_C(1) << 53, &number)) return false;
    if ((uint64_t)number >= count || number >= GLTF_NONE)
        return gltf_fail(element, "%s is %" PRId64 ", but the file has %zu %s, from 0", key, number, count,
                         what);
    *index = (uint32_t)number;
    return true;
}

bool gltf_index(const gltf_element *element, const char *key, const char *what, size_t count,
                uint32_t *index) {
    gltf_value *found = find_member(element, key);
    return found == NULL || take_index(element, key, found, what, count, index);
}

bool gltf_index_at(const gltf_element *element, const char *key, size_t at, const char *what, size_t count,
                   uint32_t *index) {
    char place[64];
    snprintf(place, sizeof place, "%s[%zu]", key, at);
    return take_index(element, place, find_item(find_member(element, key), at), what, count, index);
}

bool gltf_numbers(const gltf_element *element, const char *key, size_t count, double *numbers, bool *given) {
    size_t length;
    *given = gltf_has(element, key);
    if (!*given) return true;
    if (!gltf_array_length(element, key, &length)) return false;
    if (length != count) return gltf_fail(element, "%s has %zu numbers, expected %zu", key, length, count);
    gltf_value *array = find_member(element, key);
    for (size_t i = 0; i < count; i++) {
        gltf_value *value = find_item(array, i);
        const enum json_type type = json_object_get_type(value);
        if ((type != json_type_int && type != json_type_double) || !isfinite(json_object_get_double(value)))
            return gltf_fail(element, "%s[%zu] is %.*s, expected a finite number", key, i,
                             TEXT_CUT(text_of(value), 40));
        numbers[i] = json_object_get_double(value);
    }
    return true;
}

/* ---- the rest --------------------------------------------------------------------------------------- */

void gltf_visit_members(const gltf_element *element, void (*visit)(const char *name, void *user),
                        void *user) {
    json_object_object_foreach(element->value, name, value) {
        (void)value;
        visit(name, user);
    }
}

static const char *string_of(gltf_value *value) {
    return json_object_get_type(value) == json_type_string ? json_object_get_string(value) : NULL;
}

const char *gltf_string(const gltf_element *element, const char *key) {
    return string_of(find_member(element, key));
}

const char *gltf_string_at(const gltf_element *element, const char *key, size_t at) {
    return string_of(find_item(find_member(element, key), at));
}

bool gltf_is_true(const gltf_element *element, const char *key) {
    gltf_value *value = find_member(element, key);
    return json_object_get_type(value) == json_type_boolean && json_object_get_boolean(value);
}
