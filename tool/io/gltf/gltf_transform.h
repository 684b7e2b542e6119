/* Affine maps of glTF nodes. */
#pragma once

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
