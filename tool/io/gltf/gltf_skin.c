/* The skins of a glTF file: the nodes that move vertices as joints, and the weights of vertices. */
#include "tool/io/gltf/gltf_skin.h"

#include "tool/io/gltf/gltf_accessor.h"
#include "tool/io/gltf/gltf_mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

bool gltf_skin_open(gltf_document *document, uint32_t index, uint32_t node_count, gltf_skin *out) {
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

void gltf_skin_close(gltf_skin *skin) {
    free(skin->joints);
    free(skin->inverse_bind);
    *skin = (gltf_skin){0};
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

/* The sum of a vertex's weights is 1 but for rounding, which would pull it towards the origin. */
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
