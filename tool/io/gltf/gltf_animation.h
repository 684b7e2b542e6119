/* An animation of a glTF file: keys of placements and weights over time. */
#pragma once

#include "tool/io/gltf/gltf_pose.h"

typedef enum gltf_path { GLTF_TRANSLATION, GLTF_ROTATION, GLTF_SCALE, GLTF_WEIGHTS } gltf_path;
typedef enum gltf_interpolation { GLTF_LINEAR, GLTF_STEP, GLTF_CUBICSPLINE } gltf_interpolation;

/* What moves one property of one node. */
typedef struct gltf_channel {
    uint32_t node;
    gltf_path path;
    gltf_interpolation interpolation;
    uint32_t width; /* numbers of a key: 3, 4, or as many as there are weights */
    gltf_accessor times, values;
} gltf_channel;

typedef struct gltf_animation {
    gltf_channel *channels;
    uint32_t channel_count;
    double start, end; /* the first and the last key of all channels, in seconds */
} gltf_animation;

/* The animation of this name, or with NULL the first one. On false *out owns nothing, and the error of the scene's reader is
 * set. */
bool gltf_animation_open(gltf_scene *scene, const char *name, gltf_animation *out);
/* The number of animations, and the names of all; "..." stands for those that do not fit into size, which is 16 or more. */
bool gltf_animation_names(const gltf_scene *scene, size_t *count, char *text, size_t size);
void gltf_animation_close(gltf_animation *animation);

/* Moves the pose to this time; before its first key a channel holds that, and behind its last one that. */
void gltf_animation_apply(const gltf_animation *animation, double time, gltf_pose *pose);

/* Whether two times are the same but for the rounding of files, which hold them as floats. */
bool gltf_same_time(double a, double b);
