/* The scenes of the cloth simulator: which garment falls how, onto what. */
#pragma once

#include "models/cloth/fabric.h"
#include "tool/io/io_error.h"

typedef enum cloth_cut { CLOTH_SHEET, CLOTH_TUBE, CLOTH_BAG } cloth_cut;

typedef enum cloth_obstacle_kind { CLOTH_BOX, CLOTH_BALL } cloth_obstacle_kind;

/* An obstacle with a given motion: from `begin` to `begin + seconds` it rises and turns about the vertical
 * axis through its centre; before and after that it rests. */
typedef struct cloth_obstacle {
    cloth_obstacle_kind kind;
    double size;      /* radius of a ball, or half the width of a box */
    double centre[3]; /* the centre of a ball, or of a box's top */
    double begin, seconds, rise;
    double turn; /* tangent of half the angle */
} cloth_obstacle;

enum { CLOTH_OBSTACLES_MAX = 2 };

/* Lengths in metres, masses in kilograms, times in seconds. */
typedef struct cloth_scene {
    const char *name, *text;
    cloth_cut cut;
    double width, height; /* side of a sheet; diameter and height of a tube; both of a bag */
    double depth;         /* how far a bag bulges to each side */
    uint32_t resolution;  /* default: vertices along a side (odd for a bag) or around a tube */
    double place[3];      /* middle of a sheet, or middle of the lower end of another garment */
    double turn, lean;    /* tangents of half the angles: about the vertical, then about the x axis */
    fabric_material stuff;
    double friction, gravity;
    uint32_t obstacle_count;
    cloth_obstacle obstacles[CLOTH_OBSTACLES_MAX];
    uint32_t frame_count;
    double frame_seconds;
    uint32_t small_steps; /* per frame */
} cloth_scene;

extern const cloth_scene cloth_scenes[];
extern const uint32_t cloth_scene_count;

/* Returns NULL when no scene has this name. */
const cloth_scene *cloth_scene_find(const char *name);

enum { CLOTH_RESOLUTION_MIN = 12, CLOTH_RESOLUTION_MAX = 500 };

/* Returns the mean distance of neighbouring vertices. */
double cloth_scene_spacing(const cloth_scene *s, uint32_t resolution);

/* Makes the garment in its first shape, which is also its shape at rest. */
body cloth_scene_garment(const cloth_scene *s, uint32_t resolution);

/* Returns *pair_count pairs of vertices that are sewn together, to be freed; NULL when there are none. */
uint32_t *cloth_scene_seams(const cloth_scene *s, uint32_t resolution, uint32_t *pair_count);

/* Makes the mesh of an obstacle about its centre; cloth_obstacle_place moves it. */
bool cloth_obstacle_make(const cloth_obstacle *o, body *out, io_error *error);
void cloth_obstacle_place(const cloth_obstacle *o, const body *shape, double time, double *positions);
