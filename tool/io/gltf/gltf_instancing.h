/* The extension EXT_mesh_gpu_instancing of nodes: many copies of one mesh, each with a place of its own. */
#pragma once

#include "tool/io/gltf/gltf_accessor.h"
#include "tool/io/gltf/gltf_transform.h"

#define GLTF_INSTANCING "EXT_mesh_gpu_instancing"

/* Where the copies of a node's mesh stand, seen from the node. */
typedef struct gltf_instancing {
    uint32_t count; /* 0: the node has no such extension, and its mesh is there once */
    bool has_translation, has_rotation, has_scale;
    gltf_accessor translation, rotation, scale; /* of as many elements as there are copies */
} gltf_instancing;

/* Of the node with this index, which has a mesh. On false the reader's error is set. */
bool gltf_instancing_open(gltf_document *document, uint32_t node, gltf_instancing *out);

/* The place of a copy below the count. */
gltf_transform gltf_instancing_place(const gltf_instancing *copies, uint32_t copy);
