/* Copies of mesh files in which vertices have other places: all else is the same, byte for byte. */
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/io/mesh_copy.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct copy_case {
    const char *name, *text, *moved; /* moved: where vertex 1 has gone to (0.1, -2.5, 3) */
} copy_case;

static const copy_case cases[] = {
    {"a.obj",
     "# v 9 9 9\r\nmtllib a.mtl\r\no Box # 1\nv 0 0 0 1.0\nv 1 \\\n 0\t0 0.5 0.5 0.5 # red\nvt 0 1\nv 1 1 0\nv 0 1 0\n"
     "vn 0 0 1\ng side\nusemtl skin\nf 1/1 2/1 3/1 4/1\n\nl 1 2",
     "# v 9 9 9\r\nmtllib a.mtl\r\no Box # 1\nv 0 0 0 1.0\nv 0.1 \\\n -2.5\t3 0.5 0.5 0.5 # red\nvt 0 1\nv 1 1 0\nv 0 1 0\n"
     "vn 0 0 1\ng side\nusemtl skin\nf 1/1 2/1 3/1 4/1\n\nl 1 2"},
    {"a.off", "OFF # all\n4 1 0\n0 0 0\n1.00 0 0 255 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 1 1 1\n",
     "OFF # all\n4 1 0\n0 0 0\n0.1 -2.5 3 255 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 1 1 1\n"},
    {"a.ply",
     "ply\nformat ascii 1.0\ncomment of mine\nelement vertex 4\nproperty float z\nproperty uchar red\nproperty float x\n"
     "property float y\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 255 0 0\n0 7 1 0\n0 255 1 1\n"
     "0 255 0 1\n4 0 1 2 3\n",
     "ply\nformat ascii 1.0\ncomment of mine\nelement vertex 4\nproperty float z\nproperty uchar red\nproperty float x\n"
     "property float y\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 255 0 0\n3 7 0.1 -2.5\n"
     "0 255 1 1\n0 255 0 1\n4 0 1 2 3\n"}};

enum { CASES = sizeof cases / sizeof *cases, VERTICES = 4 };

static mesh_copy *open_copy(const char *path) {
    mesh_copy *copy = NULL;
    io_error error = {""};
    if (!mesh_copy_open(path, &copy, &error)) fail_msg("%s", error.text);
    assert_int_equal(mesh_copy_vertex_count(copy), VERTICES);
    return copy;
}

static void move_vertex(const mesh_copy *copy, double positions[VERTICES * 3]) {
    static const double place[3] = {0.1, -2.5, 3};
    memcpy(positions, mesh_copy_positions(copy), VERTICES * 3 * sizeof *positions);
    memcpy(positions + 3, place, sizeof place);
}

static void check_file(const char *path, const char *bytes, size_t size) {
    size_t read;
    char *found = temp_file_read(path, &read);
    assert_int_equal(read, size);
    assert_memory_equal(found, bytes, size);
    free(found);
}

TEST(changes_numbers_and_nothing_else) {
    for (size_t i = 0; i < CASES; i++) {
        const temp_path from =
                            temp_file_write(&own_folder, cases[i].name, cases[i].text, strlen(cases[i].text)),
                        to = temp_file_path(&own_folder, "to");
        double positions[VERTICES * 3];
        io_error error;
        mesh_copy *copy = open_copy(from.text);
        assert_false(mesh_copy_holds_floats(copy));
        assert_true(mesh_copy_write(copy, to.text, mesh_copy_positions(copy), &error));
        check_file(to.text, cases[i].text, strlen(cases[i].text));
        move_vertex(copy, positions);
        assert_true(mesh_copy_write(copy, to.text, positions, &error));
        check_file(to.text, cases[i].moved, strlen(cases[i].moved));
        mesh_copy_close(copy);
    }
}

