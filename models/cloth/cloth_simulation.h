/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#pragma once

#include "models/cloth/apart.h"
#include "models/cloth/cloth_scene.h"
#include "models/cloth/safe_motion.h"

/* So far. total_ms is that of cloth_advance; near_ms and step_ms are spent in cscd. */
typedef struct cloth_statistics {
    uint32_t frames;
    double total_ms, near_ms, step_ms;
    uint64_t near_pairs;  /* that cscd_detector_near found */
    uint64_t most_rounds; /* detector steps of one frame */
    double waited;        /* frames that obstacles have lost */
    safe_motion_counts motion;
} cloth_statistics;

typedef struct cloth_simulation {
    const cloth_scene *scene;
    double spacing;                      /* of the garment's vertices */
    body garment;                        /* as it begins */
    body obstacles[CLOTH_OBSTACLES_MAX]; /* about their centres */
    cscd_context *context;               /* the caller's */
    cscd_mesh *mesh;                     /* object 0: the garment; then the obstacles */
    uint32_t *seams;                     /* pairs of the garment's vertices, NULL: none */
    uint32_t seam_count;
    fabric cloth;
    double *inverse_masses; /* here and below for all vertices of the scene; 0: an obstacle's */
    double *positions;      /* now: free of contact, and reached without any */
    double *start;          /* of the last frame, likewise */
    double *target, *previous, *velocities;
    apart pairs;
    safe_motion safe;
    double clock; /* of the obstacles: stands still while they wait */
    cloth_statistics statistics;
} cloth_simulation;

/* Resolution 0: the scene's own. The context outlives it. On false there is nothing to close, and *error says
 * why. */
bool cloth_open(const cloth_scene *s, uint32_t resolution, cscd_context *context, cloth_simulation *out,
                io_error *error);
void cloth_close(cloth_simulation *c);

/* On to the next frame: from `start` to `positions` in straight lines nothing meets, nor comes nearer than
 * cloth_separation says. */
bool cloth_advance(cloth_simulation *c, io_error *error);

/* The distance that the solver keeps, as long as it can; and the one that is certified so far, which is
 * smaller where the cloth was pressed together. */
double cloth_thickness(const cloth_simulation *c);
double cloth_separation(const cloth_simulation *c);
