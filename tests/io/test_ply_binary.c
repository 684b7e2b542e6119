/* Binary PLY meshes: every type in both byte orders, and each error with its byte offset. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct byte_writer {
    bool big_endian;
    size_t size;
    size_t data_start; /* the first byte behind the header */
    char bytes[4096];
} byte_writer;

static void put_bits(byte_writer *writer, size_t size, uint64_t bits) {
    assert_true(writer->size + size <= sizeof writer->bytes);
    for (size_t i = 0; i < size; i++) {
        size_t shift = 8 * (writer->big_endian ? size - 1 - i : i);
        writer->bytes[writer->size++] = (char)(bits >> shift & 0xff);
    }
}

static void put_value(byte_writer *writer, char type, double value) {
    float single_value = (float)value;
    uint32_t single_bits;
    uint64_t double_bits;
    memcpy(&single_bits, &single_value, sizeof single_bits);
    memcpy(&double_bits, &value, sizeof double_bits);
    switch (type) {
    case 'c':
        put_bits(writer, 1, (uint64_t)(int64_t)value);
        break;
    case 's':
        put_bits(writer, 2, (uint64_t)(int64_t)value);
        break;
    case 'i':
        put_bits(writer, 4, (uint64_t)(int64_t)value);
        break;
    case 'f':
        put_bits(writer, 4, single_bits);
        break;
    default:
        put_bits(writer, 8, double_bits);
    }
}

/* Writes one value per letter: c, s and i are integers of 1, 2 and 4 bytes, f is float and d is double. */
static void put_values(byte_writer *writer, const char *types, ...) {
    va_list values;
    va_start(values, types);
    for (; *types != '\0'; types++) put_value(writer, *types, va_arg(values, double));
    va_end(values);
}

static byte_writer begin_file(bool big_endian, const char *lines) {
    byte_writer writer = {.big_endian = big_endian};
    int size = snprintf(writer.bytes, sizeof writer.bytes, "ply\nformat binary_%s_endian 1.0\n%send_header\n",
                        big_endian ? "big" : "little", lines);
    assert_true(size > 0 && (size_t)size < sizeof writer.bytes);
    writer.size = writer.data_start = (size_t)size;
    return writer;
}

static file_bytes file_of(const byte_writer *writer) {
    return (file_bytes){"mesh.ply", writer->bytes, writer->size};
}

#define XYZ          "property float x\nproperty float y\nproperty float z\n"
#define CORNERS      "property list uchar int vertex_indices\n"
#define SQUARE_LINES "element vertex 4\n" XYZ "element face 2\n" CORNERS

static void put_square_vertices(byte_writer *writer) {
    put_values(writer, "ffffff", 0., 0., 0., 1., 0., 0.);
    put_values(writer, "ffffff", 1., 1., 0., 0., 1., 0.);
}

static byte_writer square_file(bool big_endian) {
    byte_writer writer = begin_file(big_endian, SQUARE_LINES);
    put_square_vertices(&writer);
    put_values(&writer, "ciiiciii", 3., 0., 1., 2., 3., 0., 2., 3.);
    return writer;
}

TEST(reads_both_byte_orders) {
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        byte_writer writer = square_file(big_endian);
        mesh_check_square(file_of(&writer));
        put_values(&writer, "cc", 0., (double)'\n'); /* padding */
        mesh_check_square(file_of(&writer));
    }
}

TEST(reads_all_types) {
    static const double positions[] = {0.1f, 0.1, -128, 255, -1.0 / 3, 127, 1, 65535, -1};
    static const uint32_t triangles[] = {2, 1, 0};
    static const char *const index_types[] = {"char", "uint8",  "short", "ushort",
                                              "int",  "uint32", "float", "double"};
    static const char index_letters[] = "ccssiifd";
    for (size_t i = 0; i < sizeof index_types / sizeof *index_types; i++) {
        char lines[512];
        snprintf(lines, sizeof lines,
                 "element vertex 3\nproperty float x\nproperty double y\nproperty char z\n"
                 "element face 1\nproperty list int %s vertex_index\n",
                 index_types[i]);
        for (int big_endian = 0; big_endian < 2; big_endian++) {
            byte_writer writer = begin_file(big_endian, lines);
            char types[] = "i???";
            memset(types + 1, index_letters[i], 3);
            put_values(&writer, "fdcfdcfdc", 0.1, 0.1, -128., 255., -1.0 / 3, 127., 1., 65535., -1.);
            put_values(&writer, types, 3., 2., 1., 0.);
            mesh_check_equal(file_of(&writer), 3, positions, 1, triangles);
        }
    }
}

TEST(reads_integer_coordinates) {
    static const double positions[] = {-32768, 65535, 4294967295.0, 32767, 1, 2147483648.0, -1, 0, 3};
    static const uint32_t triangles[] = {0, 1, 2};
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        byte_writer writer =
            begin_file(big_endian, "element vertex 3\nproperty short x\nproperty ushort y\nproperty uint z\n"
                                   "element face 1\n" CORNERS);
        put_values(&writer, "ssissi", -32768., 65535., 4294967295., 32767., 1., 2147483648.);
        put_values(&writer, "ssiciii", -1., 0., 3., 3., 0., 1., 2.);
        mesh_check_equal(file_of(&writer), 3, positions, 1, triangles);
    }
}

