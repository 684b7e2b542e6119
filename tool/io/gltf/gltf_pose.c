/* The nodes of a glTF scene at one moment, and with them its vertices. */
#include "tool/io/gltf/gltf_scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

/* ---- at rest ----------------------------------------------------------------------------------------- */

/* A node's weights replace those of its mesh. */
static bool read_weights(const gltf_pose *pose, uint32_t index) {
    const gltf_scene *scene = pose->scene;
    const gltf_node *node = &scene->nodes.nodes[index];
    if (node->mesh == GLTF_NONE || scene->meshes[node->mesh].vertices == NULL) return true;
    const gltf_mesh *mesh = &scene->meshes[node->mesh];
    double *weights = pose->weights + pose->first_weight[index];
    for (uint32_t i = 0; i < mesh->target_count; i++) weights[i] = mesh->default_weights[i];
    gltf_element element;
    bool given;
    return gltf_element_at(&scene->document.root, "nodes", "node", index, &element) &&
           gltf_numbers(&element, "weights", mesh->target_count, weights, &given);
}

static bool place_at_rest(const gltf_pose *pose) {
    for (uint32_t i = 0; i < pose->scene->nodes.count; i++) {
        pose->placements[i] = pose->scene->nodes.nodes[i].placement;
        if (!read_weights(pose, i)) return false;
    }
    return true;
}

static size_t count_weights(const gltf_scene *scene, uint32_t *first_weight) {
    size_t count = 0;
    for (uint32_t i = 0; i < scene->nodes.count; i++) {
        const uint32_t mesh = scene->nodes.nodes[i].mesh;
        first_weight[i] = (uint32_t)count;
        if (mesh != GLTF_NONE) count += scene->meshes[mesh].target_count;
    }
    return count;
}

static uint32_t most_joints(const gltf_scene *scene) {
    uint32_t most = 0;
    for (size_t i = 0; i < scene->skin_count; i++)
        most = scene->skins[i].joint_count > most ? scene->skins[i].joint_count : most;
    return most;
}

bool gltf_pose_open(const gltf_scene *scene, gltf_pose *out) {
    file_reader *reader = scene->document.reader;
    const size_t count = scene->nodes.count;
    gltf_pose pose = {.scene = scene};
    pose.placements = gltf_allocate(reader, count, sizeof *pose.placements);
    pose.first_weight = gltf_allocate(reader, count, sizeof *pose.first_weight);
    pose.world = gltf_allocate(reader, count, sizeof *pose.world);
    pose.joints = gltf_allocate(reader, most_joints(scene), sizeof *pose.joints);
    bool opened =
        pose.placements != NULL && pose.first_weight != NULL && pose.world != NULL && pose.joints != NULL;
    if (opened) {
        const size_t weight_count = count_weights(scene, pose.first_weight);
        opened =
            weight_count <= UINT32_MAX || file_reader_fail(reader, "has %zu weights, too many", weight_count);
        if (opened) pose.weights = gltf_allocate(reader, weight_count, sizeof *pose.weights);
        opened = opened && pose.weights != NULL && place_at_rest(&pose);
    }
    if (!opened) {
        gltf_pose_close(&pose);
        return false;
    }
    gltf_pose_update(&pose);
    *out = pose;
    return true;
}

void gltf_pose_close(gltf_pose *pose) {
    free(pose->placements);
    free(pose->first_weight);
    free(pose->weights);
    free(pose->world);
    free(pose->joints);
    *pose = (gltf_pose){0};
}

void gltf_pose_update(gltf_pose *pose) {
    const gltf_nodes *nodes = &pose->scene->nodes;
    for (uint32_t i = 0; i < nodes->count; i++) {
        const uint32_t index = nodes->order[i];
        const gltf_node *node = &nodes->nodes[index];
        const gltf_transform own =
            node->has_matrix ? node->matrix : gltf_transform_of_placement(&pose->placements[index]);
        pose->world[index] =
            node->parent == GLTF_NONE ? own : gltf_transform_multiply(&pose->world[node->parent], &own);
    }
}

