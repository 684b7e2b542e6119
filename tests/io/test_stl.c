/* STL meshes: binary and text told apart by their content, every form of both, and each error with its place. */
#include "src/io/growable.h"
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STL(literal) FILE_OF("mesh.stl", literal)
#define FACET_0                                                                                              \
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 1 1 0\n endloop\nendfacet\n"
#define FACET_1                                                                                              \
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 1 0\n  vertex 0 1 0\n endloop\nendfacet\n"

static const double two_facets[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
static const uint32_t two_triangles[] = {0, 1, 2, 3, 4, 5};

static void check_two_facets(file_bytes file) {
    mesh_check_equal(file, 6, two_facets, 2, two_triangles);
}

/* ---- text -------------------------------------------------------------------------------------------- */

TEST(reads_text) {
    check_two_facets(STL("solid square\n" FACET_0 FACET_1 "endsolid square\n"));
    check_two_facets(STL("solid\n" FACET_0 FACET_1 "endsolid"));
    check_two_facets(STL("\xef\xbb\xbfsolid a # b\n\n" FACET_0 "\n\n" FACET_1 "endsolid a # b\n\n"));
    check_two_facets(FILE_OF("mesh.txt", "  solid square\n" FACET_0 FACET_1 "endsolid square\n"));
    check_two_facets(
        FILE_OF("a.STL", "SOLID S\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 1 1 0\n"
                         "ENDLOOP\nENDFACET\n" FACET_1 "ENDSOLID S\n"));
    check_two_facets(STL("solid\r\nfacet normal 0 0 0\r\nouter loop\r\nvertex 0 0 0\r\nvertex 1.0e+00 0 0\r\n"
                         "vertex 1 1 0\r\nendloop\r\nendfacet\r\n" FACET_1 "endsolid\r\n"));
}

TEST(reads_loose_text) {
    /* Several solids, their names of any words, "facet" among them. */
    check_two_facets(STL("solid left facet\n" FACET_0 "endsolid left facet\nsolid\n" FACET_1 "endsolid\n"));
    /* A facet in one line, no normal, and one that is no number. */
    check_two_facets(STL(
        "solid s\nfacet outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet\n"
        "facet normal nan nan nan outer loop vertex 0 0 0\nvertex 1\n1 0 vertex 0 1 0 endloop endfacet endsolid"));
    /* A facet of four corners, which some programs write. */
    static const double corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    mesh_check_equal(
        STL("solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 endloop "
            "endfacet\nendsolid\n"),
        4, corners, 2, triangles);
}

/* Several solids are parts; one alone is none, since exporters write their own name there. */
TEST(names_parts) {
    mesh_check_parts(STL("solid left  arm \r\n" FACET_0 "endsolid left  arm\nsolid\n" FACET_1
                         "endsolid\nsolid b\n" FACET_0 "endsolid b\nsolid left  arm\n" FACET_1 "endsolid\n"),
                     (const char *const[]){"left  arm", "b", NULL},
                     (const uint32_t[]){0, NO_MESH_PART, 1, 0});
    mesh_check_parts(STL("solid Exported from Blender\n" FACET_0 FACET_1 "endsolid\n"),
                     (const char *const[]){NULL}, NULL);
}

TEST(refuses_bad_text) {
    mesh_check_error(STL("solid s\n" FACET_0), ":9: ", "the file ends", "expected facet or endsolid");
    mesh_check_error(STL("solid s\nendsolid s\n"), ": ", "no vertices found", "expected a triangle mesh");
    mesh_check_error(STL("solid s\nfacet normal 0 0 1\nouter lop\n"), ":3: ", "found 'lop'", "expected loop");
    mesh_check_error(STL("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0\n"),
                     ":5: ", "found 'vertex'", "coordinate z");
    mesh_check_error(STL("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"),
                     ":4: ", "found 'zero'", "coordinate z");
    mesh_check_error(STL("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n"),
                     ":4: ", "coordinate z of vertex 0 is inf", "finite");
    mesh_check_error(
        STL("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 0 0 2\nendloop\nendfacet\nendsolid\n"),
        ": ", "no faces found", "expected a triangle mesh");
    mesh_check_error(STL("solid s\n" FACET_0 "endsolid s\nfacet\n"), ":10: ", "found 'facet'",
                     "expected solid");
    mesh_check_error(STL("solid s\n" FACET_0 "corner\n"), ":9: ", "found 'corner'",
                     "expected facet or endsolid");
    mesh_check_error(STL("soiled\n"), ":1: ", "found 'soiled'", "expected solid");
    mesh_check_error(STL("\n\n"), ":3: ", "the file ends", "expected solid");
}

/* ---- binary ------------------------------------------------------------------------------------------ */

typedef struct binary_file {
    size_t size;
    char bytes[1000];
} binary_file;

static void put_word(binary_file *file, uint32_t word) {
    for (int i = 0; i < 4; i++) file->bytes[file->size++] = (char)(word >> 8 * i & 0xff);
}

static void put_float(binary_file *file, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_word(file, bits);
}

/* Writes two facets behind a header that begins with this text, and goes on with blanks. */
static binary_file write_binary(const char *header, uint32_t count) {
    binary_file file = {.size = 80};
    memset(file.bytes, ' ', 80);
    memcpy(file.bytes, header, strlen(header));
    put_word(&file, count);
    for (int facet = 0; facet < 2; facet++) {
        for (int axis = 0; axis < 3; axis++) put_float(&file, NAN); /* a normal */
        for (int i = 0; i < 9; i++) put_float(&file, (float)two_facets[9 * facet + i]);
        file.bytes[file.size++] = 's';
        file.bytes[file.size++] = 'o';
    }
    return file;
}

static file_bytes file_of(const binary_file *file) {
    return (file_bytes){"mesh.stl", file->bytes, file->size};
}

TEST(reads_binary) {
    static const char *const headers[] = {
        "",          "binary", "solid square", "solid\nfacet normal", "COLOR=\xff\1\2\3", "\xef\xbb\xbf",
        "# comment", "ply",    "OFF 4 2"};
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        binary_file file = write_binary(headers[i], 2);
        check_two_facets(file_of(&file));
        check_two_facets((file_bytes){"mesh.bin", file.bytes, file.size});
        if (strcmp(headers[i], "ply") == 0 || headers[i][0] == 'O') continue; /* these need the right size */
        file.bytes[file.size++] = '\n';                                       /* padding */
        check_two_facets(file_of(&file));
    }
}

