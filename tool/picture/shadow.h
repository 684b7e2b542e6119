/* The ground below a body, and the soft shadow that the body casts straight down: each cell of a map of its heights spreads its shadow
 * over a disc that widens with its height above the point. */
#pragma once

#include "tool/io/io.h"
#include "tool/picture/camera.h"

#include <stdbool.h>
#include <stdint.h>

enum { PICTURE_SHADOW_TAPS = 160 };

/* A point of the disc around a shaded point in which the body is looked for; lengths in cells. */
typedef struct picture_shadow_tap {
    double offset[2], radius, area;
} picture_shadow_tap;

/* The body's least and greatest height over each cell of a level grid, as shares of its extent. */
typedef struct picture_shadow {
    uint32_t columns, rows;
    int across, along, up; /* axes */
    double origin[3];      /* of cell (0, 0), and the height 0 */
    double cell, extent;   /* of a cell, and the greatest of the body */
    float *low, *high;     /* low > high where there is no body */
    picture_shadow_tap taps[PICTURE_SHADOW_TAPS];
} picture_shadow;

/* On false *out is untouched. A body without extent casts no shadow. */
bool picture_shadow_create(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                           uint32_t triangle_count, bool y_up, picture_shadow *out, io_error *error);
void picture_shadow_free(picture_shadow *shadow);

/* How much light from above the body takes from a level surface at the point, 0 to 1: sharp and dark where
 * they are near, wider and fainter the farther the body is above. */
double picture_shadow_at(const picture_shadow *shadow, const double point[3]);

typedef struct picture_ground {
    double square; /* side of the squares; 0: none */
    bool y_up;     /* else z is up */
    const picture_shadow *shadow;
} picture_ground;

/* The share of the light that is left at pixel (x, y) in the given depth; normal and view (towards the eye)
 * are unit vectors in camera space. */
double picture_ground_light(const picture_ground *ground, const picture_camera *camera,
                            const double normal[3], const double view[3], double x, double y, double depth);