gltf_transform gltf_pose_place(const gltf_pose *pose, const gltf_instance *instance) {
    const gltf_transform *node = &pose->world[instance->node];
    return instance->placed ? gltf_transform_multiply(node, &instance->place) : *node;
}

/* ---- vertices ---------------------------------------------------------------------------------------- */

/* The positions of the file, and what the targets add to them. */
static void morph_vertices(const gltf_vertices *vertices, uint32_t target_count, const double *weights,
                           double *positions) {
    for (uint32_t i = 0; i < vertices->positions.count; i++)
        gltf_accessor_get(&vertices->positions, i, positions + 3 * (size_t)i);
    for (uint32_t k = 0; k < target_count; k++) {
        if (weights[k] == 0) continue;
        for (uint32_t i = 0; i < vertices->positions.count; i++) {
            double difference[3], *x = positions + 3 * (size_t)i;
            gltf_accessor_get(&vertices->targets[k], i, difference);
            for (int axis = 0; axis < 3; axis++) x[axis] += weights[k] * difference[axis];
        }
    }
}

/* The mean of where the joints would take the vertex. A vertex without weights goes with its node. */
static void skin_vertex(const gltf_pose *pose, const gltf_vertices *vertices, uint32_t vertex,
                        const gltf_transform *node, double x[3]) {
    const size_t at = (size_t)vertex * vertices->influences;
    double sum[3] = {0, 0, 0};
    bool weighted = false;
    for (uint32_t k = 0; k < vertices->influences; k++) {
        const double weight = vertices->weights[at + k];
        double moved[3];
        if (weight == 0) continue;
        weighted = true;
        gltf_transform_apply(&pose->joints[vertices->joints[at + k]], x, moved);
        for (int axis = 0; axis < 3; axis++) sum[axis] += weight * moved[axis];
    }
    if (!weighted) gltf_transform_apply(node, x, sum);
    for (int axis = 0; axis < 3; axis++) x[axis] = sum[axis];
}

static void update_joints(gltf_pose *pose, const gltf_skin *skin) {
    for (uint32_t i = 0; i < skin->joint_count; i++)
        pose->joints[i] = gltf_transform_multiply(&pose->world[skin->joints[i]], &skin->inverse_bind[i]);
}

static bool check_finite(const gltf_pose *pose, const gltf_instance *instance, const double *positions,
                         uint32_t count) {
    for (size_t i = 0; i < 3 * (size_t)count; i++)
        if (!isfinite(positions[i]))
            return file_reader_fail(pose->scene->document.reader,
                                    "node %" PRIu32 ", mesh %" PRIu32
                                    ": coordinate %c of vertex %zu is %g, expected a finite number",
                                    instance->node, instance->mesh, "xyz"[i % 3], i / 3, positions[i]);
    return true;
}

static bool write_instance(gltf_pose *pose, const gltf_instance *instance, double *positions) {
    const gltf_mesh *mesh = &pose->scene->meshes[instance->mesh];
    const gltf_transform world = gltf_pose_place(pose, instance), *node = &world;
    if (instance->skin != GLTF_NONE) update_joints(pose, &pose->scene->skins[instance->skin]);
    for (uint32_t k = 0; k < mesh->vertices_count; k++) {
        const gltf_vertices *vertices = &mesh->vertices[k];
        double *x = positions + 3 * (size_t)vertices->first;
        const bool skinned = instance->skin != GLTF_NONE && vertices->influences > 0;
        morph_vertices(vertices, mesh->target_count, pose->weights + pose->first_weight[instance->node], x);
        for (uint32_t i = 0; i < vertices->positions.count; i++, x += 3) {
            if (skinned)
                skin_vertex(pose, vertices, i, node, x);
            else
                gltf_transform_apply(node, x, x);
        }
    }
    return check_finite(pose, instance, positions, mesh->vertex_count);
}

bool gltf_pose_write(gltf_pose *pose, double *positions) {
    for (uint32_t i = 0; i < pose->scene->instance_count; i++) {
        const gltf_instance *instance = &pose->scene->instances[i];
        if (!write_instance(pose, instance, positions + 3 * (size_t)instance->first_vertex)) return false;
    }
    return true;
}
