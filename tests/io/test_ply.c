/* PLY meshes: headers, the data in text, and each error with its line. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <stdlib.h>

#define PLY(literal) FILE_OF("mesh.ply", literal)
#define START        "ply\nformat ascii 1.0\n"
#define XYZ          "property float x\nproperty float y\nproperty float z\n"
#define CORNERS      "property list uchar int vertex_indices\n"
#define END          "end_header\n"
#define HEADER       START "element vertex 4\n" XYZ "element face 2\n" CORNERS END /* lines 1 to 9 */
#define VERTICES     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define FACES        "3 0 1 2\n3 0 2 3\n"

TEST(reads_text) {
    mesh_check_square(PLY(HEADER VERTICES FACES));
    mesh_check_square(PLY(HEADER "\n" VERTICES "\n\n3 0 1 2\n 3\t0  2 3 \n\n"));
    mesh_check_square(
        PLY(START "element vertex 4\n" XYZ "element face 1\n" CORNERS END VERTICES "4 0 1 2 3"));
    mesh_check_square(
        PLY("ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\n"
            "property float z\r\nelement face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
            "0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n"));
    mesh_check_square(
        PLY("ply\rformat ascii 1.0\relement vertex 4\rproperty float x\rproperty float y\r"
            "property float z\relement face 1\rproperty list uchar int vertex_index\rend_header\r"
            "0 0 0\r1 0 0\r1 1 0\r0 1 0\r4 0 1 2 3\r"));
    mesh_check_square(FILE_OF("mesh.obj", HEADER VERTICES FACES));
    mesh_check_square(FILE_OF("mesh", HEADER VERTICES FACES));
}

TEST(reads_all_type_names) {
    mesh_check_square(
        PLY(START "comment all types\nobj_info of PLY\nelement vertex 4\nproperty char a\n"
                  "property int8 b\nproperty uchar c\nproperty uint8 d\nproperty short e\n"
                  "property int16 f\nproperty ushort g\nproperty uint16 h\nproperty int i\n"
                  "property int32 j\nproperty uint k\nproperty uint32 l\nproperty float m\n"
                  "property float32 n\nproperty double o\nproperty float64 x\nproperty double y\n"
                  "comment z is an integer\nproperty int8 z\nelement face 1\n"
                  "property list uint32 double vertex_index\n" END
                  "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 0 0 0\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 1 0 0\n"
                  "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 1 1 0\n1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 0 1 0\n"
                  "4 0 1 2 3\n"));
}

TEST(skips_what_is_not_the_mesh) {
    mesh_check_square(PLY(
        START
        "element camera 2\nproperty list uchar float m\nproperty double far\nelement nothing 1000000000000\n"
        "element face 2\nproperty uchar red\n" CORNERS "property list int float uv\n"
        "element edge 1\nproperty int vertex1\nproperty list char int vertex_indices\n"
        "element vertex 4\nproperty float quality\nproperty float z\nproperty list uchar int ring\n"
        "property double y\nproperty float x\nproperty uchar red\nelement material 1\nproperty int kind\n" END
        "3 1 2 nan 1e9\n0 7\n255 3 0 1 2 2 0.5 0.5\n0 3 0 2 3 0\n9 2 8 7\n"
        "1 0 2 5 6 0 0 9\n1 0 0 0 1 9\nx 0 1 4 1 1 9\n1 0 0 1 0 9\n4\n"));
}

TEST(reads_numbers_exactly) {
    static const double positions[] = {
        0.1, -1e-300, 1.7976931348623157e308, 1.0 / 3, 4.9406564584124654e-324, -0.0, 1, 2, 3};
    static const uint32_t triangles[] = {2, 1, 0};
    mesh_check_equal(PLY(START
                         "element vertex 3\n" XYZ "element face 1\n" CORNERS END
                         ".1 -1e-300 1.7976931348623157e308\n0.33333333333333331 4.9406564584124654e-324 -0\n"
                         "1 +2 3.\n3 2 1 0\n"),
                     3, positions, 1, triangles);
}

