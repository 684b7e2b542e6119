/* The obstacles of a soft body: ground, stairs, balls. z is up. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

enum { BALLS_MAX = 8 };

/* A rigid ball that the body and the ground push. It slides, it does not spin. */
typedef struct ball {
    double centre[3], previous[3], velocity[3];
    double radius, mass;
} ball;

/* The ground lies at z = 0 below everything. Stairs descend along +x: step i of step_count covers the x
 * from start + i * tread to start + (i + 1) * tread, with its top at (step_count - i) * riser; before the
 * first step the top is level. A tray is a square of ground about the origin between walls of any height. */
typedef struct obstacles {
    uint32_t step_count, ball_count;
    double start, tread, riser;
    double tray;     /* half its width; 0: there is none */
    double friction; /* Coulomb's coefficient */
    double gravity;  /* acceleration downwards */
    ball balls[BALLS_MAX];
} obstacles;

/* Returns the height of ground or stairs at a place. */
double obstacles_height(const obstacles *o, double x);

/* How a point leaves an obstacle that it is inside of, and which one that is. */
typedef struct obstacle_hit {
    double normal[3], depth;
    ball *pushed; /* NULL: ground, stairs or walls */
} obstacle_hit;

/* Whether the point is inside ground, stairs or walls, or inside ball `which`; if not, *out is unchanged. */
bool obstacles_hit_terrain(const obstacles *o, const double point[3], obstacle_hit *out);
bool obstacles_hit_ball(obstacles *o, uint32_t which, const double point[3], obstacle_hit *out);

/* Move the balls: obstacles_begin moves them freely, then bodies may push them, then obstacles_end keeps
 * them off the terrain and each other and computes their new velocities. step: in seconds. */
void obstacles_begin(obstacles *o, double step);
void obstacles_end(obstacles *o, double step);

/* Returns the kinetic and potential energy of the balls. */
double obstacles_energy(const obstacles *o);
