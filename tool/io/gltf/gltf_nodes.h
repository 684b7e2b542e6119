/* The nodes of a glTF file: a forest, where its parts stand at rest, which of them the scene shows, and their instances. */
#pragma once

#include "tool/io/gltf/gltf_accessor.h"
#include "tool/io/gltf/gltf_document.h"

/* x becomes rows * (x, 1). */
typedef struct gltf_transform {
    double rows[3][4];
} gltf_transform;

/* Translation, rotation (a quaternion x, y, z, w) and scale, as files have them. */
typedef struct gltf_placement {
    double translation[3], rotation[4], scale[3];
} gltf_placement;

gltf_transform gltf_transform_identity(void);
/* Scale first, then rotation, then translation. The quaternion need not be of length 1; of length 0 it turns nothing. */
gltf_transform gltf_transform_of_placement(const gltf_placement *placement);
/* From 16 numbers, column by column; the last row is taken as 0 0 0 1. */
gltf_transform gltf_transform_of_columns(const double columns[16]);

/* b first, then a. */
gltf_transform gltf_transform_multiply(const gltf_transform *a, const gltf_transform *b);
void gltf_transform_apply(const gltf_transform *a, const double x[3], double out[3]);
/* Whether it turns the inside out. */
int gltf_transform_mirrors(const gltf_transform *a);

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
