/* A glTF file: its JSON, and the bytes that the JSON speaks of. */
#pragma once

#include "tool/io/gltf/gltf_json.h"

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

/* Reads the JSON, and checks the version and the extensions that the file requires. Buffers are loaded when they are asked
 * for. On false *out owns nothing, and the reader's error is set. */
bool gltf_document_open(file_reader *reader, gltf_document *out);
void gltf_document_close(gltf_document *document);

/* The bytes of a buffer below buffer_count: its byteLength, at least. */
bool gltf_document_buffer(gltf_document *document, uint32_t index, const gltf_buffer **out);

/* count elements of size bytes, all 0, or NULL and an error; the caller frees them. */
void *gltf_allocate(file_reader *reader, size_t count, size_t size);
