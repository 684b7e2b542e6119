/* The default scene of a glTF file: its nodes with meshes, one behind the other, and the skins that move
 * them. */
#include "tool/io/gltf/gltf_scene.h"

#include "tool/io/gltf/gltf_document.h"
#include "tool/io/io.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- skins --------------------------------------------------------------------------------------------- */

static bool read_joints(gltf_document *document, const gltf_element *element, uint32_t node_count,
                        gltf_skin *skin) {
    size_t count;
    if (!gltf_array_length(element, "joints", &count)) return false;
    if (count == 0 || count >= GLTF_NONE) return gltf_fail(element, "has %zu joints", count);
    skin->joint_count = (uint32_t)count;
    skin->joints = gltf_allocate(document->reader, count, sizeof *skin->joints);
    if (skin->joints == NULL) return false;
    for (size_t i = 0; i < count; i++)
        if (!gltf_index_at(element, "joints", i, "nodes", node_count, &skin->joints[i])) return false;
    return true;
}

static bool read_inverse_bind(gltf_document *document, const gltf_element *element, gltf_skin *skin) {
    gltf_accessor matrices;
    bool given;
    skin->inverse_bind = gltf_allocate(document->reader, skin->joint_count, sizeof *skin->inverse_bind);
    if (skin->inverse_bind == NULL ||
        !gltf_accessor_open(document, element, "inverseBindMatrices", 16, &matrices, &given))
        return false;
    if (given && matrices.count < skin->joint_count)
        return gltf_fail(element, "has %" PRIu32 " joints, but %" PRIu32 " inverse bind matrices",
                         skin->joint_count, matrices.count);
    for (uint32_t i = 0; i < skin->joint_count; i++) {
        double columns[16];
        skin->inverse_bind[i] = gltf_transform_identity();
        if (!given) continue;
        gltf_accessor_get(&matrices, i, columns);
        skin->inverse_bind[i] = gltf_transform_of_columns(columns);
    }
    return true;
}

static void gltf_skin_close(gltf_skin *skin) {
    free(skin->joints);
    free(skin->inverse_bind);
    *skin = (gltf_skin){0};
}

/* On false *out owns nothing, and the reader's error is set. */
static bool gltf_skin_open(gltf_document *document, uint32_t index, uint32_t node_count, gltf_skin *out) {
    gltf_element element;
    gltf_skin skin = {0};
    if (!gltf_element_at(&document->root, "skins", "skin", index, &element) ||
        !read_joints(document, &element, node_count, &skin) ||
        !read_inverse_bind(document, &element, &skin)) {
        gltf_skin_close(&skin);
        return false;
    }
    *out = skin;
    return true;
}

/* ---- which joints move a vertex, and with which weights -------------------------------------------------- */

gltf_joint_names gltf_joints_name(uint32_t set) {
    gltf_joint_names names;
    snprintf(names.joints, sizeof names.joints, "JOINTS_%" PRIu32, set);
    snprintf(names.weights, sizeof names.weights, "WEIGHTS_%" PRIu32, set);
    return names;
}

uint32_t gltf_joints_sets(const gltf_element *attributes) {
    for (uint32_t count = 0;; count++) {
        const gltf_joint_names names = gltf_joints_name(count);
        if (!gltf_has(attributes, names.joints) || !gltf_has(attributes, names.weights)) return count;
    }
}

static bool open_set(gltf_document *document, const gltf_element *attributes, uint32_t set,
                     uint32_t vertex_count, gltf_accessor *joints, gltf_accessor *weights) {
    const gltf_joint_names names = gltf_joints_name(set);
    if (!gltf_accessor_require(document, attributes, names.joints, 4, joints) ||
        !gltf_accessor_require(document, attributes, names.weights, 4, weights))
        return false;
    if (!gltf_accessor_is_index(joints))
        return gltf_fail(attributes, "%s are no unsigned integers", names.joints);
    if (joints->count == vertex_count && weights->count == vertex_count) return true;
    return gltf_fail(attributes,
                     "%s and %s are of %" PRIu32 " and %" PRIu32 " vertices, POSITION is of %" PRIu32,
                     names.joints, names.weights, joints->count, weights->count, vertex_count);
}

static bool read_set(const gltf_element *attributes, uint32_t set, const gltf_accessor *joints,
                     const gltf_accessor *weights, gltf_vertices *vertices) {
    for (uint32_t i = 0; i < joints->count; i++) {
        const size_t at = (size_t)i * vertices->influences + 4 * (size_t)set;
        double joint[4], weight[4];
        gltf_accessor_get(joints, i, joint);
        gltf_accessor_get(weights, i, weight);
        for (int k = 0; k < 4; k++) {
            if (!(weight[k] >= 0 && isfinite(weight[k])))
                return gltf_fail(attributes, "a weight of vertex %" PRIu32 " is %g, expected 0 or more", i,
                                 weight[k]);
            if (weight[k] == 0) continue;
            vertices->weights[at + (size_t)k] = weight[k];
            vertices->joints[at + (size_t)k] = (uint32_t)joint[k];
            if (vertices->largest_joint < (uint32_t)joint[k]) vertices->largest_joint = (uint32_t)joint[k];
        }
    }
    return true;
}

/* The sum of a vertex's weights is 1 up to rounding, which would pull it towards the origin. */
static void scale_weights(gltf_vertices *vertices) {
    for (uint32_t i = 0; i < vertices->positions.count; i++) {
        double *weights = vertices->weights + (size_t)i * vertices->influences, sum = 0;
        for (uint32_t k = 0; k < vertices->influences; k++) sum += weights[k];
        for (uint32_t k = 0; sum > 0 && k < vertices->influences; k++) weights[k] /= sum;
    }
}

bool gltf_joints_read(gltf_document *document, const gltf_element *attributes, gltf_vertices *vertices) {
    const uint32_t set_count = gltf_joints_sets(attributes);
    if (set_count == 0) return true;
    const size_t count = (size_t)vertices->positions.count * set_count;
    vertices->influences = 4 * set_count;
    vertices->joints = gltf_allocate(document->reader, count, 4 * sizeof *vertices->joints);
    if (vertices->joints == NULL) return false;
    vertices->weights = gltf_allocate(document->reader, count, 4 * sizeof *vertices->weights);
    if (vertices->weights == NULL) return false;
    for (uint32_t set = 0; set < set_count; set++) {
        gltf_accessor joints, weights;
        if (!open_set(document, attributes, set, vertices->positions.count, &joints, &weights) ||
            !read_set(attributes, set, &joints, &weights, vertices))
            return false;
    }
    scale_weights(vertices);
    return true;
}

/* ---- the scene ----------------------------------------------------------------------------------------- */

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