TEST(refuses_bad_headers) {
    mesh_check_error(PLY("plywood\n"), ":1: ", "found 'plywood'", "expected ply");
    mesh_check_error(PLY("\nply\n"), ":1: ", "the line ends", "expected ply");
    mesh_check_error(PLY("\xff\xfe\0\1garbage"), ":1: ", "found '????garbage'", "expected ply");
    mesh_check_error(PLY("ply ply\n"), ":1: ", "found 'ply'", "end of the line");
    mesh_check_error(PLY("ply\n"), ":2: ", "file ends inside the header", "end_header");
    mesh_check_error(PLY("ply\nfromat ascii 1.0\n"), ":2: ", "found 'fromat'", "format, comment");
    mesh_check_error(PLY("ply\nformat binary 1.0\n"), ":2: ", "found 'binary'",
                     "ascii, binary_little_endian");
    mesh_check_error(PLY("ply\nformat\n"), ":2: ", "the line ends", "ascii, binary_little_endian");
    mesh_check_error(PLY("ply\nformat ascii 2.0\n"), ":2: ", "found '2.0'", "version 1.0");
    mesh_check_error(PLY(START "format ascii 1.0\n"), ":3: ", "a second format", "expected one");
    mesh_check_error(PLY("ply\nend_header\n"), ":2: ", "the header ends", "a format line");
    mesh_check_error(PLY(START "element\n"), ":3: ", "the line ends", "an element name");
    mesh_check_error(PLY(START "element vertex\n"), ":3: ", "the line ends", "the number of elements");
    mesh_check_error(PLY(START "element vertex many\n"), ":3: ", "found 'many'", "the number of elements");
    mesh_check_error(PLY(START "element vertex 4 4\n"), ":3: ", "found '4'", "end of the line");
    mesh_check_error(PLY(START "element vertex 1\nelement vertex 1\n"), ":4: ", "a second element 'vertex'",
                     "one");
    mesh_check_error(PLY(START END), ":3: ", "the header ends", "an element 'vertex'");
    mesh_check_error(PLY(START "element vertex 4\n" XYZ END), ":7: ", "the header ends", "an element 'face'");
}

TEST(refuses_bad_properties) {
    mesh_check_error(PLY(START "property float x\n"), ":3: ", "a property before any element", "");
    mesh_check_error(PLY(START "element a 1\nproperty real x\n"), ":4: ", "found 'real'", "a type: char");
    mesh_check_error(PLY(START "element a 1\nproperty list float int x\n"), ":4: ", "found 'float'",
                     "an integer type for the length");
    mesh_check_error(PLY(START "element a 1\nproperty list uchar\n"), ":4: ", "the line ends",
                     "a type: char");
    mesh_check_error(PLY(START "element a 1\nproperty int\n"), ":4: ", "the line ends", "a property name");
    mesh_check_error(PLY(START "element vertex 1\nproperty list uchar float x\n"),
                     ":4: ", "property 'x' is a list", "expected one number");
    mesh_check_error(PLY(START "element face 1\nproperty int vertex_indices\n"),
                     ":4: ", "property 'vertex_indices' is no list", "expected a list");
    mesh_check_error(PLY(START "element vertex 1\n" XYZ "property double y\n"),
                     ":7: ", "a second property 'y'", "expected one");
    mesh_check_error(PLY(START "element vertex 1\nproperty float x\nproperty float z\n" END),
                     ":6: ", "element 'vertex' lacks", "property 'y'");
    mesh_check_error(PLY(START "element vertex 1\n" XYZ "element face 1\n" END),
                     ":8: ", "element 'face' lacks", "property 'vertex_indices'");
}

