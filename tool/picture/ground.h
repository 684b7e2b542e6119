/* Faint squares and the shadow of the body, which let a viewer read scenery as the ground below it. */
#pragma once

#include "tool/picture/camera.h"
#include "tool/picture/shadow.h"

typedef struct picture_ground {
    double square; /* side of the squares; 0: none */
    bool y_up;     /* else z is up */
    const picture_shadow *shadow;
} picture_ground;

/* The share of the light that is left at pixel (x, y) in the given depth; normal and view (towards the eye)
 * are unit vectors in camera space. */
double picture_ground_light(const picture_ground *ground, const picture_camera *camera,
                            const double normal[3], const double view[3], double x, double y, double depth);
