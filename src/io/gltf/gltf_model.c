/* The mesh of a glTF file in its rest state. */
#include "src/io/gltf.h"
#include "src/io/gltf/gltf_pose.h"
#include "src/io/growable.h"

#include <stdlib.h>
#include <string.h>

static bool allocate_mesh(const gltf_scene *scene, mesh_file *mesh) {
    file_reader *reader = scene->document.reader;
    mesh->vertex_count = scene->vertex_count;
    mesh->triangle_count = scene->triangle_count;
    mesh->positions = gltf_allocate(reader, mesh->vertex_count, 3 * sizeof *mesh->positions);
    if (mesh->positions == NULL) return false;
    mesh->triangles = gltf_allocate(reader, mesh->triangle_count, 3 * sizeof *mesh->triangles);
    return mesh->triangles != NULL;
}

/* A node that mirrors its mesh turns the triangles around, as the format demands; joints leave them. */
static void write_triangles(const gltf_scene *scene, const gltf_pose *pose, mesh_file *out) {
    uint32_t *corner = out->triangles;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const gltf_instance *instance = &scene->instances[i];
        const gltf_mesh *mesh = &scene->meshes[instance->mesh];
        const bool mirrored =
            instance->skin == GLTF_NONE && gltf_transform_mirrors(&pose->world[instance->node]);
        const uint32_t(*triangles)[3] = mesh->triangles.data;
        for (size_t t = 0; t < mesh->triangles.count; t++, corner += 3) {
            corner[0] = instance->first_vertex + triangles[t][0];
            corner[1] = instance->first_vertex + triangles[t][mirrored ? 2 : 1];
            corner[2] = instance->first_vertex + triangles[t][mirrored ? 1 : 2];
        }
    }
}

bool gltf_read(file_reader *reader, mesh_file *out) {
    gltf_scene scene;
    gltf_pose pose = {0};
    mesh_file mesh = {0};
    if (!gltf_scene_open(reader, &scene)) return false;
    const bool done = gltf_pose_open(&scene, &pose) && allocate_mesh(&scene, &mesh) &&
                      gltf_pose_write(&pose, mesh.positions);
    if (done) {
        write_triangles(&scene, &pose, &mesh);
        *out = mesh;
    } else {
        mesh_file_free(&mesh);
    }
    gltf_pose_close(&pose);
    gltf_scene_close(&scene);
    return done;
}
