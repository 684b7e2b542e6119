/* Which joints move a vertex, and with which weights. */
#include "tool/io/gltf/gltf_mesh.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

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
