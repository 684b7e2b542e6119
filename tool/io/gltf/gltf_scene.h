/* What the default scene of a glTF file shows: its nodes with meshes, one behind the other. */
#pragma once

#include "tool/io/gltf/gltf_mesh.h"
#include "tool/io/gltf/gltf_nodes.h"
#include "tool/io/gltf/gltf_skin.h"

/* A node with a mesh, or one of the copies of it that its instancing makes. Two nodes may have the same mesh. */
typedef struct gltf_instance {
    uint32_t node, mesh;
    uint32_t skin; /* GLTF_NONE: the node moves it, else the joints alone do */
    uint32_t first_vertex;
    bool placed;          /* a copy, */
    gltf_transform place; /* which stands here, seen from its node */
} gltf_instance;

typedef struct gltf_scene {
    gltf_document document;
    gltf_nodes nodes;
    gltf_mesh *meshes; /* mesh_count; those that no instance has are zeroed, as are skins */
    gltf_skin *skins;
    size_t mesh_count, skin_count;
    gltf_instance *instances; /* in the order of the nodes, and of their copies */
    uint32_t instance_count;
    uint32_t vertex_count, triangle_count;
    uint32_t face_count; /* with those that were dropped */
} gltf_scene;

/* The reader stays the caller's, and open as long as the scene. On false *out owns nothing, and the reader's error is
 * set. */
bool gltf_scene_open(file_reader *reader, gltf_scene *out);
void gltf_scene_close(gltf_scene *scene);
