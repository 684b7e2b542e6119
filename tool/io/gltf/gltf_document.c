/* The container of a glTF file: the chunks of a .glb file, its version, and its buffers. */
#include "tool/io/gltf/gltf_document.h"

#include "tool/io/base64.h"
#include "tool/io/gltf.h"
#include "tool/io/gltf/gltf_extensions.h"
#include "tool/io/growable.h"
#include "tool/io/path_name.h"
#include "tool/io/text_escape.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* The first chunk is the JSON, the second, if it is there, the buffer; others are unknown, and passed over. */
static bool read_chunks(file_reader *reader, chunk_span *json, gltf_document *document) {
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
    if (!read_chunk(reader, HEADER_SIZE, end, json)) return false;
    if (json->kind != CHUNK_JSON)
        return file_reader_fail_here(reader, "the first chunk is not the JSON of a .glb file");
    const size_t next = json->at + json->size;
    chunk_span second = {0};
    if (next < end && !read_chunk(reader, next, end, &second)) return false;
    document->has_chunk = second.kind == CHUNK_BIN;
    document->chunk_at = second.at;
    document->chunk_size = second.size;
    return true;
}

static bool read_json(file_reader *reader, gltf_document *document) {
    chunk_span json = {.at = reader->at, .size = reader->size - reader->at}; /* behind a byte order mark */
    if (reader->size >= sizeof magic && memcmp(reader->bytes, magic, sizeof magic) == 0 &&
        !read_chunks(reader, &json, document))
        return false;
    document->root = (gltf_element){.reader = reader, .value = gltf_json_parse(reader, json.at, json.size)};
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

/* A file of a stranger must not bring others from somewhere on the disk into what is written. Windows has two separators. */
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
