/* OFF meshes: every form of header and row, and each error with its line. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include <stdlib.h>

#define OFF(literal) FILE_OF("mesh.off", literal)
#define VERTICES     "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define FACES        "3 0 1 2\n3 0 2 3\n"
#define REST         VERTICES FACES

TEST(reads_headers) {
    mesh_check_square(OFF("OFF\n4 2 5\n" REST));
    mesh_check_square(OFF("OFF 4 2 5\n" REST));
    mesh_check_square(OFF("OFF4 2 5\n" REST));
    mesh_check_square(OFF("OFF\n4 2\n" REST));
    mesh_check_square(OFF("4 2 0\n" REST));
    mesh_check_square(OFF("# first\n\n OFF # here\n# and\n\n4 2 0 # there\n" REST));
    mesh_check_square(
        OFF("\xef\xbb\xbfOFF\r\n4 1 0\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3 # end\r\n"));
    mesh_check_square(OFF("OFF\r4 2 0\r0 0 0\r1 0 0\r1 1 0\r0 1 0\r3 0 1 2\r3 0 2 3\r"));
}

TEST(reads_extra_vertex_data) {
    mesh_check_square(
        OFF("COFF\n4 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1 0 1 0 0 1\n0 1 0 1 0 0 1\n4 0 1 2 3\n"));
    mesh_check_square(OFF("NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n"));
    mesh_check_square(OFF("STOFF\n4 1 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n"));
    mesh_check_square(OFF("STCNOFF 4 1 0\n" VERTICES "4 0 1 2 3\n"));
}

/* Vertices of four coordinates are divided by the last one; n is followed by the number of dimensions. */
TEST(reads_other_dimensions) {
    mesh_check_square(OFF("4OFF\n4 1 0\n0 0 0 1\n2 0 0 2\n-.5 -.5 -0 -.5\n0 1 0 1\n4 0 1 2 3\n"));
    mesh_check_square(
        OFF("C4OFF\n4 1 0\n0 0 0 1 255 0 0\n1 0 0 1 255 0 0\n1 1 0 1 0 0 0\n0 1 0 1\n4 0 1 2 3\n"));
    mesh_check_square(OFF("nOFF 3\n4 2 0\n" REST));
    mesh_check_square(OFF("nOFF\n3\n4 2 0\n" REST));
    mesh_check_square(OFF("4nOFF\n3\n4 1 0\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n4 0 1 2 3\n"));
}

TEST(reads_headers_and_indices_over_several_lines) {
    mesh_check_square(OFF("NCOFF\n4\n2\n5\n" REST));
    mesh_check_square(OFF("off\n4\n2\n" REST));
    mesh_check_square(OFF("OFF\n4 2\n# edges\n0\n\n" REST));
    mesh_check_square(OFF("OFF\n4 1 0\n" VERTICES "4\n0\n1\n2\n3"));
    mesh_check_square(
        OFF("OFF\r\n4 2 0\r\n" VERTICES "3 0 1 # one more\r\n\r\n 2 255 0 0\r\n3 0 2\r\n3 0.5 0.5 1\r\n"));
}

TEST(reads_rows) {
    static const double positions[] = {0.1, -1e-5, 3, 9, 2, 3, 4, 5, 3, -3, 8, 3, 0, 0, -0.0};
    static const uint32_t triangles[] = {4, 0, 1, 4, 1, 2, 4, 2, 3, 0, 1, 2};
    mesh_check_square(
        OFF("OFF\n4 2 0\n\n# vertices\n" VERTICES "\n# faces\n3 0 1 2 255 0 0\n3 0 2 3 0.5 .5 1 1\n\n#\n"));
    mesh_check_square(OFF("OFF\n4 1 0\n" VERTICES "4 0 1 2 3"));
    mesh_check_equal(OFF("OFF\n5 2 0\n.1 -1e-5 3\n9 2 3\n4 5 3\n-3 8 3\n0 0 -0\n5 4 0 1 2 3\n3 0 1 2\n"), 5,
                     positions, 4, triangles);
    mesh_check_square(FILE_OF("mesh.txt", "OFF\n4 2 5\n" REST));
    mesh_check_square(FILE_OF("mesh.obj", "OFF\n4 2 5\n" REST));
}

