/* The scenes of the cloth simulator: which garment falls how, onto what. */
#pragma once

#include "models/cloth/fabric.h"
#include "src/io/io_error.h"

typedef enum cloth_cut { CLOTH_SHEET, CLOTH_TUBE, CLOTH_BAG } cloth_cut;

typedef enum cloth_obstacle_kind { CLOTH_BOX, CLOTH_BALL } cloth_obstacle_kind;

/* Moves as it is told: from `begin` to `begin + seconds` it rises, and turns about the vertical through its
 * centre; before and afterwards it rests. */
typedef struct cloth_obstacle {
    cloth_obstacle_kind kind;
    double size;      /* radius of a ball; of a box its reach to the sides */
    double centre[3]; /* of a box: of its top */
    double begin, seconds, rise;
    double turn; /* tangent of half the angle */
} cloth_obstacle;

enum { CLOTH_OBSTACLES_MAX = 2 };

/* Lengths in metres, masses in kilograms, times in seconds. */
typedef struct cloth_scene {
    const char *name, *text;
    cloth_cut cut;
    double width, height; /* of a sheet its side; of a tube its diameter, and its height; of a bag both */
    double depth;         /* of a bag, to each side */
    uint32_t resolution;  /* vertices along a side (a bag's: made odd), or around a tube: the default */
    double place[3];      /* of a sheet's middle, or of the middle of the garment's foot */
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

/* NULL: there is none of this name. */
const cloth_scene *cloth_scene_find(const char *name);

enum { CLOTH_RESOLUTION_MIN = 12, CLOTH_RESOLUTION_MAX = 500 };

/* The mean distance of neighbouring vertices. */
double cloth_scene_spacing(const cloth_scene *s, uint32_t resolution);

/* The garment as it begins, which is how it rests. */
body cloth_scene_garment(const cloth_scene *s, uint32_t resolution);

/* *pair_count pairs of vertices of the garment that are sewn together, to be freed; none: NULL. */
uint32_t *cloth_scene_seams(const cloth_scene *s, uint32_t resolution, uint32_t *pair_count);

/* An obstacle as a mesh about its centre, to be placed by cloth_obstacle_place. */
bool cloth_obstacle_make(const cloth_obstacle *o, body *out, io_error *error);
void cloth_obstacle_place(const cloth_obstacle *o, const body *shape, double time, double *positions);
