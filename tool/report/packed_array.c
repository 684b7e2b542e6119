/* An array of the page: values in, compressed in memory as they come, base64 out. */
#define ZLIB_CONST

#include "tool/report/packed_array.h"

#include "tool/io/io.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum {
    LEVEL = 6,
    CHUNK_VALUES = 1024,
    FIRST_CAPACITY = 4096,
    STEP_MAX = 1 << 30 /* zlib counts in 32 bits */
};

struct packed_array {
    z_stream stream;
    growable bytes; /* of the stream so far */
    size_t size;    /* of what was added */
    bool finished;
};

static voidpf zlib_allocate(voidpf user, uInt count, uInt size) {
    (void)user;
    return count <= SIZE_MAX / size ? io_realloc(NULL, (size_t)count * size) : NULL;
}

static void zlib_release(voidpf user, voidpf memory) {
    (void)user;
    free(memory);
}

packed_array *packed_array_create(void) {
    packed_array *array = io_realloc(NULL, sizeof *array);
    if (array == NULL) return NULL;
    *array =
        (packed_array){.stream = {.zalloc = zlib_allocate, .zfree = zlib_release}, .bytes = growable_of(1)};
    if (deflateInit(&array->stream, LEVEL) == Z_OK) return array;
    free(array);
    return NULL;
}

void packed_array_destroy(packed_array *array) {
    if (array == NULL) return;
    deflateEnd(&array->stream);
    growable_free(&array->bytes);
    free(array);
}

/* Makes room for more of the stream, by doubling. */
static bool make_room(packed_array *array) {
    growable *bytes = &array->bytes;
    if (bytes->count == bytes->capacity) {
        if (bytes->capacity > SIZE_MAX / 2) return false;
        if (!growable_reserve(bytes, bytes->capacity > 0 ? 2 * bytes->capacity : FIRST_CAPACITY))
            return false;
    }
    size_t room = bytes->capacity - bytes->count;
    array->stream.next_out = (Bytef *)bytes->data + bytes->count;
    array->stream.avail_out = (uInt)(room < STEP_MAX ? room : STEP_MAX);
    return true;
}

/* Hands over what next_in has; with Z_FINISH until the stream has ended. */
static bool compress_input(packed_array *array, int flush) {
    z_stream *stream = &array->stream;
    int status = Z_OK;
    while (flush == Z_FINISH ? status != Z_STREAM_END : stream->avail_in > 0) {
        if (!make_room(array)) return false;
        status = deflate(stream, flush);
        array->bytes.count = (size_t)(stream->next_out - (Bytef *)array->bytes.data);
        if (status != Z_OK && status != Z_STREAM_END) return false;
    }
    return true;
}

static bool add_bytes(packed_array *array, const uint8_t *bytes, size_t size) {
    array->size += size;
    while (size > 0) {
        size_t step = size < STEP_MAX ? size : STEP_MAX;
        array->stream.next_in = bytes;
        array->stream.avail_in = (uInt)step;
        if (!compress_input(array, Z_NO_FLUSH)) return false;
        bytes += step;
        size -= step;
    }
    return true;
}

bool packed_array_add_bytes(packed_array *array, const uint8_t *bytes, size_t count) {
    return add_bytes(array, bytes, count);
}

static void store_bytes(uint8_t *bytes, uint64_t bits, size_t size) {
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(bits >> (8 * i));
}

bool packed_array_add_u32(packed_array *array, const uint32_t *values, size_t count) {
    uint8_t chunk[CHUNK_VALUES * 4];
    for (size_t done = 0; done < count;) {
        size_t step = count - done < CHUNK_VALUES ? count - done : CHUNK_VALUES;
        for (size_t i = 0; i < step; i++) store_bytes(chunk + 4 * i, values[done + i], 4);
        if (!add_bytes(array, chunk, 4 * step)) return false;
        done += step;
    }
    return true;
}

bool packed_array_add_f32(packed_array *array, const float *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        if (!packed_array_add_u32(array, &bits, 1)) return false;
    }
    return true;
}

bool packed_array_add_f64(packed_array *array, const double *values, size_t count) {
    for (size_t i = 0; i < count; i++) {
        uint8_t bytes[8];
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        store_bytes(bytes, bits, sizeof bytes);
        if (!add_bytes(array, bytes, sizeof bytes)) return false;
    }
    return true;
}

size_t packed_array_size(const packed_array *array) {
    return array->size;
}

bool packed_array_finish(packed_array *array) {
    if (array->finished) return true;
    array->stream.next_in = NULL;
    array->stream.avail_in = 0;
    array->finished = compress_input(array, Z_FINISH);
    return array->finished;
}

/* Three bytes become four characters; a last group of one or two is filled up with `=`. */
static void encode_group(const uint8_t *bytes, size_t count, char characters[4]) {
    static const char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    uint32_t bits = (uint32_t)bytes[0] << 16;
    if (count > 1) bits |= (uint32_t)bytes[1] << 8;
    if (count > 2) bits |= bytes[2];
    for (size_t i = 0; i < 4; i++) characters[i] = i <= count ? alphabet[bits >> (18 - 6 * i) & 63] : '=';
}

bool packed_array_write(const packed_array *array, FILE *file) {
    char text[CHUNK_VALUES * 4];
    const uint8_t *bytes = array->bytes.data;
    size_t size = array->bytes.count, length = 0;
    for (size_t i = 0; i < size; i += 3) {
        encode_group(bytes + i, size - i < 3 ? size - i : 3, text + length);
        length += 4;
        if (length < sizeof text && i + 3 < size) continue;
        if (fwrite(text, 1, length, file) != length) return false;
        length = 0;
    }
    return true;
}
