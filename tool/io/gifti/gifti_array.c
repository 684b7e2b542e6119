/* The numbers of a GIFTI data array: as text, in base64, or zipped. */
#include "tool/io/gifti/gifti_array.h"

#include "tool/io/base64.h"
#include "tool/io/text.h"

#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

size_t gifti_type_size(gifti_type type) {
    return type == GIFTI_FLOAT64 ? 8 : 4;
}

static size_t expected_size(const gifti_array *array) {
    return (size_t)array->row_count * 3 * gifti_type_size(array->type);
}

static bool fail_size(const gifti_array *array, file_reader *reader, size_t found) {
    return file_reader_fail_here(reader, "the data have %zu bytes, expected %zu for %" PRIu32 " rows of 3",
                                 found, expected_size(array), array->row_count);
}

static bool reserve_bytes(growable *bytes, file_reader *reader, size_t size) {
    return growable_reserve(bytes, size) ||
           file_reader_fail_here(reader, "out of memory for %zu bytes", size);
}

/* ---- text -------------------------------------------------------------------------------------------- */

/* The next word of the text; false at its end. */
static bool next_word(const gifti_array *array, size_t *at, text_token *word) {
    static const char blanks[] = " \t\r\n";
    const char *text = array->text.data;
    const size_t size = array->text.count;
    while (*at < size && memchr(blanks, text[*at], sizeof blanks) != NULL) (*at)++;
    *word = (text_token){text + *at, 0};
    while (*at < size && memchr(blanks, text[*at], sizeof blanks) == NULL) (*at)++;
    word->length = (size_t)(text + *at - word->text);
    return word->length > 0;
}

static bool parse_word(const gifti_array *array, file_reader *reader, text_token word, unsigned char *out) {
    double number;
    int64_t integer;
    const bool whole = array->type == GIFTI_INT32;
    if (whole ? !text_parse_integer(word, &integer) || integer < INT32_MIN || integer > INT32_MAX
              : !text_parse_number(word, &number))
        return file_reader_fail_here(reader, "found '%s', expected %s", text_show(word).text,
                                     whole ? "a whole number" : "a number");
    const float single = whole ? 0 : (float)number;
    const int32_t small = whole ? (int32_t)integer : 0;
    const void *from = array->type == GIFTI_FLOAT64 ? (const void *)&number : &single;
    memcpy(out, whole ? &small : from, gifti_type_size(array->type));
    return true;
}

/* Decimals are rounded to the type that the array has. */
static bool decode_text(gifti_array *array, file_reader *reader) {
    const size_t count = (size_t)array->row_count * 3, size = gifti_type_size(array->type);
    text_token word;
    size_t at = 0;
    if (count > array->text.count) /* at least a digit each: so that a wrong number of rows takes no memory */
        return file_reader_fail_here(reader, "the data have %zu characters, expected %zu numbers",
                                     array->text.count, count);
    if (!reserve_bytes(&array->bytes, reader, expected_size(array))) return false;
    for (size_t i = 0; i < count; i++) {
        if (!next_word(array, &at, &word))
            return file_reader_fail_here(reader, "the data have %zu numbers, expected %zu", i, count);
        if (!parse_word(array, reader, word, (unsigned char *)array->bytes.data + i * size)) return false;
    }
    array->bytes.count = count * size;
    return !next_word(array, &at, &word) ||
           file_reader_fail_here(reader, "found '%s' after the last of %zu numbers", text_show(word).text,
                                 count);
}

/* ---- base64 and zlib --------------------------------------------------------------------------------- */

static bool decode_base64(const gifti_array *array, file_reader *reader, growable *bytes) {
    size_t wrong;
    if (!reserve_bytes(bytes, reader, base64_room(array->text.count))) return false;
    return base64_decode(array->text.data, array->text.count, bytes->data, &bytes->count, &wrong) ||
           file_reader_fail_here(reader, "the data are no base64 at character %zu", wrong);
}

