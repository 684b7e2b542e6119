/* The container of a glTF file: the chunks of a .glb file, and its version. */
#include "tool/io/gltf/gltf_document.h"

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
