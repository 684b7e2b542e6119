/* Mesh files in text and binary: numbers to the last bit that meshes in use do not have, the stiffness of faces, failed allocations,
 * and damage to every byte. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"
#include "tool/io/text_encoding.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLY(literal) FILE_OF("mesh.ply", literal)
#define START        "ply\nformat ascii 1.0\n"
#define XYZ          "property float x\nproperty float y\nproperty float z\n"
#define CORNERS      "property list uchar int vertex_indices\n"
#define END          "end_header\n"

TEST(reads_numbers_exactly) {
    static const double positions[] = {0.1,
                                       -0.1,
                                       1e-300,
                                       1.7976931348623157e308,
                                       4.9406564584124654e-324,
                                       -0.0,
                                       1.0 / 3,
                                       1e23,
                                       .5,
                                       12345678901234567890.0,
                                       3,
                                       0x1.fffffffffffffp-1};
#define NUMBERS(line)                                                                                        \
    line "0.1 -.1 1E-300\n" line "1.7976931348623157e308 4.9406564584124654e-324 -0\n" line                  \
         "0.33333333333333331 1e+23 +.5\n" line                                                              \
         "12345678901234567890 3. 0.99999999999999988897769753748434595763683319091796875\n"
    static const uint32_t triangle[] = {0, 1, 2};
    mesh_check_equal(FILE_OF("mesh.obj", NUMBERS("v ") "f 1 2 3\n"), 4, positions, 1, triangle);
    mesh_check_equal(
        PLY(START "element vertex 4\n" XYZ "element face 1\n" CORNERS END NUMBERS("") "3 0 1 2\n"), 4,
        positions, 1, triangle);
}

#define LABELLED(before, behind, faces)                                                                      \
    PLY(START "element vertex 4\n" XYZ "element face 4\n" before CORNERS behind END                          \
              "0 0 0\n1 0 0\n1 1 0\n0 1 0\n" faces)

static void check_stiffness(file_bytes file, const double *expected) {
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_check_read(file, &mesh, &error)) fail_msg("refused: %s", error.text);
    assert_int_equal(mesh.triangle_count, 4);
    if (expected == NULL)
        assert_null(mesh.stiffness);
    else
        assert_memory_equal(mesh.stiffness, expected, 4 * sizeof *expected);
    mesh_file_free(&mesh);
}

/* A face's stiffness goes to the triangles that it is cut into, and those that are left out take theirs with them. */
TEST(reads_stiffness) {
    static const double expected[] = {0.5, 0.5, 2.0, -1.0}, whole[] = {5.0, 5.0, 2.0, 1.0};
    check_stiffness(
        LABELLED("property double stiffness\n", "", "7 3 0 0 2\n.5 4 0 1 2 3\n2 3 0 1 2\n-1 3 0 2 3\n"),
        expected);
    check_stiffness(LABELLED("", "property float stiffness\nproperty float stiffness\n",
                             "3 0 0 2 7 1\n4 0 1 2 3 .5 1\n3 0 1 2 2 1\n3 0 2 3 -1 1\n"),
                    expected);
    check_stiffness(
        LABELLED("property int stiffness\n", "", "7 3 0 0 2\n5 4 0 1 2 3\n2 3 0 1 2\n1 3 0 2 3\n"), whole);
    check_stiffness(LABELLED("property list uchar float stiffness\n", "",
                             "0 3 0 0 2\n0 4 0 1 2 3\n0 3 0 1 2\n0 3 0 2 3\n"),
                    NULL);
}

TEST(survives_damage) {
    static const file_bytes files[] = {
        FILE_OF("mesh.obj", "# a\r\nv 0 0 0\nv 1 .5e1 \\\n-2\nv 1 1 0 1\nvn 1 0 0\nv 0 1 0\nf 1 2/1 3//2 4\n"
                            "f -4/1/1 -2 -1\n"),
        FILE_OF("mesh.off",
                "# a\nOFF 4 2 0\r\n0 0 0\n1 0.5e1 -2\n\n1 1 0 1 1 1\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 2 1\n"),
        FILE_OF("mesh", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"),
        FILE_OF("mesh.stl", "solid s\nfacet outer loop vertex 0 0 0 vertex 1 0 0\nvertex 1 1 0 endloop "
                            "endfacet\nendsolid s\n"),
        PLY(START "element vertex 3\n" XYZ "element face 1\nproperty int part\n" CORNERS END
                  "0 0 0\n1 0 0\n1 1 0\n7 3 0 1 2\n"),
        PLY("ply\r\nformat ascii 1.0\nelement e 1\nproperty list uchar int a\nelement vertex 4\n" XYZ
            "property uchar q\nelement face 2\n" CORNERS "property char r\n" END
            "2 1 2\n0 0 0 1\n1 0 1e1 2\n1 1 0 3\n0 1 .5 4\n4 0 1 2 3 1\n3 0 1 2 2\n"),
        LABELLED("", "property float stiffness\n", "3 0 1 2 1\n4 0 1 2 3 2\n3 0 1 2 3\n3 0 2 3 4\n")};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) mesh_check_damage(files[i]);
}

static void put_bytes(char *file, size_t *size, const void *bytes, size_t count, bool turned) {
    for (size_t i = 0; i < count; i++) file[(*size)++] = ((const char *)bytes)[turned ? count - 1 - i : i];
}

/* A square of two faces, in the byte order of this machine or in the other one; numbers of an STL file are those of x86. */
TEST(binary_files_survive_damage) {
    static const float points[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int corners[] = {0, 1, 2, 0, 2, 3};
    static const uint16_t entries[] = {1, 2};
    char file[1000] = "solid";
    size_t size = 80;
    put_bytes(file, &size, &(uint32_t){2}, 4, false);
    for (int i = 0; i < 18; i++) {
        if (i % 9 == 0) size += 12;
        put_bytes(file, &size, &points[3 * corners[i / 3] + i % 3], 4, false);
        if (i % 9 == 8) size += 2;
    }
    mesh_check_damage((file_bytes){"mesh.stl", file, size});
    for (int big = 0; big < 2; big++) {
        size =
            (size_t)snprintf(file, sizeof file,
                             "ply\nformat binary_%s_endian 1.0\nelement e 1\nproperty list uchar short a\n"
                             "element vertex 4\n" XYZ "element face 2\n" CORNERS "property uchar red\n" END,
                             big ? "big" : "little");
        put_bytes(file, &size, "\2", 1, false);
        for (int i = 0; i < 2; i++) put_bytes(file, &size, &entries[i], 2, big);
        for (int i = 0; i < 12; i++) put_bytes(file, &size, &points[i], 4, big);
        for (int i = 0; i < 6; i++) {
            if (i % 3 == 0) put_bytes(file, &size, "\3", 1, false);
            put_bytes(file, &size, &corners[i], 4, big);
            if (i % 3 == 2) put_bytes(file, &size, "\7", 1, false);
        }
        mesh_check_damage((file_bytes){"mesh.ply", file, size});
    }
}

TEST(texts_of_two_bytes_are_no_marks) {
    assert_int_equal(text_mark_size("\xef\xbb", 2), 0);
    assert_false(text_is_utf16("\xff\xfe", 2));
    assert_false(text_is_utf16("\xff\xfe\0\0\0\0\0\0\0\0", 10));
}
