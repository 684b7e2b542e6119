/* Reads bytes as a mesh file and checks the mesh or the error; used inside cmocka tests. */
#include "tests/support/io/mesh_check.h"
#include "tests/support/test.h"

#include "tests/support/io_allocations.h"
#include "tests/support/temp_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One folder for all files of a program: thousands are damaged one after the other, and on some systems a folder takes longer than
 * its file. */
static temp_folder folder;

static void remove_folder(void) {
    temp_folder_remove(&folder);
}

bool mesh_check_read(file_bytes file, mesh_file *mesh, io_error *error) {
    return mesh_check_read_parts(file, MESH_PARTS_BY_FILE, mesh, error);
}

bool mesh_check_read_parts(file_bytes file, mesh_parts_by parts_by, mesh_file *mesh, io_error *error) {
    if (folder.path[0] == '\0') {
        folder = temp_folder_make();
        atexit(remove_folder);
    }
    temp_path path = temp_file_write(&folder, file.name, file.bytes, file.size);
    return mesh_file_read_parts(path.text, parts_by, mesh, error);
}

void mesh_check_equal(file_bytes file, uint32_t vertex_count, const double *positions,
                      uint32_t triangle_count, const uint32_t *triangles) {
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_check_read(file, &mesh, &error)) fail_msg("refused: %s", error.text);
    assert_int_equal(mesh.vertex_count, vertex_count);
    assert_int_equal(mesh.triangle_count, triangle_count);
    assert_memory_equal(mesh.positions, positions, 3 * vertex_count * sizeof *positions);
    assert_memory_equal(mesh.triangles, triangles, 3 * triangle_count * sizeof *triangles);
    mesh_file_free(&mesh);
    assert_null(mesh.positions);
    assert_null(mesh.triangles);
}

void mesh_check_square(file_bytes file) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    mesh_check_equal(file, 4, positions, 2, triangles);
}

static void check_names(const mesh_file *mesh, const char *const *names, const uint32_t *labels) {
    uint32_t count = 0;
    for (; names[count] != NULL; count++) {
        assert_true(count < mesh->parts.count);
        assert_string_equal(mesh->parts.names[count], names[count]);
    }
    assert_int_equal(mesh->parts.count, count);
    for (uint32_t t = 0; t < mesh->triangle_count && count > 0; t++)
        assert_int_equal(mesh->parts.of_triangle[t], labels[t]);
    if (count == 0) assert_null(mesh->parts.of_triangle);
}

void mesh_check_parts(file_bytes file, const char *const *names, const uint32_t *labels) {
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_check_read(file, &mesh, &error)) fail_msg("refused: %s", error.text);
    check_names(&mesh, names, labels);
    assert_int_equal(mesh.own_parts.count, 0);
    mesh_file_free(&mesh);
}

void mesh_check_parts_by(file_bytes file, mesh_parts_by parts_by, const char *const *names,
                         const uint32_t *labels, const uint32_t *own) {
    mesh_file mesh = {0}, plain = {0};
    io_error error = {""};
    if (!mesh_check_read_parts(file, parts_by, &mesh, &error)) fail_msg("refused: %s", error.text);
    if (!mesh_check_read(file, &plain, &error)) fail_msg("refused: %s", error.text);
    check_names(&mesh, names, labels);
    const mesh_parts *parts = mesh_file_own_parts(&mesh);
    assert_int_equal(parts->count, plain.parts.count);
    assert_true((parts->of_triangle != NULL) == (own != NULL));
    for (uint32_t i = 0; i < parts->count; i++) assert_string_equal(parts->names[i], plain.parts.names[i]);
    for (uint32_t t = 0; t < mesh.triangle_count && own != NULL; t++)
        assert_true(parts->of_triangle[t] == own[t] && plain.parts.of_triangle[t] == own[t]);
    assert_int_equal(mesh.triangle_count, plain.triangle_count);
    assert_memory_equal(mesh.triangles, plain.triangles, 3 * plain.triangle_count * sizeof *plain.triangles);
    mesh_file_free(&mesh);
    mesh_file_free(&plain);
}

