/* Where the nodes of a glTF scene are at one moment, and with them its vertices. */
#pragma once

#include "tool/io/gltf/gltf_scene.h"

/* An animation writes placements and weights, and asks for positions. */
typedef struct gltf_pose {
    const gltf_scene *scene;
    gltf_placement *placements; /* of each node; not used where the node has a matrix */
    uint32_t *first_weight;     /* of each node, in weights: as many as its mesh has targets */
    double *weights;
    gltf_transform *world; /* of each node */
    gltf_transform *joints;
} gltf_pose;

/* A pose at rest. The scene must outlive it. On false *out owns nothing, and the error of the scene's reader is set. */
bool gltf_pose_open(const gltf_scene *scene, gltf_pose *out);
void gltf_pose_close(gltf_pose *pose);

/* The transforms of all nodes follow their placements. */
void gltf_pose_update(gltf_pose *pose);
/* Where an instance that no joints move is, after an update. */
gltf_transform gltf_pose_place(const gltf_pose *pose, const gltf_instance *instance);
/* Writes the scene's vertices after an update; false, with the node, when one of them is not finite. */
bool gltf_pose_write(gltf_pose *pose, double *positions);
