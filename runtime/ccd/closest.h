/* Closest points of features at rest. */
#pragma once

/* These write parameters as in cscd_contact and return the squared distance. Faces may have no area, and
 * edges no length. (Ericson, Real-Time Collision Detection, 5.1.5 and 5.1.9.) */
double closest_point_triangle(const double p[3], const double a[3], const double b[3], const double c[3],
                              double *u, double *v);
double closest_segments(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                        double *u, double *v);
