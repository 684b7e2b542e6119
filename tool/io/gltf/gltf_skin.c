/* The skins of a glTF file: the nodes that move vertices as joints. */
#include "tool/io/gltf/gltf_skin.h"

#include "tool/io/gltf/gltf_accessor.h"

#include <inttypes.h>
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
