/* Mesh files with random damage, read as meshes and as animations. */
#include "tests/support/io/file_damage.h"
#include "tests/support/files.h"
#include "tests/support/test.h"
#include "tool/io/animation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