TEST(refuses_bad_headers) {
    mesh_check_error(OFF("OFF"), ":1: ", "the file ends", "the number of vertices");
    mesh_check_error(OFF("# only this\n"), ":2: ", "the file ends", "the number of vertices");
    mesh_check_error(OFF("OFF\n4\n"), ":3: ", "the file ends", "the number of faces");
    mesh_check_error(OFF("OFF\nfour 2 0\n"), ":2: ", "found 'four'", "the number of vertices");
    mesh_check_error(OFF("OFF\n4 2 x\n"), ":2: ", "found 'x'", "the number of edges");
    mesh_check_error(OFF("OFF\n4 2 0 0\n"), ":2: ", "found '0'", "the end of the line");
    mesh_check_error(OFF("OFF\n-4 2 0\n"), ":2: ", "the number of vertices is -4",
                     "expected 0 to 2147483647");
    mesh_check_error(OFF("OFF\n4 2147483648 0\n"), ":2: ", "the number of faces is 2147483648",
                     "0 to 2147483647");
    mesh_check_error(OFF("nOFF\n4\n4 2 0\n"), ":2: ", "vertices of 4 dimensions", "expected 3");
    mesh_check_error(OFF("nOFF\n"), ":2: ", "the file ends", "the number of dimensions");
    mesh_check_error(OFF("4OFF\n4 2 0\n0 0 0\n"), ":3: ", "the line ends", "the fourth coordinate");
    mesh_check_error(OFF("4OFF\n4 2 0\n1 0 0 0\n"), ":3: ", "coordinate x of vertex 0 is inf", "finite");
    mesh_check_error(OFF("xOFF\n"), ":1: ", "found 'xOFF'", "the number of vertices");
    mesh_check_error(OFF("OFF BINARY\n\0\0\0\4"), ":1: ", "binary OFF", "expected text");
    mesh_check_error(OFF("OFFSET 1\n"), ":1: ", "found 'OFFSET'", "the number of vertices");
    mesh_check_error(OFF("\x01\x02\xff\xfe\0\0\0"), ":1: ", "found '????", "the number of vertices");
}

TEST(refuses_bad_rows) {
    mesh_check_error(OFF("OFF\n4 2 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n" FACES), ":4: ", "the line ends",
                     "coordinate z");
    mesh_check_error(OFF("OFF\n4 2 0\n0 0 0\n1 zero 0\n"), ":4: ", "found 'zero'", "coordinate y");
    mesh_check_error(OFF("OFF\n4 2 0\n0 0 0\n1 0 NaN\n"), ":4: ", "coordinate z of vertex 1 is nan",
                     "finite");
    mesh_check_error(OFF("OFF\n4 2 0\n-1e400 0 0\n"), ":3: ", "coordinate x of vertex 0 is -inf", "finite");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "2 0 1\n"), ": ", "no faces found",
                     "expected a triangle mesh");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "-3 0 1 2\n"), ":7: ", "a face of -3 corners", "3 or more");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "4 0 1 2\n"), ":8: ", "the file ends", "a vertex index");
    mesh_check_error(OFF("OFF\n4 2 0\n" VERTICES "4 0 1 2\n3 0 2 3\n"),
                     ":9: ", "file ends before face 2 of 2", "");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "3 0 1.5 2\n"), ":7: ", "found '1.5'", "a vertex index");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "3 0 1 4\n"), ":7: ", "face index 4 is out of range",
                     "the file has 4 vertices");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "3 0 1 -1\n"), ":7: ", "face index -1 is out of range",
                     "the file has 4 vertices");
}

TEST(refuses_counts_that_do_not_fit) {
    mesh_check_error(OFF("OFF\n4 3 0\n" REST), ":9: ", "file ends before face 3 of 3", "");
    mesh_check_error(OFF("OFF\n4 2000000000 0\n" REST), ":9: ", "file ends before face 3 of 2000000000", "");
    mesh_check_error(OFF("OFF\n2000000000 2 0\n" VERTICES), ":7: ", "file ends before vertex 5 of 2000000000",
                     "");
    mesh_check_error(OFF("OFF\n4 1 0\n" REST), ":8: ", "found '3' after the last face",
                     "the end of the file");
    mesh_check_error(OFF("OFF\n4 1 0\n" VERTICES "2000000000 0 1 2\n"), ":8: ", "the file ends",
                     "a vertex index");
    mesh_check_error(OFF("OFF\n0 0 0\n"), ": ", "no vertices", "expected a triangle mesh");
    mesh_check_error(OFF("OFF\n4 0 0\n" VERTICES), ": ", "no faces found for the 4 vertices",
                     "expected a triangle");
}

TEST(survives_damage) {
    mesh_check_damage(
        OFF("# a\nOFF 4 2 0\r\n0 0 0\n1 0.5e1 -2\n\n1 1 0 1 1 1\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 2 1\n"));
    mesh_check_damage(FILE_OF("mesh", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n"));
}
