/* Two wavy panels, one of which passes through the other, with a context and a detector: a host's small program. */
#pragma once

#include "cscd/cscd.h"

typedef struct panel_scene {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    uint32_t vertex_count; /* of both */
    double *x0, *x1;
} panel_scene;

/* Each panel has side * side vertices. options: NULL for the defaults. Any failure fails the test. */
panel_scene panels_create(uint32_t side, const cscd_context_options *context_options,
                          const cscd_detector_options *options);

/* Destroys what is not NULL. */
void panels_destroy(panel_scene *p);

/* These two make another mesh, and another detector; nothing is asserted. */
cscd_status panels_create_mesh(const panel_scene *p, cscd_context *context, cscd_mesh **out);
cscd_status panels_create_detector(const panel_scene *p, const cscd_detector_options *options,
                                   cscd_detector **out);

/* The calls of a solver. */
cscd_status panels_step(const panel_scene *p, cscd_contacts *out);
cscd_status panels_check(const panel_scene *p, cscd_intersections *out);
cscd_status panels_near(const panel_scene *p, cscd_proximities *out);
cscd_status panels_max_step(const panel_scene *p, cscd_free_step *out);
cscd_status panels_plan(const panel_scene *p, cscd_method method, cscd_plan **out);