/* Digits bring the same double back, however many it takes. */
TEST(writes_doubles_that_come_back) {
    static const double values[] = {1.0 / 3.0, 5e-324, -1.7976931348623157e308, 0.1 + 0.2, 1e22, -0.0};
    const temp_path path = temp_file_write(&own_folder, cases[0].name, cases[0].text, strlen(cases[0].text));
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        double positions[VERTICES * 3];
        io_error error;
        const temp_path to = temp_file_path(&own_folder, "to.obj");
        mesh_copy *copy = open_copy(path.text);
        move_vertex(copy, positions);
        positions[4] = values[i];
        assert_true(mesh_copy_write(copy, to.text, positions, &error));
        mesh_copy_close(copy);
        copy = open_copy(to.text);
        assert_memory_equal(mesh_copy_positions(copy), positions, sizeof positions);
        mesh_copy_close(copy);
    }
}

/* The normals of the triangles that have moved follow, those of others stay, be they right or not. */
TEST(writes_text_of_stl_with_its_normals) {
    static const char before
        [] =
            "solid one\nfacet normal 9 9 9\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
            "facet\nouter loop\nvertex 5 5 5\nvertex 6 5 5\nvertex 5 6 5\nendloop\nendfacet\n"
            "facet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 1 0 1\nvertex 0 1 1\nendloop\nendfacet\nendsolid one\n",
  after[] =
        "solid one\nfacet normal 9 9 9\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet\nouter loop\nvertex 5 5 5\nvertex 6 5 5\nvertex 5 6 5\nendloop\nendfacet\n"
        "facet normal 1 0 0\nouter loop\nvertex 0 0 1\nvertex 0 1 1\nvertex 0 0 2\nendloop\nendfacet\nendsolid one\n";
    static const double moved[6] = {0, 1, 1, 0, 0, 2};
    const temp_path from = temp_file_write(&own_folder, "a.stl", before, sizeof before - 1);
    double positions[27];
    io_error error = {""};
    mesh_copy *copy = NULL;
    assert_true(mesh_copy_open(from.text, &copy, &error));
    assert_false(mesh_copy_holds_floats(copy));
    memcpy(positions, mesh_copy_positions(copy), sizeof positions);
    memcpy(positions + 21, moved, sizeof moved);
    assert_true(mesh_copy_write(copy, from.text, positions, &error));
    mesh_copy_close(copy);
    check_file(from.text, after, sizeof after - 1);
}

/* A binary STL of a triangle, with colours in its attributes; returns the size. */
static size_t make_stl(char *bytes, const float numbers[12]) {
    memset(bytes, 'h', 80);
    memcpy(bytes + 80, "\1\0\0\0", 4);
    memcpy(bytes + 84, numbers, 48);
    memcpy(bytes + 132, "ab", 2);
    return 134;
}

TEST(writes_binary_stl_with_its_normals) {
    static const float before[12] = {0, 0, 7, 0, 0, 0, 1, 0, 0, 0, 1, 0},
                       after[12] = {0, 0, -1, 0, 0, 0, 1, 0, 0, 0, -2, 0};
    char from[134], to[134];
    const size_t size = make_stl(from, before);
    make_stl(to, after);
    const temp_path path = temp_file_write(&own_folder, "b.stl", from, size);
    double positions[9];
    io_error error = {""};
    mesh_copy *copy = NULL;
    assert_true(mesh_copy_open(path.text, &copy, &error));
    assert_true(mesh_copy_holds_floats(copy));
    memcpy(positions, mesh_copy_positions(copy), sizeof positions);
    assert_true(mesh_copy_write(copy, path.text, positions, &error));
    check_file(path.text, from, size);
    positions[7] = -2;
    assert_true(mesh_copy_write(copy, path.text, positions, &error));
    mesh_copy_close(copy);
    check_file(path.text, to, size);
}

