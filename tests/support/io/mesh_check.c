/* Reads bytes as a mesh file and checks the mesh, whatever happens to the file or to memory; used inside cmocka tests. */
#include "tests/support/io/mesh_check.h"

#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/io/animation.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One folder for all files of a program: thousands are damaged one after the other, and on some systems a folder takes longer than
 * its file. */
static temp_folder mesh_folder;

static void remove_folder(void) {
    temp_folder_remove(&mesh_folder);
}

bool mesh_check_read(file_bytes file, mesh_file *mesh, io_error *error) {
    return mesh_check_read_parts(file, MESH_PARTS_BY_FILE, mesh, error);
}

bool mesh_check_read_parts(file_bytes file, mesh_parts_by parts_by, mesh_file *mesh, io_error *error) {
    if (mesh_folder.path[0] == '\0') {
        mesh_folder = temp_folder_make();
        atexit(remove_folder);
    }
    temp_path path = temp_file_write(&mesh_folder, file.name, file.bytes, file.size);
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

/* ---- random damage ------------------------------------------------------------------------------------- */

static void check_mesh(const mesh_file *mesh) {
    assert_true(mesh->vertex_count > 0 && mesh->triangle_count > 0);
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) assert_true(isfinite(mesh->positions[i]));
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangles + 3 * i;
        for (int j = 0; j < 3; j++) {
            assert_true(corner[j] < mesh->vertex_count);
            assert_true(corner[j] != corner[(j + 1) % 3]);
        }
        assert_true(mesh_file_polygon(mesh, (uint32_t)i) < mesh->polygon_count);
        if (mesh->parts.of_triangle != NULL)
            assert_true(mesh->parts.of_triangle[i] < mesh->parts.count ||
                        mesh->parts.of_triangle[i] == NO_MESH_PART);
    }
}

static void check_refusal(const io_error *error, const char *name) {
    if (strstr(error->text, name) == NULL || strpbrk(error->text, "\r\n") != NULL)
        fail_msg("the refusal is: %s", error->text);
}

/* The first, a middle and the last frame. */
static bool check_frames(const char *path, const mesh_file *mesh, const char *name) {
    animation *frames;
    io_error error = {""};
    if (!animation_open(&path, 1, mesh->vertex_count, NULL, &frames, &error)) {
        check_refusal(&error, name);
        return false;
    }
    double *positions = malloc(3 * sizeof *positions * mesh->vertex_count);
    assert_non_null(positions);
    const uint32_t count = animation_frame_count(frames);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t frame = i == 0 ? 0 : i == 1 ? count / 2 : count - 1;
        if (!animation_read(frames, frame, positions, &error)) {
            check_refusal(&error, name);
            continue;
        }
        for (size_t k = 0; k < 3 * (size_t)mesh->vertex_count; k++) assert_true(isfinite(positions[k]));
    }
    free(positions);
    animation_close(frames);
    return true;
}

file_damage_counts file_damage_rounds(file_bytes file, uint32_t round_count, uint64_t seed) {
    file_damage_counts counts = {0};
    random_stream random = stream_start(seed);
    const temp_folder folder = temp_folder_make();
    unsigned char *bytes = malloc(file.size + 4 * DAMAGE_GROWTH_MAX);
    assert_non_null(bytes);
    for (uint32_t round = 0; round < round_count; round++) {
        size_t size = file.size;
        memcpy(bytes, file.bytes, size);
        for (uint32_t fault = 1 + stream_below(&random, 4); fault > 0; fault--)
            size = damage_bytes(&random, bytes, size);
        const temp_path path = temp_file_write(&folder, file.name, bytes, size);
        mesh_file mesh = {0};
        io_error error = {""};
        if (!mesh_file_read(path.text, &mesh, &error)) {
            check_refusal(&error, file.name);
            counts.refused++;
            continue;
        }
        check_mesh(&mesh);
        counts.read++;
        if (check_frames(path.text, &mesh, file.name))
            counts.animated++;
        else
            counts.unanimated++;
        mesh_file_free(&mesh);
    }
    free(bytes);
    temp_folder_remove(&folder);
    return counts;
}
