/* The mesh of a glTF file in its rest state. */
#include "tool/io/format_reader.h"
#include "tool/io/gltf/gltf_extensions.h"
#include "tool/io/gltf/gltf_parts.h"
#include "tool/io/gltf/gltf_pose.h"
#include "tool/io/growable.h"

#include <stdlib.h>
#include <string.h>

static bool allocate_mesh(const gltf_scene *scene, mesh_file *mesh) {
    file_reader *reader = scene->document.reader;
    mesh->vertex_count = scene->vertex_count;
    mesh->triangle_count = scene->triangle_count;
    mesh->positions = gltf_allocate(reader, mesh->vertex_count, 3 * sizeof *mesh->positions);
    if (mesh->positions == NULL) return false;
    mesh->triangles = gltf_allocate(reader, mesh->triangle_count, 3 * sizeof *mesh->triangles);
    if (mesh->triangles == NULL) return false;
    mesh->polygons = gltf_allocate(reader, mesh->triangle_count, sizeof *mesh->polygons);
    return mesh->polygons != NULL;
}

/* A node that mirrors its mesh turns the triangles around, as the format demands; joints leave them. */
static void write_triangles(const gltf_scene *scene, const gltf_pose *pose, mesh_file *out) {
    uint32_t *corner = out->triangles;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const gltf_instance *instance = &scene->instances[i];
        const gltf_mesh *mesh = &scene->meshes[instance->mesh];
        const gltf_transform place = gltf_pose_place(pose, instance);
        const bool mirrored = instance->skin == GLTF_NONE && gltf_transform_mirrors(&place);
        const uint32_t(*triangles)[3] = mesh->triangles.data;
        for (size_t t = 0; t < mesh->triangles.count; t++, corner += 3) {
            corner[0] = instance->first_vertex + triangles[t][0];
            corner[1] = instance->first_vertex + triangles[t][mirrored ? 2 : 1];
            corner[2] = instance->first_vertex + triangles[t][mirrored ? 1 : 2];
        }
    }
}

/* Which face of the file each triangle is: one that names a vertex twice is dropped, and keeps its number. */
static void write_polygons(const gltf_scene *scene, mesh_file *out) {
    uint32_t *polygon = out->polygons;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        const gltf_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        const uint32_t *faces = mesh->faces.data;
        for (size_t t = 0; t < mesh->faces.count; t++) *polygon++ = out->polygon_count + faces[t];
        if (mesh->dropped_count > 0 && out->repairs.dropped == 0)
            out->repairs.first_dropped = out->polygon_count + mesh->first_dropped;
        out->repairs.dropped += mesh->dropped_count;
        out->repairs.skipped_primitives += mesh->skipped_primitives;
        out->polygon_count += mesh->face_count;
    }
    out->faces_hash = MESH_HASH_START;
    for (size_t t = 0; t < out->triangle_count; t++)
        out->faces_hash = mesh_file_hash(out->faces_hash, out->triangles + 3 * t, 3);
}

/* A glTF has no groups. */
static bool find_parts(const gltf_scene *scene, mesh_file *mesh) {
    const mesh_parts_by by = scene->document.reader->parts_by;
    if (by == MESH_PARTS_BY_FILE) return gltf_parts_of(scene, &mesh->parts);
    return gltf_parts_of(scene, &mesh->own_parts) &&
           (by != MESH_PARTS_BY_MATERIAL || gltf_parts_of_materials(scene, &mesh->parts));
}

static bool read_gltf(file_reader *reader, mesh_file *out) {
    gltf_scene scene;
    gltf_pose pose = {0};
    mesh_file mesh = {0};
    if (!gltf_scene_open(reader, &scene)) return false;
    size_t animations = 0;
    const bool done = gltf_array_length(&scene.document.root, "animations", &animations) &&
                      gltf_pose_open(&scene, &pose) && allocate_mesh(&scene, &mesh) &&
                      gltf_pose_write(&pose, mesh.positions) && find_parts(&scene, &mesh) &&
                      gltf_extensions_note(&scene, &mesh.unread);
    if (done) {
        write_triangles(&scene, &pose, &mesh);
        write_polygons(&scene, &mesh);
        mesh.animation_count = animations < UINT32_MAX ? (uint32_t)animations : UINT32_MAX;
        *out = mesh;
    } else {
        mesh_file_free(&mesh);
    }
    gltf_pose_close(&pose);
    gltf_scene_close(&scene);
    return done;
}

const format_reader gltf_reader = {MESH_FORMAT_GLTF, .names_parts = true, .recognise = gltf_recognise,
                                   .read = read_gltf};
