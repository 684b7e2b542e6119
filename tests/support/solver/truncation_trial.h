/* What the tests of truncation share: a detector with a separation, two triangles, and a call in either scalar. */
#pragma once

#include "tests/support/rig.h"

/* A detector of a method, or of none where this is not built in, that keeps features apart. */
rig rig_apart(const scene *s, double apart, cscd_method method, uint32_t threads);

/* Makes two triangles, one above the other, at rest. */
void scene_two_triangles(scene *s, double apart);

/* Truncates the motion of a scene, whose coordinates are numbers of the scalar, in views of it; asserts OK. */
cscd_truncation truncate_scene(const rig *r, const scene *s, double radius, cscd_scalar scalar, double *end);
