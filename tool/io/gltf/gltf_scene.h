/* The scene of a glTF file: meshes, nodes and skins, the instances that it shows, and where they are at a
 * moment. */
#pragma once

#include "tool/io/gltf/gltf_document.h"
#include "tool/io/io.h"

/* ---- meshes: vertices with their morph targets and joints, and triangles ------------------------------- */

/* The vertices of one or more primitives: those with the same accessors share them. */
typedef struct gltf_vertices {
    gltf_accessor positions;
    gltf_accessor *targets; /* of the mesh's target_count: what is added to the positions, times a weight */
    uint32_t influences;    /* joints per vertex, a multiple of 4; 0: not skinned */
    uint32_t *joints;       /* positions.count * influences; 0 where the weight is 0 */
    double *weights;        /* of each vertex sum 1, or all 0 */
    uint32_t largest_joint; /* with a weight */
    uint32_t first;         /* in the mesh */
    growable
        accessors; /* of uint32_t: the indices of all accessors, which tell whether two primitives share */
} gltf_vertices;

/* The triangles of a primitive, behind those of the one before. */
typedef struct gltf_material_run {
    size_t triangle_end;
    uint32_t material; /* GLTF_NONE: none */
} gltf_material_run;

typedef struct gltf_mesh {
    gltf_vertices *vertices;
    uint32_t vertices_count; /* of the array above */
    uint32_t vertex_count;   /* of all */
    uint32_t target_count;
    double *default_weights; /* target_count */
    growable triangles;      /* of uint32_t[3] */
    growable materials;      /* of gltf_material_run, where parts are asked for by material; else empty */
    growable faces;          /* of uint32_t: which face of the mesh a triangle is */
    uint32_t face_count;     /* with those that were dropped */
    uint32_t dropped_count, first_dropped; /* triangles that name a vertex twice */
    uint32_t skipped_primitives;           /* of points or lines */
    const char *name;                      /* NULL: none; the document's */
} gltf_mesh;

/* On false *out owns nothing, and the reader's error is set. */
bool gltf_mesh_open(gltf_document *document, uint32_t index, gltf_mesh *out);
void gltf_mesh_close(gltf_mesh *mesh);

/* The attributes of a set of four joints and weights: JOINTS_0, WEIGHTS_0, ... */
typedef struct gltf_joint_names {
    char joints[24], weights[24];
} gltf_joint_names;

gltf_joint_names gltf_joints_name(uint32_t set);
uint32_t gltf_joints_sets(const gltf_element *attributes);

/* Reads the joints and weights of vertices whose positions are known. */
bool gltf_joints_read(gltf_document *document, const gltf_element *attributes, gltf_vertices *vertices);

/* ---- nodes: a forest, which of them the scene shows, and their instances ------------------------------- */

/* x becomes rows * (x, 1). */
typedef struct gltf_transform {
    double rows[3][4];
} gltf_transform;

/* Translation, rotation (a quaternion x, y, z, w) and scale, as files have them. */
typedef struct gltf_placement {
    double translation[3], rotation[4], scale[3];
} gltf_placement;

gltf_transform gltf_transform_identity(void);
/* Scale first, then rotation, then translation. The quaternion need not be of length 1; of length 0 it turns
 * nothing. */
gltf_transform gltf_transform_of_placement(const gltf_placement *placement);
/* From 16 numbers, column by column; the last row is taken as 0 0 0 1. */
gltf_transform gltf_transform_of_columns(const double columns[16]);

/* b first, then a. */
gltf_transform gltf_transform_multiply(const gltf_transform *a, const gltf_transform *b);
void gltf_transform_apply(const gltf_transform *a, const double x[3], double out[3]);
/* True if the transform turns the inside out. */
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

/* The places of the copies of a node's mesh, seen from the node. */
typedef struct gltf_instancing {
    uint32_t count; /* 0: the node has no such extension, and its mesh is there once */
    bool has_translation, has_rotation, has_scale;
    gltf_accessor translation, rotation, scale; /* of as many elements as there are copies */
} gltf_instancing;

/* Reads the instancing of the node with this index, which has a mesh. On false the reader's error is set. */
bool gltf_instancing_open(gltf_document *document, uint32_t node, gltf_instancing *out);

/* The place of a copy below the count. */
gltf_transform gltf_instancing_place(const gltf_instancing *copies, uint32_t copy);

/* ---- skins: the nodes that move vertices as joints, and the weights of vertices ------------------------ */

typedef struct gltf_skin {
    uint32_t joint_count;
    uint32_t *joints;             /* joint_count nodes */
    gltf_transform *inverse_bind; /* joint_count: from the mesh to the joint */
} gltf_skin;

/* ---- what the default scene shows: its nodes with meshes, one behind the other ------------------------- */

/* A node with a mesh, or one of the copies of it that its instancing makes. Two nodes may have the same
 * mesh. */
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

/* The reader stays the caller's, and open as long as the scene. On false *out owns nothing, and the reader's
 * error is set. */
bool gltf_scene_open(file_reader *reader, gltf_scene *out);
void gltf_scene_close(gltf_scene *scene);

/* ---- where nodes are at one moment, and with them the vertices ----------------------------------------- */

/* An animation writes placements and weights, and asks for positions. */
typedef struct gltf_pose {
    const gltf_scene *scene;
    gltf_placement *placements; /* of each node; not used where the node has a matrix */
    uint32_t *first_weight;     /* of each node, in weights: as many as its mesh has targets */
    double *weights;
    gltf_transform *world; /* of each node */
    gltf_transform *joints;
} gltf_pose;

/* A pose at rest. The scene must outlive it. On false *out owns nothing, and the error of the scene's reader
 * is set. */
bool gltf_pose_open(const gltf_scene *scene, gltf_pose *out);
void gltf_pose_close(gltf_pose *pose);

/* The transforms of all nodes follow their placements. */
void gltf_pose_update(gltf_pose *pose);
/* The place of an instance that no joints move, after an update. */
gltf_transform gltf_pose_place(const gltf_pose *pose, const gltf_instance *instance);
/* Writes the scene's vertices after an update; false, with the node, when one of them is not finite. */
bool gltf_pose_write(gltf_pose *pose, double *positions);

/* ---- extensions: those that the file requires must be read, and those that it only uses are named ------ */

/* False, with the reader's error, when the file requires an extension that is not read and may change where
 * surfaces are. */
bool gltf_extensions_check(const gltf_element *root);

/* Writes a sentence, which the caller frees, about extensions of the nodes, meshes and views that the scene
 * shows, which are not read though they may change where surfaces are; *out is NULL when there are none. */
bool gltf_extensions_note(const gltf_scene *scene, char **out);
