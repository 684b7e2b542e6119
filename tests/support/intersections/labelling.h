/* Labels of triangles, and sums by pair of parts that look at every list anew for every pair of parts. */
#pragma once

#include "tests/support/intersections/body_rig.h"

/* A label for each triangle of a scene. */
typedef struct labelling {
    uint32_t items[SCENE_TRIANGLES_MAX];
    uint32_t count; /* of parts */
} labelling;

/* Those that a detector goes by unless it is given others. */
void labelling_of_objects(labelling *l, const body_rig *r);

/* So many parts by chance; some triangles are in none. */
void labelling_draw(labelling *l, const body_rig *r, uint32_t count, uint64_t seed);
void labelling_set(const labelling *l, const body_rig *r);

/* Compares all sums of what was found, and returns how many pairs of parts there are. */
size_t labelling_compare(const labelling *l, const body_rig *r);

/* Three objects that go through each other and one through itself, and what is found of them with parts; find: with depths. */
void labelled_scene_open(body_rig *r, const cscd_detector_options *options, uint32_t thread_count);
cscd_status labelled_scene_try(body_rig *r, cscd_intersection_options options);
void labelled_scene_find(body_rig *r);
