/* Cloth that nothing passes through: a solver for cloth on the public API of cscd alone, frame by frame. */
#pragma once

#include "cscd/cscd.h"
#include "models/cloth/cloth_scene.h"

/* Totals since the start. total_ms is the time in cloth_advance, safe_ms the part of it in cscd. */
typedef struct cloth_statistics {
    uint32_t frames;
    double total_ms, safe_ms;
    uint64_t rounds, most_rounds; /* searches: all, and of one frame */
    double waited;                /* frames by which the obstacles are late */
    uint64_t cut, pushed;         /* motions that needed a change, and contacts on which impulses acted */
    double shares[CSCD_RESPONSE_COUNT]; /* sums over frames: of vertices by what they needed */
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
    cscd_detector *detector;
    double clock; /* time of the obstacles; it stands still while they wait */
    cloth_statistics statistics;
} cloth_simulation;

/* Opens a scene; resolution 0 is its own. The context outlives the simulation. When it returns false,
 * there is nothing to close and *error says why. */
bool cloth_open(const cloth_scene *s, uint32_t resolution, cscd_context *context, cloth_simulation *out,
                io_error *error);
void cloth_close(cloth_simulation *c);

/* Advances by one frame. On straight lines from `start` to `positions` there is no contact, and nothing
 * comes nearer than cloth_separation. */
bool cloth_advance(cloth_simulation *c, io_error *error);

/* The distance that is kept. */
double cloth_separation(const cloth_simulation *c);
