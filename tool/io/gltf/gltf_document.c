/* A glTF file: its JSON, and the bytes that the JSON speaks of. */
#include "tool/io/gltf/gltf_document.h"

#include "tool/io/format_reader.h"
#include "tool/io/gltf/gltf_scene.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/text_encoding.h"

#include <inttypes.h>
#include <json-c/json.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- JSON ---------------------------------------------------------------------------------------------- */

/* Objects inside each other: "extras" of programs may go deep, but freeing them takes a call for each
 * level. */
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

/* Parses the size bytes at `offset` of the reader's file; NULL after an error. */
static gltf_value *gltf_json_parse(file_reader *reader, size_t offset, size_t size) {
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

static void gltf_json_free(gltf_value *root) {
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

/* The text of a value in a message; NULL is null, and a value has no text when memory runs out. */
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

/* ---- the file ------------------------------------------------------------------------------------------ */

static const char magic[4] = {'g', 'l', 'T', 'F'};
enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8, CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942 };

bool gltf_recognise_path(const char *path) {
    return path_has_extension(path, ".glb") || path_has_extension(path, ".gltf");
}

bool gltf_recognise(const file_reader *reader) {
    return (reader->size >= sizeof magic && memcmp(reader->bytes, magic, sizeof magic) == 0) ||
           gltf_recognise_path(reader->path);
}

void *gltf_allocate(file_reader *reader, size_t count, size_t size) {
    void *memory = count > SIZE_MAX / size ? NULL : io_realloc(NULL, count > 0 ? count * size : 1);
    if (memory != NULL)
        memset(memory, 0, count * size);
    else
        file_reader_fail(reader, "out of memory for %zu elements of %zu bytes", count, size);
    return memory;
}

/* ---- the chunks of a .glb file ----------------------------------------------------------------------- */

static uint32_t load_word(const file_reader *reader, size_t at) {
    const unsigned char *bytes = (const unsigned char *)reader->bytes + at;
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

typedef struct chunk_span {
    uint32_t kind;
    size_t at, size;
} chunk_span;

/* The chunk that begins at `at`. */
static bool read_chunk(file_reader *reader, size_t at, size_t end, chunk_span *out) {
    reader->mark = at;
    if (end - at < CHUNK_HEADER_SIZE)
        return file_reader_fail_here(reader, "the file ends inside the header of a chunk");
    const uint32_t size = load_word(reader, at);
    if (size > end - at - CHUNK_HEADER_SIZE)
        return file_reader_fail_here(reader,
                                     "a chunk of %" PRIu32 " bytes, but %zu follow: the file is cut off",
                                     size, end - at - CHUNK_HEADER_SIZE);
    *out = (chunk_span){load_word(reader, at + 4), at + CHUNK_HEADER_SIZE, size};
    return true;
}

/* The first chunk is the JSON, the second, if it is there, the buffer; others are unknown, and passed
 * over. */
static bool read_chunks(file_reader *reader, chunk_span *text, gltf_document *document) {
    reader->binary = true;
    if (reader->size < HEADER_SIZE)
        return file_reader_fail(reader, "ends after %zu bytes, inside the header of a .glb file",
                                reader->size);
    const uint32_t version = load_word(reader, 4), length = load_word(reader, 8);
    if (version != 2)
        return file_reader_fail(reader, "is a .glb file of version %" PRIu32 ", expected 2", version);
    if (length > reader->size)
        return file_reader_fail(reader, "has %zu of %" PRIu32 " bytes: it is cut off", reader->size, length);
    const size_t end = length < HEADER_SIZE ? reader->size : length;
    if (!read_chunk(reader, HEADER_SIZE, end, text)) return false;
    if (text->kind != CHUNK_JSON)
        return file_reader_fail_here(reader, "the first chunk is not the JSON of a .glb file");
    const size_t next = text->at + text->size;
    chunk_span second = {0};
    if (next < end && !read_chunk(reader, next, end, &second)) return false;
    document->has_chunk = second.kind == CHUNK_BIN;
    document->chunk_at = second.at;
    document->chunk_size = second.size;
    return true;
}

static bool read_json(file_reader *reader, gltf_document *document) {
    chunk_span text = {.at = reader->at, .size = reader->size - reader->at}; /* behind a byte order mark */
    if (reader->size >= sizeof magic && memcmp(reader->bytes, magic, sizeof magic) == 0 &&
        !read_chunks(reader, &text, document))
        return false;
    document->root = (gltf_element){.reader = reader, .value = gltf_json_parse(reader, text.at, text.size)};
    return document->root.value != NULL;
}

/* ---- version ----------------------------------------------------------------------------------------- */

static bool check_version(const gltf_element *root) {
    gltf_element asset;
    if (!gltf_object(root, "asset", &asset)) return false;
    const char *version = asset.value != NULL ? gltf_string(&asset, "version") : NULL;
    const char *least = asset.value != NULL ? gltf_string(&asset, "minVersion") : NULL;
    if (version == NULL)
        return gltf_fail(root, "asset.version is missing, expected a glTF file of version 2.0");
    if (strncmp(version, "2.", 2) != 0)
        return gltf_fail(root, "is a glTF file of version %.*s, expected 2.0", TEXT_CUT(version, 20));
    if (least != NULL && strcmp(least, "2.0") != 0)
        return gltf_fail(root, "needs a reader of glTF %.*s, this one reads 2.0", TEXT_CUT(least, 20));
    return true;
}

/* ---- the interface ----------------------------------------------------------------------------------- */

bool gltf_document_open(file_reader *reader, gltf_document *out) {
    gltf_document document = {.reader = reader};
    bool opened = read_json(reader, &document) && check_version(&document.root) &&
                  gltf_extensions_check(&document.root) &&
                  gltf_array_length(&document.root, "buffers", &document.buffer_count);
    if (opened) {
        document.buffers = gltf_allocate(reader, document.buffer_count, sizeof *document.buffers);
        opened = document.buffers != NULL;
    }
    if (opened)
        *out = document;
    else
        gltf_document_close(&document);
    return opened;
}

void gltf_document_close(gltf_document *document) {
    if (document->buffers != NULL)
        for (size_t i = 0; i < document->buffer_count; i++) free(document->buffers[i].owned);
    free(document->buffers);
    gltf_json_free(document->root.value);
    *document = (gltf_document){0};
}

/* ---- the buffers of a glTF file: its own chunk, files beside it, and data in the JSON itself ------------- */

static int hexadecimal_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* Replaces %41 by A, in place; false when a percent sign stands before anything else, or for a 0. */
static bool decode_percents(char *text, size_t *length) {
    size_t written = 0;
    for (const char *from = text; *from != '\0'; from++) {
        if (*from != '%') {
            text[written++] = *from;
            continue;
        }
        const int high = hexadecimal_digit(from[1]), low = high < 0 ? -1 : hexadecimal_digit(from[2]);
        if (low < 0 || high * 16 + low == 0) return false;
        text[written++] = (char)(high * 16 + low);
        from += 2;
    }
    text[written] = '\0';
    *length = written;
    return true;
}

/* A file of a stranger must not bring others from somewhere on the disk into what is written. Windows has two
 * separators. */
static bool leaves_folder(const char *path) {
    for (const char *part = path;; part++) {
        const size_t length = strcspn(part, "/\\");
        if (length == 2 && memcmp(part, "..", 2) == 0) return true;
        part += length;
        if (*part == '\0') return false;
    }
}

/* The folder of the glTF file with the URI behind it, percents decoded; NULL after an error. */
static char *path_of_uri(const gltf_element *buffer, const char *uri) {
    const char *file = buffer->reader->path;
    const size_t folder_length = (size_t)(path_file_name(file) - file), uri_length = strlen(uri);
    char *path = gltf_allocate(buffer->reader, folder_length + uri_length + 1, 1);
    if (path == NULL) return NULL;
    memcpy(path, file, folder_length);
    memcpy(path + folder_length, uri, uri_length + 1);
    size_t length;
    if (!decode_percents(path + folder_length, &length))
        gltf_fail(buffer, "uri %.*s has a percent sign without two hexadecimal digits of a character",
                  TEXT_CUT(uri, 80));
    else if (leaves_folder(path + folder_length))
        gltf_fail(buffer, "uri %.*s, expected a file in the folder of the glTF file or below",
                  TEXT_CUT(uri, 80));
    else
        return path;
    free(path);
    return NULL;
}

static bool load_file(const gltf_element *buffer, const char *uri, gltf_buffer *out) {
    const size_t scheme = strcspn(uri, ":/?#");
    if (uri[0] == '/' || uri[scheme] == ':')
        return gltf_fail(buffer, "uri %.*s, expected a file in the folder of the glTF file or below",
                         TEXT_CUT(uri, 80));
    char *path = path_of_uri(buffer, uri);
    if (path == NULL) return false;
    file_reader file;
    io_error cause;
    const bool opened = file_reader_open(&file, path, &cause);
    free(path);
    if (!opened) return gltf_fail(buffer, "%s", cause.text);
    *out = (gltf_buffer){(const unsigned char *)file.bytes, file.size, file.bytes};
    return true;
}

/* data:[type][;base64],CHARACTERS */
static bool load_data(const gltf_element *buffer, const char *uri, gltf_buffer *out) {
    static const char encoding[] = ";base64";
    const char *comma = strchr(uri, ',');
    if (comma == NULL) return gltf_fail(buffer, "uri is data: without a comma");
    const size_t mark = sizeof encoding - 1;
    if ((size_t)(comma - uri) < mark || memcmp(comma - mark, encoding, mark) != 0)
        return gltf_fail(buffer, "uri is data: without ;base64, expected base64");
    size_t length = strlen(comma + 1), size, wrong;
    char *text = gltf_allocate(buffer->reader, length + 1, 1);
    unsigned char *bytes = text != NULL ? gltf_allocate(buffer->reader, base64_room(length), 1) : NULL;
    bool done = bytes != NULL;
    if (done) memcpy(text, comma + 1, length + 1);
    if (done && !decode_percents(text, &length))
        done = gltf_fail(buffer, "uri has a percent sign without two hexadecimal digits of a character");
    if (done && !base64_decode(text, length, bytes, &size, &wrong))
        done = gltf_fail(buffer, "uri is no base64 at character %zu of its data", wrong);
    free(text);
    if (done)
        *out = (gltf_buffer){bytes, size, bytes};
    else
        free(bytes);
    return done;
}

static bool load_chunk(gltf_document *document, const gltf_element *buffer, uint32_t index,
                       gltf_buffer *out) {
    if (index != 0 || !document->has_chunk)
        return gltf_fail(buffer, "uri is missing%s",
                         index != 0 ? "" : ", and the file has no chunk of binary data");
    const unsigned char *bytes = (const unsigned char *)document->reader->bytes + document->chunk_at;
    *out = (gltf_buffer){bytes, document->chunk_size, NULL};
    return true;
}

bool gltf_document_buffer(gltf_document *document, uint32_t index, const gltf_buffer **out) {
    gltf_buffer *loaded = &document->buffers[index];
    *out = loaded;
    if (loaded->bytes != NULL) return true;
    gltf_element buffer;
    int64_t length = 0;
    if (!gltf_element_at(&document->root, "buffers", "buffer", index, &buffer) ||
        !gltf_required_integer(&buffer, "byteLength", 1, INT64_C(1) << 53, &length))
        return false;
    const char *uri = gltf_string(&buffer, "uri");
    gltf_buffer found = {0};
    const bool done = uri == NULL                     ? load_chunk(document, &buffer, index, &found)
                      : strncmp(uri, "data:", 5) == 0 ? load_data(&buffer, uri, &found)
                                                      : load_file(&buffer, uri, &found);
    if (!done) return false;
    if (found.size < (uint64_t)length) {
        free(found.owned);
        return gltf_fail(&buffer, "byteLength is %" PRId64 ", but there are %zu bytes: the data is cut off",
                         length, found.size);
    }
    found.size = (size_t)length;
    *loaded = found;
    return true;
}
