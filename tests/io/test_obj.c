/* OBJ meshes: every form of record and index, exact numbers, and each error with its line. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OBJ(literal) FILE_OF("mesh.obj", literal)
#define SQUARE       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

TEST(reads_all_index_forms) {
    mesh_check_square(OBJ(SQUARE "f 1 2 3\nf 1 3 4\n"));
    mesh_check_square(OBJ(SQUARE "vt 0 0\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n"));
    mesh_check_square(OBJ(SQUARE "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n"));
    mesh_check_square(OBJ(SQUARE "f 1/1/1 2/2/2 3/3/3\nf 1/1/1 3/3/3 4/4/4\n"));
    mesh_check_square(OBJ(SQUARE "f -4 -3 -2\nf -4/-4/-4 -2//-2 -1/-1\n"));
    mesh_check_square(OBJ(SQUARE "f 1/ 2// 3\nf 1 +3 4\n"));
}

TEST(reads_polygons_as_fans) {
    static const double positions[] = {0, 0, 0, 2, 0, 0, 3, 1, 0, 2, 2, 0, 0, 2, 0};
    static const uint32_t triangles[] = {4, 0, 1, 4, 1, 2, 4, 2, 3};
    mesh_check_square(OBJ(SQUARE "f 1 2 3 4\n"));
    mesh_check_equal(OBJ("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 5 1 2 3 4\n"), 5, positions, 3,
                     triangles);
}

TEST(reads_negative_indices_from_where_the_face_is) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5};
    mesh_check_equal(OBJ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"), 6,
                     positions, 2, triangles);
}

TEST(reads_faces_ahead_of_their_vertices) {
    mesh_check_square(OBJ("f 1 2 3\nf 1 3 4\n" SQUARE));
}

TEST(reads_layouts) {
    mesh_check_square(OBJ("# a square\r\n\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n"));
    mesh_check_square(OBJ("v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4"));
    mesh_check_square(OBJ("\xef\xbb\xbf" SQUARE "f 1 2 3 4"));
    mesh_check_square(OBJ("\t v\t0  0 0 \n v 1 0 0 # one\n v 1 1 0 # two\nv 0 1 0\nf 1 2 3 4 # five\n"));
    mesh_check_square(OBJ("v 0 0 \\\n0\nv \\\r\n1 0 0\nv 1 1 0\nv 0 1\\\n 0\nf 1 2 \\\n  3 \\\n4\n"));
    /* A comment that ends in a backslash does not go on; another record does. */
    mesh_check_square(
        OBJ("# in C:\\meshes\\\nv 0 0 0\nvn 1 2 \\\nv 9 9 9\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
    mesh_check_square(
        OBJ("mtllib a.mtl\no square\nv 0 0 0 1\nv 1 0 0 0.5\nv 1 1 0 0.2 0.3 0.4\nv 0 1 0 1 1 1\n"
            "vp 1 2\nvt 1\nvn 0 0 1\ng all\nusemtl red\ns off\nl 1 2\np 1\nf 1 2 3 4\nfoo\n"));
}

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
    static const uint32_t triangles[] = {0, 1, 2};
    mesh_check_equal(OBJ("v 0.1 -.1 1E-300\n"
                         "v 1.7976931348623157e308 4.9406564584124654e-324 -0\n"
                         "v 0.33333333333333331 1e+23 +.5\n"
                         "v 12345678901234567890 3. 0.99999999999999988897769753748434595763683319091796875\n"
                         "f 1 2 3\n"),
                     4, positions, 1, triangles);
}

TEST(refuses_bad_vertices) {
    mesh_check_error(OBJ("v 0 0 0\nv 1 0\nv 0 1 0\n"), ":2: ", "the line ends", "coordinate z of the vertex");
    mesh_check_error(OBJ("v 0 0 0\n\n# c\nv"), ":4: ", "the file ends", "coordinate x of the vertex");
    mesh_check_error(OBJ("v 0 0,5 0\n"), ":1: ", "found '0,5'", "coordinate y");
    mesh_check_error(OBJ("v 0 0 0x10\n"), ":1: ", "found '0x10'", "coordinate z");
    mesh_check_error(OBJ("v 0 1e 0\n"), ":1: ", "found '1e'", "coordinate y");
    mesh_check_error(OBJ("v 0 1\0002 0\n"), ":1: ", "found '1?2'", "coordinate y");
    mesh_check_error(OBJ("v 0 0 0\r\nv 0 nan 0\r\n"), ":2: ", "coordinate y of vertex 2 is nan", "finite");
    mesh_check_error(OBJ("v 0 0 -inf\n"), ":1: ", "coordinate z of vertex 1 is -inf", "finite");
    mesh_check_error(OBJ("v 1e309 0 0\n"), ":1: ", "coordinate x of vertex 1 is inf", "finite");
    mesh_check_error(OBJ("v 0 \\\n 0 \\\n q\n"), ":3: ", "found 'q'", "coordinate z");
}

