/* Scenes in which bodies and cloth press on each other, and a solver that moves them frame by frame: what a response to
 * contacts is tried on. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"
#include "tool/io/io.h"

/* twist    a sheet that falls onto a ball, which then turns and winds it up
 * press    a hollow ball between two plates, the upper of which comes down
 * bounce   a ball with inner pressure that falls onto the floor, fast
 * stack    six sheets that fall onto each other, and onto the floor
 * sleeve   a tube whose ends turn against each other
 * bag      two panels sewn together on three sides that fall onto a ball
 * knot     a rope with a loose knot whose ends are pulled apart */
typedef enum response_kind {
    RESPONSE_TWIST,
    RESPONSE_PRESS,
    RESPONSE_BOUNCE,
    RESPONSE_STACK,
    RESPONSE_SLEEVE,
    RESPONSE_BAG,
    RESPONSE_KNOT,
    RESPONSE_KIND_COUNT
} response_kind;

const char *response_kind_name(response_kind kind);

/* The kinds of motion that a vertex may have. */
typedef enum vertex_role { ROLE_FREE, ROLE_FIRST_GRIP, ROLE_SECOND_GRIP } vertex_role;

typedef struct response_spring {
    uint32_t a, b;
    double rest, stiffness;
} response_spring;

enum { RESPONSE_OBJECTS_MAX = 8 };

/* One scene at the present moment. */
typedef struct response_scene {
    response_kind kind;
    body objects[RESPONSE_OBJECTS_MAX]; /* as they begin; those that move by themselves first */
    uint32_t object_count, free_object_count;
    uint32_t vertex_count, free_count, triangle_count;
    uint32_t *seams, seam_count;
    uint8_t *roles; /* per vertex */
    response_spring *springs;
    uint32_t spring_count;
    double spacing;  /* mean length of an edge */
    double pressure; /* 0: none */
    double gravity;
    double friction; /* of all objects */
    double frame_seconds;
    double clock; /* of what has a given motion */
    double *rest, *x, *velocities, *target, *inverse_masses;
} response_scene;

/* Makes a scene of about this number of triangles. */
bool response_scene_make(response_kind kind, uint32_t triangle_count, response_scene *out, io_error *error);
void response_scene_free(response_scene *s);

/* Writes where the solver would have all vertices at the end of the frame, if nothing were in their way, to s->target. */
void response_scene_aim(response_scene *s);

/* Takes over where they have come. obstacle_share: how far obstacles came of their way. */
void response_scene_take(response_scene *s, const double *reached, double obstacle_share);
