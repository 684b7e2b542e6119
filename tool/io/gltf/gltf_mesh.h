/* The meshes of a glTF file: vertices with their morph targets and joints, and triangles. */
#pragma once

#include "tool/io/gltf/gltf_accessor.h"
#include "tool/io/growable.h"

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