TEST(refuses_bad_faces) {
    mesh_check_error(OBJ(SQUARE "f 1 2\n"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(OBJ(SQUARE "f 1\n"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(OBJ(SQUARE "f"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(OBJ(SQUARE "f 1 2 x\n"), ":5: ", "found 'x'", "v/vt/vn");
    mesh_check_error(OBJ(SQUARE "f 1 2 3/4/5/6\n"), ":5: ", "found '3/4/5/6'", "v/vt/vn");
    mesh_check_error(OBJ(SQUARE "f 1 2 3.5\n"), ":5: ", "found '3.5'", "v/vt/vn");
    mesh_check_error(OBJ(SQUARE "f 1 2 /3\n"), ":5: ", "found '/3'", "v/vt/vn");
    mesh_check_error(OBJ(SQUARE "f 1 2 -\n"), ":5: ", "found '-'", "v/vt/vn");
}

/* Faces that name a vertex twice are shortened, and dropped when fewer than three corners are left; the others keep their
 * numbers. */
TEST(repairs_faces) {
    static const uint32_t triangles[] = {0, 1, 2, 0, 1, 2, 0, 2, 3}, polygons[] = {0, 3, 3};
    mesh_file mesh = {0};
    io_error error = {""};
    assert_true(
        mesh_check_read(OBJ(SQUARE "f 1 2 3 3\nf 1 2 2\nf 3 -2 4\nf 1 2 3 3 4 4 1 1\n"), &mesh, &error));
    assert_int_equal(mesh.triangle_count, 3);
    assert_int_equal(mesh.polygon_count, 4);
    assert_memory_equal(mesh.triangles, triangles, sizeof triangles);
    assert_memory_equal(mesh.polygons, polygons, sizeof polygons);
    assert_int_equal(mesh.repairs.shortened, 2);
    assert_int_equal(mesh.repairs.first_shortened, 0);
    assert_int_equal(mesh.repairs.dropped, 2);
    assert_int_equal(mesh.repairs.first_dropped, 1);
    assert_int_equal(mesh.repairs.fanned, 0);
    mesh_file_free(&mesh);
    /* Fewer than three corners, and three that leave no triangle, since the way goes to the third and back. */
    assert_true(mesh_check_read(OBJ(SQUARE "f\nf 1 2\nf 1 2 3 4\nf 1 2 1 3\n"), &mesh, &error));
    assert_int_equal(mesh.triangle_count, 2);
    assert_int_equal(mesh.polygon_count, 4);
    assert_int_equal(mesh.polygons[0], 2);
    assert_int_equal(mesh.repairs.dropped, 3);
    assert_int_equal(mesh.repairs.first_dropped, 0);
    mesh_file_free(&mesh);
    mesh_check_error(OBJ(SQUARE "f 1 2 1 3\n"), ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(OBJ(SQUARE "f 1 2 2\n"), ": ", "no faces found", "expected a triangle mesh");
}

static void check_parts(const char *text, const char *const *names, const uint32_t *labels) {
    mesh_check_parts((file_bytes){"mesh.obj", text, strlen(text)}, names, labels);
}

/* Each of many names is one part, wherever it comes again. */
TEST(finds_many_names_again) {
    enum { NAMES = 3000 };
    char *text = malloc(60 * NAMES), number[16];
    mesh_file mesh = {0};
    io_error error = {""};
    size_t end = (size_t)sprintf(text, SQUARE);
    for (int i = 0; i < 2 * NAMES; i++)
        end += (size_t)sprintf(text + end, "o n%d\nf 1 2 3\n", i < NAMES ? i : 2 * NAMES - 1 - i);
    if (!mesh_check_read((file_bytes){"mesh.obj", text, end}, &mesh, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh.parts.count, NAMES);
    for (uint32_t i = 0; i < NAMES; i++) {
        snprintf(number, sizeof number, "n%u", i);
        assert_string_equal(mesh.parts.names[i], number);
        assert_int_equal(mesh.parts.of_triangle[i], i);
        assert_int_equal(mesh.parts.of_triangle[2 * NAMES - 1 - i], i);
    }
    mesh_file_free(&mesh);
    free(text);
}

TEST(names_parts) {
    const uint32_t none = NO_MESH_PART;
    check_parts(SQUARE "f 1 2 3\n", (const char *const[]){NULL}, NULL);
    check_parts(SQUARE "g default\nf 1 2 3\ng off\nf 1 2 3\n", (const char *const[]){NULL}, NULL);
    check_parts(SQUARE "f 1 2 3\no Body\nf 1 2 3 4\no Hat\nf 1 2 3\no Body\nf 1 3 4\n",
                (const char *const[]){"Body", "Hat", NULL}, (const uint32_t[]){none, 0, 0, 1, 0});
    check_parts(SQUARE "g Arm.L deform\nf 1 2 3\ng\nf 1 2 3\n", (const char *const[]){"Arm.L deform", NULL},
                (const uint32_t[]){0, none});
    check_parts(SQUARE "o Body\ng Arm\nf 1 2 3\ng (null)\nf 1 2 3\no Hat\nf 1 2 3\n",
                (const char *const[]){"Body/Arm", "Body", "Hat", NULL}, (const uint32_t[]){0, 1, 2});
    check_parts(SQUARE "o Empty\ng None\no Body\nf 1 2 3\no End\n", (const char *const[]){"Body", NULL},
                (const uint32_t[]){0});
}

static void check_parts_by(const char *text, mesh_parts_by parts_by, const char *const *names,
                           const uint32_t *labels, const uint32_t *own) {
    mesh_check_parts_by((file_bytes){"mesh.obj", text, strlen(text)}, parts_by, names, labels, own);
}

/* Objects, groups and materials that begin and end at different faces. */
TEST(names_parts_by_what_is_asked_for) {
    enum { N = NO_MESH_PART };
    static const char text[] =
        SQUARE "f 1 2 3\nusemtl  Brushed Steel #2 \nf 1 2 3\no Body\nf 1 2 3\ng Arm L\nf 1 2 3\nusemtl "
               "default\nf 1 2 3 4\no Hat\nusemtl Unused\nusemtl Brushed Steel #2\nf 1 2 3\nusemtl (null)\ng "
               "Arm L\nf 1 2 3\n";
    const uint32_t own[] = {N, N, 0, 1, 1, 1, 2, 3};
    check_parts_by(text, MESH_PARTS_BY_OBJECT, (const char *const[]){"Body", "Hat", NULL},
                   (const uint32_t[]){N, N, 0, 0, 0, 0, 1, 1}, own);
    check_parts_by(text, MESH_PARTS_BY_GROUP, (const char *const[]){"Arm L", NULL},
                   (const uint32_t[]){N, N, N, 0, 0, 0, N, 0}, own);
    check_parts_by(text, MESH_PARTS_BY_MATERIAL, (const char *const[]){"Brushed Steel #2", "default", NULL},
                   (const uint32_t[]){N, 0, 0, 0, 1, 1, 0, N}, own);
    check_parts_by(text, MESH_PARTS_BY_FILE,
                   (const char *const[]){"Body", "Body/Arm L", "Hat", "Hat/Arm L", NULL}, own, own);
}

/* What the file does not have is no part, and what it has besides is still known. */
TEST(has_no_parts_of_another_kind) {
    const char *const none[] = {NULL}, *const stone[] = {"Stone", NULL};
    const uint32_t zero[] = {0};
    check_parts_by(SQUARE "g A\nf 1 2 3\n", MESH_PARTS_BY_OBJECT, none, NULL, zero);
    check_parts_by(SQUARE "o A\nf 1 2 3\n", MESH_PARTS_BY_GROUP, none, NULL, zero);
    check_parts_by(SQUARE "o A\nf 1 2 3\nusemtl Late\n", MESH_PARTS_BY_MATERIAL, none, NULL, zero);
    check_parts_by(SQUARE "usemtl Stone\nf 1 2 3\n", MESH_PARTS_BY_MATERIAL, stone, zero, NULL);
    check_parts_by(SQUARE "usemtl (null)\nf 1 2 3\n", MESH_PARTS_BY_MATERIAL, none, NULL, NULL);
}

TEST(refuses_indices_out_of_range) {
    mesh_check_error(OBJ(SQUARE "f 1 2 0\n"), ":5: ", "face index 0 is out of range",
                     "the first vertex is 1");
    mesh_check_error(OBJ(SQUARE "f 1 2 3\nf 1 2 5\nf 1 2 3\n"), ":6: ", "face index 5 is out of range",
                     "the file has 4 vertices");
    mesh_check_error(OBJ(SQUARE "f 1 2 -5\nv 0 0 0\n"), ":5: ", "face index -5 is out of range",
                     "the file has 4 vertices before it");
    mesh_check_error(OBJ(SQUARE "f 1 2 2147483648\n"), ":5: ", "face index 2147483648 is out of range",
                     "at most 2147483647 vertices");
    mesh_check_error(OBJ(SQUARE "f 1 2 99999999999999999999\n"), ":5: ", "found '99999999999999999999'",
                     "face corner");
    mesh_check_error(OBJ("f 1 2 7\n" SQUARE), ":1: ", "face index 7 is out of range",
                     "the file has 4 vertices");
}

TEST(refuses_incomplete_meshes) {
    mesh_check_error(OBJ("# nothing\n"), ": ", "no vertices", "expected a triangle mesh");
    mesh_check_error(OBJ("f 1 2 3\n"), ": ", "no vertices", "expected a triangle mesh");
    mesh_check_error(OBJ(SQUARE), ": ", "no faces found for the 4 vertices", "expected a triangle mesh");
    mesh_check_error(OBJ("\x01\x02\xff\xfe garbage \0\0\0"), ": ", "no vertices", "expected a triangle mesh");
}

TEST(shows_long_tokens_cut) {
    mesh_check_error(OBJ("v 0 0 0123456789012345678901234567890123456789012345678901234567890123456789x\n"),
                     ":1: ", "found '01234567890123456789012345678901234567890123...'", "coordinate z");
}

TEST(survives_damage) {
    mesh_check_damage(OBJ("# a\r\nv 0 0 0\nv 1 .5e1 \\\n-2\nv 1 1 0 1\nvn 1 0 0\nv 0 1 0\nf 1 2/1 3//2 4\n"
                          "f -4/1/1 -2 -1\n"));
}