/* Coordinates are the file's floats, none of which is rounded. */
TEST(keeps_floats) {
    binary_file file = write_binary("", 2);
    const float tenth = 0.1f, least = 0x1p-149f;
    memcpy(file.bytes + 84 + 12, &tenth, sizeof tenth);
    memcpy(file.bytes + 84 + 16, &least, sizeof least);
    double expected[18];
    memcpy(expected, two_facets, sizeof expected);
    expected[0] = (double)0.1f;
    expected[1] = 0x1p-149;
    mesh_check_equal(file_of(&file), 6, expected, 2, two_triangles);
}

TEST(refuses_bad_binary) {
    static const char *const headers[] = {"", "solid square"};
    for (size_t i = 0; i < 2; i++) {
        binary_file file = write_binary(headers[i], 3);
        mesh_check_error(file_of(&file), ": byte 184: ", "file ends inside triangle 3 of 3", "");
        file = write_binary(headers[i], 1);
        mesh_check_error(file_of(&file), ": byte 134: ", "50 bytes follow the last triangle",
                         "the end of the file");
        file = write_binary(headers[i], 0);
        file.size = 84;
        mesh_check_error(file_of(&file), ": ", "no vertices found", "expected a triangle mesh");
    }
    binary_file file = write_binary("", 2);
    file.size = 83;
    file.bytes[3] = '\0';
    mesh_check_error(file_of(&file), ": byte 83: ", "file ends in the header", "84 bytes");
    file = write_binary("", 2);
    const float infinite = INFINITY;
    memcpy(file.bytes + 84 + 50 + 12 + 4, &infinite, sizeof infinite);
    mesh_check_error(file_of(&file), ": byte 146: ", "coordinate y of vertex 3 is inf", "finite");
}

TEST(survives_damage) {
    const binary_file file = write_binary("solid", 2);
    mesh_check_damage(file_of(&file));
    mesh_check_damage(STL(
        "solid s\nfacet outer loop vertex 0 0 0 vertex 1 0 0\nvertex 1 1 0 endloop endfacet\nendsolid s\n"));
}
