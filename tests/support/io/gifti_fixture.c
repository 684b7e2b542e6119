/* GIFTI files of a square, in every way that the format has. */
#include "tests/support/io/gifti_fixture.h"
#include "tests/support/test.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

enum { POINT_COUNT = 4, TRIANGLE_COUNT = 2 };

static void append_text(gifti_text *file, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void append_text(gifti_text *file, const char *format, ...) {
    const size_t used = strlen(file->text);
    va_list arguments;
    va_start(arguments, format);
    const int size = vsnprintf(file->text + used, sizeof file->text - used, format, arguments);
    va_end(arguments);
    assert_true(size >= 0 && used + (size_t)size < sizeof file->text);
}

/* The bits of a number in `size` bytes, the high ones first or last. */
static void put_bits(unsigned char *at, uint64_t bits, size_t size, bool big_endian) {
    for (size_t i = 0; i < size; i++) at[i] = (unsigned char)(bits >> 8 * (big_endian ? size - 1 - i : i));
}

static size_t put_number(unsigned char *at, double number, bool integer, gifti_style style) {
    const float single = (float)number;
    uint64_t bits;
    uint32_t half = (uint32_t)number;
    memcpy(&bits, &number, sizeof bits);
    if (!integer) memcpy(&half, &single, sizeof half);
    const size_t size = !integer && style.doubles ? 8 : 4;
    put_bits(at, size == 8 ? bits : half, size, style.big_endian);
    return size;
}

static size_t zip_bytes(unsigned char *bytes, size_t size, size_t room, bool gzip_header) {
    unsigned char packed[1024];
    z_stream stream = {
        .next_in = bytes, .avail_in = (unsigned)size, .next_out = packed, .avail_out = sizeof packed};
    assert_int_equal(deflateInit2(&stream, 9, Z_DEFLATED, gzip_header ? 31 : 15, 8, Z_DEFAULT_STRATEGY),
                     Z_OK);
    assert_int_equal(deflate(&stream, Z_FINISH), Z_STREAM_END);
    const size_t packed_size = sizeof packed - stream.avail_out;
    deflateEnd(&stream);
    assert_true(packed_size <= room);
    memcpy(bytes, packed, packed_size);
    return packed_size;
}

static void append_base64(gifti_text *file, const unsigned char *bytes, size_t size) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++) bits = bits << 8 | (i + k < size ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++)
            append_text(file, "%c", i + k > size ? '=' : digits[bits >> (18 - 6 * k) & 63]);
    }
}

static void append_array(gifti_text *file, const char *intent, bool integer, uint32_t rows,
                         const double *numbers, gifti_style style) {
    static const char *const encodings[] = {"ASCII", "Base64Binary", "GZipBase64Binary"};
    unsigned char bytes[1024];
    size_t size = 0;
    append_text(file,
                " <DataArray Intent=\"%s\" DataType=\"NIFTI_TYPE_%s\" ArrayIndexingOrder=\"%sMajorOrder\" "
                "Dimensionality=\"2\" Dim0=\"%u\" Dim1=\"3\"\n  Encoding=\"%s\" Endian=\"%sEndian\" "
                "ExternalFileName=\"\" ExternalFileOffset=\"\">\n  <MetaData/>\n  <Data>",
                intent,
                integer         ? "INT32"
                : style.doubles ? "FLOAT64"
                                : "FLOAT32",
                style.column_major ? "Column" : "Row", rows, encodings[style.encoding],
                style.big_endian ? "Big" : "Little");
    for (uint32_t i = 0; i < 3 * rows; i++) {
        const double number = numbers[style.column_major ? i % rows * 3 + i / rows : i];
        size += put_number(bytes + size, number, integer, style);
        if (style.encoding == 0)
            append_text(file, integer ? "%.0f%s" : "%.17g%s", number, i % 3 == 2 ? "\n   " : " ");
    }
    if (style.encoding == 2) size = zip_bytes(bytes, size, sizeof bytes, style.gzip_header);
    if (style.encoding > 0) append_base64(file, bytes, size);
    append_text(file, "</Data>\n </DataArray>\n");
}

void gifti_fixture_square(gifti_text *file, gifti_style style) {
    static const double square[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, other[] = {9, 9, 9};
    static const double triangles[] = {0, 1, 2, 0, 2, 3};
    file->text[0] = '\0';
    append_text(
        file,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE GIFTI SYSTEM "
        "\"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n<GIFTI Version=\"1.0\" "
        "NumberOfDataArrays=\"4\">\n <MetaData><MD><Name><![CDATA[Who]]></Name><Value><![CDATA[a<b]]>"
        "</Value></MD></MetaData>\n <LabelTable/>\n <DataArray Intent=\"NIFTI_INTENT_LABEL\" "
        "DataType=\"NIFTI_TYPE_INT32\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"1\" Dim0=\"4\" "
        "Encoding=\"ASCII\" Endian=\"LittleEndian\"><Data>1 2 3 4</Data></DataArray>\n");
    append_array(file, "NIFTI_INTENT_POINTSET", false, POINT_COUNT, square, style);
    append_array(file, "NIFTI_INTENT_TRIANGLE", true, TRIANGLE_COUNT, triangles, style);
    append_array(file, "NIFTI_INTENT_POINTSET", false, 1, other, style);
    append_text(file, "</GIFTI>\n");
}

file_bytes gifti_fixture_file(const gifti_text *file) {
    return (file_bytes){"lh.surf.gii", file->text, strlen(file->text)};
}
