/* Single pairs: the elementary tests of a step by themselves, on four points each, for hosts that find their
 * pairs in another way. A batch of pairs goes through the kernels of a step, eight at a time, and is shared
 * by the threads of the context. Every result is that of cscd_detector_step, or of cscd_detector_find_near,
 * on a mesh with just these features, bit for bit. Part of cscd/cscd.h, which says what holds for every
 * function. Its structs never grow. */
#ifndef CSCD_PAIRS_API_H
#define CSCD_PAIRS_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Pairs of features, all of one kind, and the points that they have. Of the four points of a pair,
 *   VF  the first is the vertex a, the others are those of the triangle b;
 *   EE  the first two are the ends of the edge a, the others those of b.
 * Features that have a point in common touch there all the time, so pairs of neighbours do not belong in the
 * list. */
typedef struct cscd_pairs {
    cscd_contact_kind kind; /* VF or EE */
    uint32_t point_count;   /* of the positions, 1 or more */
    size_t pair_count;      /* 0 is allowed */
    const uint32_t *points; /* pair_count * 4 numbers below point_count; NULL: pair i has the points 4 i to
                             * 4 i + 3 */
} cscd_pairs;

/* What a pair does in an interval; the members are those of cscd_contact. */
typedef struct cscd_pair_contact {
    double toi; /* INFINITY: there is no contact, and all other members are 0 */
    bool contact, bounded;
    double u, v;
    double point[3], normal[3];
} cscd_pair_contact;

/* Tests each pair for contact while its points move in straight lines from x0 to x1, or at rest where x1 is
 * NULL, and writes pair_count results. Each view holds the positions of all points; object_count is 0.
 * min_separation and tolerance, a length and a share of it, are those of cscd_detector_options. An example, a
 * vertex that falls through a triangle, which prints "at 0.500":
 *
 *     const double x0[12] = {0.2, 0.2, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
 *     const double x1[12] = {0.2, 0.2, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
 *     const cscd_pairs one = {CSCD_CONTACT_VF, 4, 1, NULL};
 *     cscd_pair_contact found;
 *     cscd_pairs_step(context, &one, CSCD_DOUBLES(x0, 4), CSCD_DOUBLES(x1, 4), 0.0, 0.0, &found);
 *     printf("at %.3f\n", found.toi);
 */
CSCD_API cscd_status cscd_pairs_step(cscd_context *context, const cscd_pairs *pairs, const cscd_view *x0,
                                     const cscd_view *x1, double min_separation, double tolerance,
                                     cscd_pair_contact *out);

/* The nearest points of a pair at one moment; the members are those of cscd_proximity. */
typedef struct cscd_pair_distance {
    double distance; /* INFINITY: farther apart than was asked for, and all other members are 0 */
    double u, v;
    double point[3], normal[3];
} cscd_pair_distance;

/* Measures each pair at rest, as far as `distance`, a length above 0 or INFINITY, and writes pair_count
 * results. Pairs within `distance` are measured; pairs farther apart than (1 + 1e-6) times that are not,
 * up to the rounding that cscd_detector_find_near has, too. An example, two pairs of edges of six points, which
 * prints "1.0 1.5":
 *
 *     const double x[18] = {0, 0, 0, 2, 0, 0, 1, -1, 1, 1, 1, 1, 1, -1, -1.5, 1, 1, -1.5};
 *     const uint32_t points[8] = {0, 1, 2, 3, 0, 1, 4, 5};
 *     const cscd_pairs pairs = {CSCD_CONTACT_EE, 6, 2, points};
 *     cscd_pair_distance found[2];
 *     if (cscd_pairs_find_near(context, &pairs, CSCD_DOUBLES(x, 6), INFINITY, found) == CSCD_OK)
 *         printf("%.1f %.1f\n", found[0].distance, found[1].distance);
 */
CSCD_API cscd_status cscd_pairs_find_near(cscd_context *context, const cscd_pairs *pairs,
                                          const cscd_view *positions, double distance,
                                          cscd_pair_distance *out);

#ifdef __cplusplus
}
#endif

#endif