static size_t put_ply(char *bytes, const char *format, const char *type) {
    return (size_t)sprintf(
        bytes,
        "ply\nformat %s 1.0\nelement vertex 4\nproperty %s x\nproperty %s y\nproperty uchar c\n"
        "property %s z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n",
        format, type, type, type);
}

static size_t put_number(char *bytes, double value, bool is_float, bool big_endian) {
    const float single = (float)value;
    const size_t size = is_float ? sizeof single : sizeof value;
    char own[8];
    memcpy(own, is_float ? (const void *)&single : (const void *)&value, size);
    for (size_t i = 0; i < size; i++) bytes[i] = own[big_endian ? size - 1 - i : i];
    return size;
}

/* A binary PLY of the square, with vertex 1 where it is given; returns the size. */
static size_t make_ply(char *bytes, const double place[3], bool is_float, bool big_endian) {
    static const double square[VERTICES][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    size_t size = put_ply(bytes, big_endian ? "binary_big_endian" : "binary_little_endian",
                          is_float ? "float" : "double");
    for (int v = 0; v < VERTICES; v++) {
        const double *x = v == 1 ? place : square[v];
        for (int axis = 0; axis < 3; axis++) {
            if (axis == 2) bytes[size++] = (char)(v + 65);
            size += put_number(bytes + size, x[axis], is_float, big_endian);
        }
    }
    memcpy(bytes + size, "\4\0\1\2\3", 5);
    return size + 5;
}

TEST(writes_binary_numbers_as_they_are_stored) {
    static const double here[3] = {1, 0, 0}, there[3] = {0.1, -2.5, 3};
    for (int kind = 0; kind < 4; kind++) {
        char from[1000], to[1000];
        const bool is_float = (kind & 1) != 0, big_endian = (kind & 2) != 0;
        const size_t size = make_ply(from, here, is_float, big_endian);
        assert_int_equal(make_ply(to, there, is_float, big_endian), size);
        const temp_path path = temp_file_write(&own_folder, "a.ply", from, size);
        double positions[VERTICES * 3];
        io_error error;
        mesh_copy *copy = open_copy(path.text);
        assert_int_equal(mesh_copy_holds_floats(copy), is_float);
        move_vertex(copy, positions);
        assert_true(mesh_copy_write(copy, path.text, positions, &error)); /* in its place */
        mesh_copy_close(copy);
        check_file(path.text, to, size);
    }
}

static void check_refused(const char *name, const char *text, const char *part) {
    const temp_path path = temp_file_write(&own_folder, name, text, strlen(text));
    mesh_copy *copy = NULL;
    io_error error;
    assert_false(mesh_copy_open(path.text, &copy, &error));
    assert_null(copy);
    assert_non_null(strstr(error.text, part));
}

TEST(refuses_what_it_cannot_write) {
    check_refused("a.obj", "v 0 0\n", "expected coordinate z");
    check_refused("a.off", "4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 1 0 1\n3 0 1 2\n",
                  "vertex 1 is stored as integers");
    check_refused(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty int x\nproperty int y\nproperty int z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "vertex 0 is stored as integers");
    mesh_copy *copy = NULL;
    io_error error;
    assert_false(mesh_copy_open(own_folder.path, &copy, &error));
    assert_non_null(strstr(error.text, ": not a regular file"));
    mesh_copy_close(NULL);
}

TEST(survives_failed_allocations) {
    const temp_path path = temp_file_write(&own_folder, cases[0].name, cases[0].text, strlen(cases[0].text));
    for (long place = 0; io_allocations_go_on(place); place++) {
        mesh_copy *copy = NULL;
        io_error error = {""};
        const bool opened = mesh_copy_open(path.text, &copy, &error);
        io_allocations_left = -1;
        assert_true(opened || io_allocation_failed); /* a smaller array need not be had */
        if (!opened) assert_non_null(strstr(error.text, "out of memory"));
        mesh_copy_close(copy);
    }
}

AROUND_ALL(own_folder_make, own_folder_remove)
