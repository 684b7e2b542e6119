/* Two panels for a host's small program: wavy ones that pass through each other, or equal ones that are sewn together. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/rig.h"

/* The wavy ones, with a context and a detector. */
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

/* ---- sewn panels --------------------------------------------------------------------------------------- */

enum {
    EQUAL_SIDE = 5,
    EQUAL_PANEL = EQUAL_SIDE * EQUAL_SIDE,
    EQUAL_VERTICES = 2 * EQUAL_PANEL,
    EQUAL_TRIANGLES = 2 * (EQUAL_SIDE - 1) * (EQUAL_SIDE - 1)
};

/* The vertices i and EQUAL_PANEL + i are sewn together. */
typedef struct equal_panels {
    counting_allocator counter;
    rig rig;
    cscd_context *context; /* these three are of the rig */
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_line_search *line;
    uint32_t seams[EQUAL_PANEL][2];
    double x0[EQUAL_VERTICES * 3], x1[EQUAL_VERTICES * 3], reached[EQUAL_VERTICES * 3];
    size_t touching; /* pairs of features, without the seams */
} equal_panels;

/* Any failure fails the test. */
void equal_panels_begin(equal_panels *p, double min_separation, uint32_t threads);
void equal_panels_end(equal_panels *p);

/* Takes all seams away. */
void equal_panels_open(const equal_panels *p);

/* Writes positions in which the first panel lies higher than the second one. */
void equal_panels_part(const equal_panels *p, double gap, double *x);

typedef enum host_callback { HOST_ALLOCATOR, HOST_PARALLEL_FOR, HOST_PROGRESS, HOST_IGNORE } host_callback;
