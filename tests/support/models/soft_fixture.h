/* Soft bodies for tests, far above the ground, and the quantities that the laws of motion keep. */
#pragma once

#include "models/shapes/body.h"
#include "models/softbody/softbody.h"

/* Computes to = matrix * from + offset for each point. */
void affine_map(double matrix[3][3], const double offset[3], const double *from, uint32_t point_count,
                double *to);

/* Computes a rotation by the angle (radians) about the axis, which may have any length. */
void rotation_matrix(const double axis[3], double angle, double out[3][3]);

/* Makes a box of twelve triangles; the bits of its corners' numbers are x, y, z. */
body box_body(const double low[3], const double high[3]);

/* Bodies at rest are this high, so that they do not reach the ground within a test. */
extern const double soft_fixture_height;
soft_body soft_body_of(const body *b, double spacing, const material *m);
void soft_body_lift(soft_body *b, double height);

typedef struct soft_momentum {
    double mass, centre[3], linear[3], angular[3]; /* angular is relative to the centre */
} soft_momentum;

soft_momentum soft_momentum_of(const soft_body *b);

/* Returns the largest distance between corresponding points. */
double largest_distance(const double *a, const double *b, uint32_t point_count);

double lowest_vertex(const soft_body *b);
