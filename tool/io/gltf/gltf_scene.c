/* What the default scene of a glTF file shows: its nodes with meshes, one behind the other. */
#include "tool/io/gltf/gltf_scene.h"

#include "tool/io/gltf/gltf_nodes.h"
#include "tool/io/growable.h"

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

static bool add_instance(gltf_scene *scene, gltf_instance instance, growable *instances) {
    instance.first_vertex = scene->vertex_count;
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
    gltf_instance *added = growable_push(instances);
    if (added == NULL)
        return file_reader_fail(scene->document.reader, "out of memory after %zu meshes", instances->count);
    *added = instance;
    return true;
}

/* Once, or as often as its instancing says. */
static bool add_node(gltf_scene *scene, uint32_t node, growable *instances) {
    const gltf_node *shown = &scene->nodes.nodes[node];
    gltf_instance instance = {.node = node, .mesh = shown->mesh, .skin = shown->skin};
    gltf_instancing copies;
    if (!gltf_instancing_open(&scene->document, node, &copies)) return false;
    if (copies.count == 0) return add_instance(scene, instance, instances);
    instance.placed = true;
    for (uint32_t copy = 0; copy < copies.count; copy++) {
        instance.place = gltf_instancing_place(&copies, copy);
        if (!add_instance(scene, instance, instances)) return false;
        /* Without vertices nothing would end this but the count, of which many nodes may have the same. */
        if (scene->meshes[instance.mesh].vertex_count == 0) break;
    }
    return true;
}

static bool add_nodes(gltf_scene *scene, growable *instances) {
    for (uint32_t i = 0; i < scene->nodes.count; i++) {
        const uint32_t node = scene->nodes.order[i];
        if (scene->nodes.nodes[node].shown && scene->nodes.nodes[node].mesh != GLTF_NONE &&
            !add_node(scene, node, instances))
            return false;
    }
    return true;
}

static bool collect_instances(gltf_scene *scene) {
    growable instances = growable_of(sizeof(gltf_instance));
    const bool added = add_nodes(scene, &instances);
    scene->instance_count = (uint32_t)instances.count; /* of a vertex each at least */
    scene->instances = growable_take(&instances);
    if (!added) return false;
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
