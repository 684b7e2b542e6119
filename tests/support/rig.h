/* A context, a mesh and a detector for a scene; any failure fails the test. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/scenes.h"

typedef struct rig {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} rig;

/* options: NULL for the defaults. */
rig rig_create(const scene *s, uint32_t thread_count, const cscd_detector_options *options);
void rig_destroy(rig *r);
cscd_contacts rig_step(const rig *r, const scene *s);
