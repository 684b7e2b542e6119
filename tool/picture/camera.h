/* A perspective camera that frames a set of points. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Camera space is right-handed: right, down, forward. */
typedef struct picture_camera {
    double right[3], down[3], forward[3], eye[3];
    double focal;      /* pixels */
    double centre[2];  /* pixels from the upper left corner */
    double near_depth; /* nearer than this along `forward` nothing is drawn; 0.5 to 1 */
    double unit;       /* depths are lengths times this power of two: single precision holds any model's */
} picture_camera;

/* Looks from azimuth and elevation (degrees) so that the points (x, y, z each; the corners of a box, say)
 * just fit into the picture, with a margin. Azimuth 0 looks along +y (z up: x to the right) or along -z (y
 * up: x to the right); it grows towards +x. A positive elevation looks down from above. */
void picture_camera_frame(const double *points, size_t point_count, double azimuth, double elevation,
                          bool y_up, uint32_t width, uint32_t height, picture_camera *out);

enum { PICTURE_OUTERMOST = 5 };

/* Picks those of many points that decide where picture_camera_frame, with the same arguments, places the
 * eye. So a whole motion can be framed with a few points of each of its frames. */
void picture_camera_outermost(const double *points, size_t point_count, double azimuth, double elevation,
                              bool y_up, uint32_t width, uint32_t height, double out[PICTURE_OUTERMOST][3]);

/* Homogeneous pixel coordinates: the point lies at (out[0] / out[2], out[1] / out[2]) in depth out[2], in
 * the camera's unit, which is negative behind the eye. */
void picture_camera_project(const picture_camera *camera, const double point[3], double out[3]);

/* The point of the world seen at pixel (x, y) in the given depth. */
void picture_camera_unproject(const picture_camera *camera, double x, double y, double depth, double out[3]);

/* A direction in camera space. */
void picture_camera_turn(const picture_camera *camera, const double direction[3], double out[3]);