static void *zip_allocate(void *user, unsigned count, unsigned size) {
    (void)user;
    return io_realloc(NULL, (size_t)count * size);
}

static void zip_free(void *user, void *memory) {
    (void)user;
    free(memory);
}

/* Unzips as many bytes as the rows need; a file that has more or fewer is refused. */
static bool unzip_bytes(const growable *packed, const gifti_array *array, file_reader *reader,
                        growable *out) {
    const size_t size = expected_size(array);
    z_stream stream = {.zalloc = zip_allocate, .zfree = zip_free};
    if (packed->count > UINT_MAX || size / 1100 > packed->count) /* zlib packs 1032 times at most */
        return fail_size(array, reader, packed->count);
    if (!reserve_bytes(out, reader, size + 1)) return false;
    if (inflateInit2(&stream, MAX_WBITS + 32) != Z_OK) /* of zlib or of gzip */
        return file_reader_fail_here(reader, "out of memory for unzipping");
    stream.next_in = packed->data;
    stream.avail_in = (unsigned)packed->count;
    int status = Z_OK;
    while (status == Z_OK && out->count <= size) {
        const size_t room = size + 1 - out->count;
        stream.next_out = (unsigned char *)out->data + out->count;
        stream.avail_out = room > UINT_MAX ? UINT_MAX : (unsigned)room;
        const unsigned before = stream.avail_out;
        status = inflate(&stream, Z_NO_FLUSH);
        out->count += before - stream.avail_out;
    }
    inflateEnd(&stream);
    if (status == Z_MEM_ERROR) return file_reader_fail_here(reader, "out of memory for unzipping");
    if (out->count == size && status == Z_STREAM_END) return true;
    if (status == Z_STREAM_END || out->count > size) return fail_size(array, reader, out->count);
    return file_reader_fail_here(reader, "the data cannot be unzipped: they are damaged or cut off");
}

static bool is_big_endian(void) {
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

static void swap_bytes(unsigned char *bytes, size_t count, size_t size) {
    for (size_t i = 0; i < count; i++, bytes += size)
        for (size_t k = 0; k < size / 2; k++) {
            const unsigned char kept = bytes[k];
            bytes[k] = bytes[size - 1 - k];
            bytes[size - 1 - k] = kept;
        }
}

static bool decode_binary(gifti_array *array, file_reader *reader) {
    growable packed = growable_of(1);
    const bool zipped = array->encoding == GIFTI_ZIPPED;
    bool done = decode_base64(array, reader, zipped ? &packed : &array->bytes);
    if (done && zipped) done = unzip_bytes(&packed, array, reader, &array->bytes);
    growable_free(&packed);
    if (done && array->bytes.count != expected_size(array))
        done = fail_size(array, reader, array->bytes.count);
    if (done && array->big_endian != is_big_endian())
        swap_bytes(array->bytes.data, (size_t)array->row_count * 3, gifti_type_size(array->type));
    return done;
}

/* ---- the interface ----------------------------------------------------------------------------------- */

bool gifti_array_decode(gifti_array *array, file_reader *reader) {
    reader->line = array->line;
    return array->encoding == GIFTI_ASCII ? decode_text(array, reader) : decode_binary(array, reader);
}

double gifti_array_number(const gifti_array *array, uint32_t row, uint32_t column) {
    const size_t place =
        array->column_major ? (size_t)column * array->row_count + row : (size_t)row * 3 + column;
    const unsigned char *at = (const unsigned char *)array->bytes.data + place * gifti_type_size(array->type);
    float single;
    double number = 0;
    int32_t integer;
    switch (array->type) {
    case GIFTI_FLOAT32:
        memcpy(&single, at, sizeof single);
        return (double)single;
    case GIFTI_FLOAT64:
        memcpy(&number, at, sizeof number);
        return number;
    case GIFTI_INT32:
        memcpy(&integer, at, sizeof integer);
        return integer;
    }
    return number;
}
