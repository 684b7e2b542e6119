/* A jointed figure of ten closed surfaces on ten bones, and 48 frames of its motion.
 *
 * Who meets whom is known beforehand. Eyes lie in their sockets, the teeth in the mouth and the belt around the trunk, in
 * all frames. A forearm is a capsule whose wrist swings towards the axis of the trunk, which is a capsule as well, so the
 * distance of the two surfaces is that of the wrist from the axis less both radii. It follows a cosine: the left forearm is in
 * the trunk from frame 17 to 31, deepest at 24, the right one from 36 to 44, deepest at 40. In the frames before and
 * after, the distance is ten times what the mesh lies within its capsule. Nothing else touches. */
#pragma once

#include "tool/io/io.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    MANNEQUIN_FRAMES = 48,
    MANNEQUIN_VERTICES_MAX = 2048,
    MANNEQUIN_TRIANGLES_MAX = 4096,
};

typedef enum mannequin_bone {
    BONE_TRUNK,
    BONE_HEAD,
    BONE_EYE_L,
    BONE_EYE_R,
    BONE_UPPER_ARM_L,
    BONE_FOREARM_L,
    BONE_UPPER_ARM_R,
    BONE_FOREARM_R,
    BONE_LEG_L,
    BONE_LEG_R,
    BONE_COUNT
} mannequin_bone;

/* Bones turn around an axis through their joint; parents come before their children. */
typedef struct mannequin_joint {
    const char *name;
    int parent; /* -1: none */
    double place[3];
    int axis;
} mannequin_joint;

extern const mannequin_joint mannequin_joints[BONE_COUNT];

typedef enum mannequin_part {
    PART_TRUNK,
    PART_HEAD,
    PART_EYE_L,
    PART_EYE_R,
    PART_TEETH,
    PART_BELT,
    PART_ARM_L,
    PART_ARM_R,
    PART_LEG_L,
    PART_LEG_R,
    MANNEQUIN_PARTS
} mannequin_part;

extern const char *const mannequin_part_names[MANNEQUIN_PARTS];

typedef struct mannequin {
    uint32_t vertex_count, triangle_count;
    float positions[MANNEQUIN_VERTICES_MAX][3]; /* at rest, which is frame 0 */
    uint32_t triangles[MANNEQUIN_TRIANGLES_MAX][3];
    uint8_t bones[MANNEQUIN_VERTICES_MAX][2];
    float weights[MANNEQUIN_VERTICES_MAX]; /* of the second bone; the first has the rest */
    uint32_t first_vertex[MANNEQUIN_PARTS + 1], first_triangle[MANNEQUIN_PARTS + 1];
} mannequin;

void mannequin_make(mannequin *m);

/* By how much a bone is turned, in radians. */
double mannequin_angle(int bone, int frame);

/* Positions of a frame: linear blend skinning. */
void mannequin_pose(const mannequin *m, int frame, double (*positions)[3]);

/* Writes the figure as glTF, a .glb file: a node with a mesh for each part, a skin and an animation, which the reader evaluates. */
bool skinned_file_write(const char *path, const mannequin *m, io_error *error);
