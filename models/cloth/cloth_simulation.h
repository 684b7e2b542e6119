/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#pragma once

#include "models/cloth/apart.h"
#include "models/cloth/bounded_motion.h"
#include "models/cloth/cloth_scene.h"
#include "models/cloth/safe_motion.h"

/* Totals since the start. total_ms is the time in cloth_advance; near_ms and step_ms are the parts of it
 * in cscd. */
typedef struct cloth_statistics {
    uint32_t frames;
    double total_ms, near_ms, step_ms;
    uint64_t near_pairs;          /* found by cscd_detector_find_near */
    uint64_t rounds, most_rounds; /* detector steps, or searches for bounds: all, and of one frame */
    double waited;                /* frames by which the obstacles are late */
    double wanted,
        lost; /* sums of the distances that vertices of the garment wanted to go, and that they are from there */
    safe_motion_counts motion;
} cloth_statistics;

typedef struct cloth_simulation {
    const cloth_scene *scene;
    double spacing;                      /* of the garment's vertices */
    body garment;                        /* as it begins */
    body obstacles[CLOTH_OBSTACLES_MAX]; /* each about its centre */
    cscd_context *context;               /* the caller's */
    cscd_mesh *mesh;                     /* object 0: the garment; then the obstacles */
    uint32_t *seams;                     /* pairs of the garment's vertices, NULL: none */
    uint32_t seam_count;
    fabric cloth;
    double *inverse_masses; /* these arrays have all vertices of the scene; 0: of an obstacle */
    double *positions;      /* now: without contact, and reached without contact */
    double *start;          /* the same at the last frame */
    double *target, *previous, *velocities;
    apart pairs;
    safe_motion safe;
    bounded_motion bounded; /* unless DRIVER_STEPS drives */
    double clock;           /* time of the obstacles; it stands still while they wait */
    cloth_statistics statistics;
} cloth_simulation;

/* Opens a scene; resolution 0 is its own. The context outlives the simulation. When it returns false,
 * there is nothing to close and *error says why. */
bool cloth_open(const cloth_scene *s, uint32_t resolution, motion_driver driver, cscd_context *context,
                cloth_simulation *out, io_error *error);
void cloth_close(cloth_simulation *c);

/* Advances by one frame. On straight lines from `start` to `positions` there is no contact, and nothing
 * comes nearer than cloth_separation. */
bool cloth_advance(cloth_simulation *c, io_error *error);

/* The first is the distance that the solver keeps as long as it can; the second is certified so far, and
 * smaller where cloth was pressed together. */
double cloth_thickness(const cloth_simulation *c);
double cloth_separation(const cloth_simulation *c);