TEST(skips_what_is_not_the_mesh) {
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        byte_writer writer = begin_file(
            big_endian, "element a 2\nproperty list short double l\nproperty short s\nelement b 99999999999\n"
                        "element face 1\nproperty double n\n" CORNERS "property list uchar char uv\n"
                        "element c 3\nproperty uchar v\nelement vertex 4\nproperty list int int ring\n" XYZ
                        "property uchar red\nelement d 1\nproperty list ushort float last\n");
        put_values(&writer, "sddsss", 2., NAN, 1., 7., 0., 8.);
        put_values(&writer, "dciiiiccc", INFINITY, 4., 0., 1., 2., 3., 2., 9., 9.);
        put_values(&writer, "ccc", 1., 2., 3.);
        put_values(&writer, "iiifffc", 2., 5., 6., 0., 0., 0., 255.);
        put_values(&writer, "ifffc", 0., 1., 0., 0., 255.);
        put_values(&writer, "ifffc", 0., 1., 1., 0., 255.);
        put_values(&writer, "iifffc", 1., 9., 0., 1., 0., 255.);
        put_values(&writer, "sfff", 3., 1., 2., 3.);
        mesh_check_square(file_of(&writer));
    }
}

/* Data may begin with bytes that look like line ends. */
TEST(finds_the_first_byte_of_the_data) {
    static const double positions[] = {10, 0, 0, 13, 0, 0, 0, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2};
    static const char *const line_ends[] = {"\n", "\r\n", "\r"};
    for (int i = 0; i < 3; i++) {
        byte_writer writer = {0};
        const char *e = line_ends[i];
        int size = snprintf(
            writer.bytes, sizeof writer.bytes,
            "ply%sformat binary_little_endian 1.0%selement vertex 3%sproperty char x%sproperty char y%s"
            "property char z%selement face 1%sproperty list char char vertex_index%send_header%s",
            e, e, e, e, e, e, e, e, e);
        writer.size = (size_t)size;
        put_values(&writer, "ccccccccc", 10., 0., 0., 13., 0., 0., 0., 1., 0.);
        put_values(&writer, "cccc", 3., 0., 1., 2.);
        mesh_check_equal(file_of(&writer), 3, positions, 1, triangles);
    }
}

static void check_error_at(const byte_writer *writer, size_t offset, const char *found,
                           const char *expected) {
    char place[64];
    snprintf(place, sizeof place, ": byte %zu: ", writer->data_start + offset);
    mesh_check_error(file_of(writer), place, found, expected);
}

TEST(refuses_bad_vertices) {
    byte_writer writer = begin_file(false, SQUARE_LINES);
    put_values(&writer, "ffffff", 0., 0., 0., 1., (double)NAN, 0.);
    check_error_at(&writer, 12, "coordinate y of vertex 1 is nan", "finite");
    writer = begin_file(true, SQUARE_LINES);
    put_values(&writer, "fff", 0., 0., (double)-INFINITY);
    check_error_at(&writer, 0, "coordinate z of vertex 0 is -inf", "finite");
}

/* Asserts the error for a file whose first face has these bytes and the given types. */
static void check_face_error(const char *corners, size_t offset, const char *found, const char *expected,
                             const char *types, double length, double a, double b, double c) {
    char lines[512];
    snprintf(lines, sizeof lines, "element vertex 4\n" XYZ "element face 2\n%s", corners);
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        byte_writer writer = begin_file(big_endian, lines);
        put_square_vertices(&writer);
        put_values(&writer, types, length, a, b, c);
        check_error_at(&writer, 48 + offset, found, expected);
    }
}

TEST(refuses_bad_faces) {
    const char *floats = "property list char float vertex_indices\n";
    check_face_error(CORNERS, 9, "face index 4 is out of range", "has 4 vertices", "ciii", 3, 0, 1, 4);
    check_face_error(CORNERS, 5, "face index -1 is out of range", "has 4 vertices", "ciii", 3, 0, -1, 2);
    check_face_error(floats, 0, "'vertex_indices' has -3 entries", "0 or more", "cfff", -3, 0, 1, 2);
    check_face_error(floats, 5, "face index 1.5", "an integer", "cfff", 3, 0, 1.5, 2);
    check_face_error(floats, 1, "face index nan is out of range", "has 4 vertices", "cfff", 3, NAN, 1, 2);
}

TEST(refuses_counts_that_do_not_fit) {
    byte_writer writer = square_file(false);
    writer.size -= 1;
    check_error_at(&writer, 73, "file ends inside face 2 of 2", "");
    writer.size = writer.data_start + 30;
    check_error_at(&writer, 30, "file ends inside vertex 3 of 4", "");
    writer = square_file(true);
    put_values(&writer, "cs", 1., 0.);
    check_error_at(&writer, 74, "3 bytes follow the last element", "end of the file");

    writer = begin_file(false, "element vertex 2147483647\n" XYZ "element face 2\n" CORNERS);
    put_square_vertices(&writer);
    check_error_at(&writer, 48, "file ends inside vertex 5 of 2147483647", "");
    writer = begin_file(false, "element a 1\nproperty list uint double l\n" SQUARE_LINES);
    put_values(&writer, "iddd", 4294967295., 1., 2., 3.);
    check_error_at(&writer, 28, "file ends inside a 1 of 1", "");
    writer =
        begin_file(false, "element vertex 4\n" XYZ "element face 1\nproperty list uint uint vertex_index\n");
    put_square_vertices(&writer);
    put_values(&writer, "iiii", 4294967295., 1., 2., 3.);
    check_error_at(&writer, 64, "file ends inside face 1 of 1", "");
}

TEST(survives_damage) {
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        byte_writer writer = begin_file(big_endian, "element e 1\nproperty list uchar short a\n" SQUARE_LINES
                                                    "property uchar red\n");
        put_values(&writer, "css", 2., 1., 2.);
        put_square_vertices(&writer);
        put_values(&writer, "ciiicciiic", 3., 0., 1., 2., 7., 3., 0., 2., 3., 8.);
        mesh_check_damage(file_of(&writer));
    }
}
