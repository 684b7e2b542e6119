/* The nodes of a glTF file: a forest, where its parts stand at rest, and which of them the scene shows. */
#pragma once

#include "tool/io/gltf/gltf_document.h"
#include "tool/io/gltf/gltf_transform.h"

typedef struct gltf_node {
    uint32_t parent, first_child, last_child, next_sibling; /* GLTF_NONE: none */
    uint32_t mesh, skin;                                    /* GLTF_NONE: none */
    bool reached;    /* a root leads to it, as to every node of a forest */
    bool shown;      /* in the default scene */
    bool has_matrix; /* then the placement says nothing */
    gltf_transform matrix;
    gltf_placement placement;
    const char *name; /* NULL: none; the document's */
} gltf_node;

typedef struct gltf_nodes {
    gltf_node *nodes;
    uint32_t count;
    uint32_t *order; /* count: every node behind its parent, and children in the order of the file */
} gltf_nodes;

/* Fails when the nodes are not a forest. On false *out owns nothing, and the reader's error is set. */
bool gltf_nodes_open(gltf_document *document, size_t mesh_count, size_t skin_count, gltf_nodes *out);
void gltf_nodes_close(gltf_nodes *nodes);
