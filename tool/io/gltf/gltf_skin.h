/* The skins of a glTF file: the nodes that move vertices as joints, and the weights of vertices. */
#pragma once

#include "tool/io/gltf/gltf_document.h"
#include "tool/io/gltf/gltf_nodes.h"

typedef struct gltf_skin {
    uint32_t joint_count;
    uint32_t *joints;             /* joint_count nodes */
    gltf_transform *inverse_bind; /* joint_count: from the mesh to the joint */
} gltf_skin;

/* On false *out owns nothing, and the reader's error is set. */
bool gltf_skin_open(gltf_document *document, uint32_t index, uint32_t node_count, gltf_skin *out);
void gltf_skin_close(gltf_skin *skin);