void mesh_check_error(file_bytes file, const char *place, const char *found, const char *expected) {
    double untouched;
    mesh_file mesh = {.vertex_count = 7, .positions = &untouched};
    io_error error = {""};
    char start[256];
    snprintf(start, sizeof start, "%s%s", file.name, place);
    if (mesh_check_read(file, &mesh, &error)) {
        mesh_file_free(&mesh);
        fail_msg("accepted, expected '%s' and '%s'", start, found);
    }
    const char *texts[] = {start, found, expected};
    for (size_t i = 0; i < 3; i++) {
        if (strstr(error.text, texts[i]) == NULL) fail_msg("no '%s' in '%s'", texts[i], error.text);
    }
    assert_null(strpbrk(error.text, "\r\n"));
    assert_true(mesh.vertex_count == 7 && mesh.positions == &untouched && mesh.triangles == NULL);
}

static void check_in_range(const mesh_file *mesh) {
    assert_true(mesh->vertex_count > 0 && mesh->triangle_count > 0);
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) assert_true(isfinite(mesh->positions[i]));
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangles + 3 * i;
        for (int j = 0; j < 3; j++) {
            assert_true(corner[j] < mesh->vertex_count);
            assert_true(corner[j] != corner[(j + 1) % 3]);
        }
    }
}

void mesh_check_survives(file_bytes file) {
    mesh_file mesh = {0};
    io_error error = {""};
    if (mesh_check_read(file, &mesh, &error)) {
        check_in_range(&mesh);
        mesh_file_free(&mesh);
    } else {
        assert_true(strstr(error.text, file.name) != NULL && strpbrk(error.text, "\r\n") == NULL);
        assert_null(mesh.positions);
    }
}

static void read_again(file_bytes file, mesh_parts_by parts_by, const mesh_file *expected) {
    mesh_file mesh = {0};
    io_error error = {""};
    if (!mesh_check_read_parts(file, parts_by, &mesh, &error)) fail_msg("refused: %s", error.text);
    assert_int_equal(mesh.vertex_count, expected->vertex_count);
    assert_int_equal(mesh.triangle_count, expected->triangle_count);
    assert_memory_equal(mesh.positions, expected->positions, 3 * mesh.vertex_count * sizeof *mesh.positions);
    assert_memory_equal(mesh.triangles, expected->triangles,
                        3 * mesh.triangle_count * sizeof *mesh.triangles);
    mesh_file_free(&mesh);
}

void mesh_check_memory(file_bytes file, mesh_parts_by parts_by) {
    mesh_file expected = {0};
    io_error error = {""};
    long failures = 0;
    if (!mesh_check_read_parts(file, parts_by, &expected, &error)) fail_msg("refused: %s", error.text);
    for (; io_allocations_go_on(failures); failures++) {
        mesh_file mesh = {0};
        const bool done = mesh_check_read_parts(file, parts_by, &mesh, &error);
        io_allocations_left = -1;
        if (!done && (strstr(error.text, "out of memory") == NULL || strstr(error.text, file.name) == NULL))
            fail_msg("allocation %ld: %s", failures, error.text);
        if (!done) assert_null(mesh.positions);
        mesh_file_free(&mesh);
        read_again(file, parts_by, &expected);
    }
    assert_true(failures >= 3);
    mesh_file_free(&expected);
}

void mesh_check_damage(file_bytes file) {
    mesh_check_memory(file, MESH_PARTS_BY_FILE);
    char *bytes = malloc(file.size + 1);
    assert_non_null(bytes);
    for (size_t i = 0; i < file.size; i++) {
        memcpy(bytes, file.bytes, file.size);
        mesh_check_survives((file_bytes){file.name, bytes, i});
        for (int bit = 0; bit < 8; bit++) {
            bytes[i] = (char)(bytes[i] ^ 1 << bit);
            mesh_check_survives((file_bytes){file.name, bytes, file.size});
            bytes[i] = (char)(bytes[i] ^ 1 << bit);
        }
        memmove(bytes + i + 1, bytes + i, file.size - i);
        mesh_check_survives((file_bytes){file.name, bytes, file.size + 1});
        memmove(bytes + i, bytes + i + 2, file.size - i - 1);
        mesh_check_survives((file_bytes){file.name, bytes, file.size - 1});
    }
    free(bytes);
}
