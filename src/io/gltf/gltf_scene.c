/* What the default scene of a glTF file shows: its nodes with meshes, one behind the other. */
#include "src/io/gltf/gltf_scene.h"

#include <inttypes.h>
#include <stdlib.h>

static bool use_mesh(gltf_scene *scene, uint32_t index) {
    gltf_mesh *mesh = &scene->meshes[index];
    return mesh->vertices != NULL || gltf_mesh_open(&scene->document, index, mesh);
}

static bool use_skin(gltf_scene *scene, uint32_t index) {
    gltf_skin *skin = &scene->skins[index];
    return skin->joints != NULL || gltf_skin_open(&scene->document, index, scene->nodes.count, skin);
}

/* The joints that the mesh names must be there. */
static bool check_joints(gltf_scene *scene, const gltf_instance *instance) {
    const gltf_mesh *mesh = &scene->meshes[instance->mesh];
    const uint32_t joint_count = scene->skins[instance->skin].joint_count;
    for (uint32_t i = 0; i < mesh->vertices_count; i++)
        if (mesh->vertices[i].influences > 0 && mesh->vertices[i].largest_joint >= joint_count)
            return file_reader_fail(
                scene->document.reader,
                "mesh %" PRIu32 " names joint %" PRIu32 ", but skin %" PRIu32 " has %" PRIu32 ", from 0",
                instance->mesh, mesh->vertices[i].largest_joint, instance->skin, joint_count);
    return true;
}

static bool add_instance(gltf_scene *scene, uint32_t node) {
    const gltf_node *shown = &scene->nodes.nodes[node];
    gltf_instance instance = {node, shown->mesh, shown->skin, scene->vertex_count};
    if (!use_mesh(scene, instance.mesh)) return false;
    if (instance.skin != GLTF_NONE && (!use_skin(scene, instance.skin) || !check_joints(scene, &instance)))
        return false;
    const gltf_mesh *mesh = &scene->meshes[instance.mesh];
    if (mesh->vertex_count > INT32_MAX - scene->vertex_count ||
        mesh->face_count > INT32_MAX - scene->face_count)
        return file_reader_fail(scene->document.reader,
                                "more than %" PRId32 " vertices or triangles, the most of a mesh", INT32_MAX);
    scene->vertex_count += mesh->vertex_count;
    scene->face_count += mesh->face_count;
    scene->triangle_count += (uint32_t)mesh->triangles.count;
    scene->instances[scene->instance_count++] = instance;
    return true;
}

static bool collect_instances(gltf_scene *scene) {
    scene->instances = gltf_allocate(scene->document.reader, scene->nodes.count, sizeof *scene->instances);
    if (scene->instances == NULL) return false;
    for (uint32_t i = 0; i < scene->nodes.count; i++) {
        const uint32_t node = scene->nodes.order[i];
        if (scene->nodes.nodes[node].shown && scene->nodes.nodes[node].mesh != GLTF_NONE &&
            !add_instance(scene, node))
            return false;
    }
    if (scene->triangle_count > 0) return true;
    return file_reader_fail(scene->document.reader,
                            "no triangles found in the %" PRIu32 " nodes with meshes of the default scene",
                            scene->instance_count);
}

bool gltf_scene_open(file_reader *reader, gltf_scene *out) {
    gltf_scene scene = {0};
    if (!gltf_document_open(reader, &scene.document)) return false;
    const gltf_element *root = &scene.document.root;
    bool opened = gltf_array_length(root, "meshes", &scene.mesh_count) &&
                  gltf_array_length(root, "skins", &scene.skin_count) &&
                  gltf_nodes_open(&scene.document, scene.mesh_count, scene.skin_count, &scene.nodes);
    if (opened) {
        scene.meshes = gltf_allocate(reader, scene.mesh_count, sizeof *scene.meshes);
        scene.skins = gltf_allocate(reader, scene.skin_count, sizeof *scene.skins);
        opened = scene.meshes != NULL && scene.skins != NULL && collect_instances(&scene);
    }
    if (opened)
        *out = scene;
    else
        gltf_scene_close(&scene);
    return opened;
}

void gltf_scene_close(gltf_scene *scene) {
    for (size_t i = 0; scene->meshes != NULL && i < scene->mesh_count; i++)
        gltf_mesh_close(&scene->meshes[i]);
    for (size_t i = 0; scene->skins != NULL && i < scene->skin_count; i++) gltf_skin_close(&scene->skins[i]);
    free(scene->meshes);
    free(scene->skins);
    free(scene->instances);
    gltf_nodes_close(&scene->nodes);
    gltf_document_close(&scene->document);
    *scene = (gltf_scene){0};
}