TEST(refuses_bad_rows) {
    mesh_check_error(PLY(HEADER "0 0 0\n1 0\n1 1 0\n"), ":11: ", "the line ends inside vertex 2 of 4",
                     "expected its property 'z'");
    mesh_check_error(PLY(HEADER "0 0 0 0\n"), ":10: ", "found '0'", "the end of the line");
    mesh_check_error(PLY(HEADER "0 0 0\n1 o 0\n"), ":11: ", "found 'o'", "a number for property 'y'");
    mesh_check_error(PLY(HEADER "0 0 0\n1 0 nan\n"), ":11: ", "coordinate z of vertex 1 is nan", "finite");
    mesh_check_error(PLY(HEADER "1e999 0 0\n"), ":10: ", "coordinate x of vertex 0 is inf", "finite");
    mesh_check_error(PLY(HEADER VERTICES "3 0 1\n"), ":14: ", "the line ends inside face 1 of 2",
                     "property 'vertex_indices'");
    mesh_check_error(PLY(HEADER VERTICES "3 0 1 2.5\n"), ":14: ", "found '2.5'", "an integer");
    mesh_check_error(PLY(HEADER VERTICES "2 0 1\n1 0\n"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(PLY(HEADER VERTICES "0\n0\n"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(PLY(HEADER VERTICES "-1\n"), ":14: ", "'vertex_indices' has -1 entries", "0 or more");
    mesh_check_error(PLY(HEADER VERTICES "3 0 1 4\n"), ":14: ", "face index 4 is out of range",
                     "the file has 4 vertices");
    mesh_check_error(PLY(HEADER VERTICES "3 0 1 -1\n"), ":14: ", "face index -1 is out of range",
                     "the file has 4 vertices");
    mesh_check_error(PLY(HEADER VERTICES FACES "3 0 1 2\n"), ":16: ", "found '3' after the last element",
                     "the end of the file");
    mesh_check_error(PLY(START "element vertex 4\n" XYZ
                               "element face 1\nproperty list int float vertex_index\n" END VERTICES
                               "3 0 1 1.5\n"),
                     ":14: ", "face index 1.5", "expected an integer");
}

TEST(refuses_counts_that_do_not_fit) {
    mesh_check_error(PLY(HEADER "0 0 0\n1 0 0\n"), ":12: ", "file ends inside vertex 3 of 4", "");
    mesh_check_error(PLY(HEADER "0 0 0\n1 0"), ":11: ", "file ends inside vertex 2 of 4", "");
    mesh_check_error(PLY(HEADER VERTICES "3 0 1 2\n"), ":15: ", "file ends inside face 2 of 2", "");
    mesh_check_error(PLY(START "element vertex 2000000000\n" XYZ "element face 2\n" CORNERS END VERTICES),
                     ":14: ", "file ends inside vertex 5 of 2000000000", "");
    mesh_check_error(PLY(START "element vertex -4\n"), ":3: ", "-4 elements 'vertex'", "0 to 2147483647");
    mesh_check_error(PLY(START "element face 2147483648\n"), ":3: ", "2147483648 elements 'face'",
                     "2147483647");
    mesh_check_error(PLY(START "element edge 9999999999999999999\n"), ":3: ", "found '9999999999999999999'",
                     "the number of elements");
    mesh_check_error(PLY(START "element vertex 0\n" XYZ "element face 0\n" CORNERS END), ": ", "no vertices",
                     "expected a triangle mesh");
    mesh_check_error(PLY(START "element vertex 4\n" XYZ "element face 0\n" CORNERS END VERTICES), ": ",
                     "no faces found for the 4 vertices", "expected a triangle mesh");
}

TEST(survives_damage) {
    mesh_check_damage(PLY(START "element vertex 3\n" XYZ "element face 1\nproperty int part\n" CORNERS END
                                "0 0 0\n1 0 0\n1 1 0\n7 3 0 1 2\n"));
    mesh_check_damage(
        PLY("ply\r\nformat ascii 1.0\nelement e 1\nproperty list uchar int a\nelement vertex 4\n" XYZ
            "property uchar q\nelement face 2\n" CORNERS "property char r\n" END
            "2 1 2\n0 0 0 1\n1 0 1e1 2\n1 1 0 3\n0 1 .5 4\n4 0 1 2 3 1\n3 0 1 2 2\n"));
}

/* A face's integer part or label, before its corners or behind them, names its part. */
TEST(names_parts) {
#define LABELLED(before, behind, faces)                                                                      \
    PLY(START "element vertex 4\n" XYZ "element face 4\n" before CORNERS behind END VERTICES faces)
    static const uint32_t labels[] = {0, 1, 1, 1, 0};
    const char *const names[] = {"3", "-7", NULL}, *const none[] = {NULL};
    mesh_check_parts(
        LABELLED("property uchar label\n", "", "3 3 0 1 2\n-7 4 0 1 2 3\n-7 3 0 1 2\n3 3 0 2 3\n"), names,
        labels);
    mesh_check_parts(LABELLED("", "property int part\n", "3 0 1 2 3\n4 0 1 2 3 -7\n3 0 1 2 -7\n3 0 2 3 3\n"),
                     names, labels);
    mesh_check_parts(LABELLED("property int part\n", "property int label\n",
                              "3 3 0 1 2 3\n-7 4 0 1 2 3 9\n-7 3 0 1 2 9\n3 3 0 2 3 9\n"),
                     names, labels);
    mesh_check_parts(LABELLED("property float label\n", "", "3 3 0 1 2\n1 4 0 1 2 3\n1 3 0 1 2\n3 3 0 2 3\n"),
                     none, NULL);
    mesh_check_parts(
        LABELLED("property list uchar int part\n", "", "0 3 0 1 2\n0 4 0 1 2 3\n0 3 0 1 2\n0 3 0 2 3\n"),
        none, NULL);
    mesh_check_error(LABELLED("", "property int part\n", "3 0 1 2 x\n"), ":15: ", "found 'x'", "an integer");
}

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
    mesh_check_error(LABELLED("", "property float stiffness\n", "3 0 1 2 x\n"), ":15: ", "found 'x'",
                     "a number");
    mesh_check_damage(
        LABELLED("", "property float stiffness\n", "3 0 1 2 1\n4 0 1 2 3 2\n3 0 1 2 3\n3 0 2 3 4\n"));
}
