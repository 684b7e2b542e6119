/* A context, a mesh, perhaps a plan, and a detector; any failure fails the test. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

typedef struct rig {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan; /* NULL: there is none */
    cscd_detector *detector;
} rig;

/* thread_count: 0 for the default. counter: counts the context's memory; NULL: nobody does. */
cscd_context *context_of(uint32_t thread_count, counting_allocator *counter);
cscd_mesh *mesh_of_scene(cscd_context *context, const scene *s);

/* The rig has the context from then on. positions: of all objects, for the plan that method KMEANS needs; else NULL. options: NULL
 * for the defaults. */
rig rig_of_objects(cscd_context *context, const cscd_object_desc *objects, uint32_t count,
                   const double *positions, const cscd_detector_options *options);
rig rig_create(const scene *s, uint32_t thread_count, const cscd_detector_options *options);
void rig_destroy(rig *r);

cscd_contacts rig_step(const rig *r, const scene *s);
