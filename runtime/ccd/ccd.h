/* Elementary tests: do a moving vertex and face, or two moving edges, touch or come within a distance, and
 * when? And how far apart are such features at rest? */
#pragma once

#include "cscd/detector.h"
#include "src/core/context.h"
#include "src/core/kernels.h"

#include <stdbool.h>

/* ---- pairs --------------------------------------------------------------------------------------------- */

/* Two features of four points together, all moving linearly from x0 (t = 0) to x1 (t = 1).
 * VF: x[0] the vertex, x[1..3] the face. EE: x[0], x[1] the one edge, x[2], x[3] the other. */
typedef struct elementary_query {
    double x0[4][3], x1[4][3];
} elementary_query;

/* Returns how many of the four points belong to the first feature, as its vertex or as the ends of its edge. */
static inline int points_of_first(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? 1 : 2;
}

/* The points of a stencil are those of a vertex and a face, or of two edges, one point of which it may have
 * several times. */
static inline cscd_contact_kind stencil_points(cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV ? CSCD_CONTACT_EE : CSCD_CONTACT_VF;
}

/* The first touch. u, v, point and normal as in cscd_contact. */
typedef struct elementary_contact {
    double toi, u, v;
    double point[3], normal[3];
} elementary_contact;

/* The level that decided. Each level is certified, and the next one sees only what it left open. */
typedef enum elementary_level {
    ELEMENTARY_SIGNS, /* separating directions, signs of the coplanarity cubic */
    ELEMENTARY_ROOTS, /* intervals about its roots */
    ELEMENTARY_EXACT  /* exact arithmetic */
} elementary_level;

enum { ELEMENTARY_LEVEL_COUNT = 3 };

typedef struct elementary_verdict {
    bool touching;
    elementary_level level;
} elementary_verdict;

/* Decides pairs that the kernel of level one leaves undecided (see ccd_kernels). The result depends on
 * nothing but the query; *contact is written only when they touch. Features are closed, and so is the interval.
 */
elementary_verdict elementary_after_signs(const elementary_query *query, cscd_contact_kind kind,
                                          elementary_contact *contact);

/* Are the two features farther apart than the distance along one of the seven directions of 14-DOPs, at both
 * ends and on the same side? Then they are throughout. The filters of the detector's methods work in floats
 * and leave out only pairs of which this is true. Asking for the features' own points gives each method the
 * same pairs, whatever its trees. */
bool directions_part(const elementary_query *query, cscd_contact_kind kind, double distance);

/* ---- the coplanarity cubic: its roots are the times at which four moving points are coplanar ----------- */

/* Three vectors between the points, at t = 0 ([0]) and t = 1 ([1]), rounded differences. VF: a, b the sides
 * of the face at its first corner, c from there to the vertex. EE: a, b the edges, c from the start of a to
 * that of b. */
typedef struct point_vectors {
    double a[2][3], b[2][3], c[2][3];
    double size_a[3], size_b[3], size_c[3]; /* largest magnitude of each component over both ends */
} point_vectors;

void point_vectors_from(const elementary_query *query, cscd_contact_kind kind, point_vectors *out);

typedef struct coplanarity {
    double b[4];  /* Bernstein coefficients of (A x B) . C */
    double error; /* no computed coefficient, nor a value between them, is farther from the exact one */
} coplanarity;

coplanarity coplanarity_cubic(const point_vectors *vectors);

/* Describes a contact: a time that is safe to step to, the points and the normal. f is the features'
 * coplanarity cubic. toi is not after the first touch, and before it by at most 2^-31. contact->toi is
 * earlier than toi by at most 2^-32, so that positions at it, rounded to doubles, have not passed each other
 * yet. */
void contact_frame_describe(const elementary_query *query, cscd_contact_kind kind, const coplanarity *f,
                            double toi, elementary_contact *contact);

/* ---- minimum separation: do moving features come within a distance, and when? -------------------------- */

/* Both are lengths above 0. */
typedef struct separation {
    double distance, tolerance;
} separation;

/* Returns INVALID_ARGUMENT, with a sentence, unless the one is a length or 0 and the other a share of it or
 * 0. */
cscd_status separation_check(cscd_context *context, double min_separation, double tolerance);

/* A distance and its tolerance, which is given as a share; 0: the default share. */
separation separation_limit(double distance, double tolerance);

/* Pairs within the distance are reported; pairs between it and the tolerance beyond it may be. */
separation proximity_limit(double distance);

/* Limits the steps from one moment to the next. Among 7.3 million tests in two frames of cloth in heavy
 * contact, with a distance of 1e-3 of the diagonal, five took 16 steps or more and none took 64. None of 20
 * million tests on other recordings took 16. */
enum { SEPARATION_STEPS_MAX = 128 };

/* The finest tolerance that separation_vf and separation_ee can promise, as a fraction of the query's extent.
 * The extent is the largest difference of a coordinate from that of the first point at t = 0. */
#define SEPARATION_FINEST 0x1p-42

/* These return true for all features that come within the distance. contact->toi is never after the first
 * moment at which they do. u and v name the nearest points at that time, and normal points from b's point to
 * a's. The points are then at most distance + max(tolerance, SEPARATION_FINEST * extent) apart, unless
 * *bounded is set: then the steps ran out, and toi is the last moment before which the features were proven
 * farther apart than the distance. *contact and *bounded are written only when true is returned. */
bool separation_vf(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded);
bool separation_ee(const elementary_query *query, const separation *limit, elementary_contact *contact,
                   bool *bounded);

/* The nearest points at the start, as a contact at time 0. */
void separation_describe(const elementary_query *query, cscd_contact_kind kind, elementary_contact *contact);

/* ---- floors: how near two features may come that are nearer already than they should be ---------------- */

/* The rungs of a pair are distance, ratio * distance, ratio^2 * distance and so on; ratio lies in (0, 1).
 * tolerance is a share of a rung. */
typedef struct floor_ladder {
    double distance, ratio, tolerance;
} floor_ladder;

/* Rungs below this share of the pair's extent at a moment count as 0: touching is decided exactly. The same
 * share of the extent is what a distance must exceed a rung by, in addition to the tolerance, to exceed it
 * surely. The extent is the largest difference of a coordinate from that of the first point. */
#define FLOOR_FINEST 0x1p-40

/* Returns the greatest rung below a distance, 0 if that is 0. */
double separation_floor_rung(const floor_ladder *ladder, double distance);

/* The floor of features at rest in these positions: the greatest rung that their distance surely exceeds, or
 * 0. It depends on nothing else, and a common translation changes the differences only, that is, nothing but
 * rounding. */
double separation_floor_at(const double x[4][3], cscd_contact_kind kind, const floor_ladder *ladder);

typedef enum floor_verdict {
    FLOOR_KEPT,   /* the features stay above their floor at the start, and it is no lower at the end */
    FLOOR_BROKEN, /* that is not certain; *contact and *bounded say when, as separation_vf does */
    FLOOR_NONE    /* the floor is 0 */
} floor_verdict;

floor_verdict separation_floor_test(const elementary_query *query, cscd_contact_kind kind,
                                    const floor_ladder *ladder, elementary_contact *contact, bool *bounded);

/* ---- planes: one that certainly lies between two features at rest, and how far apart it keeps them ----- */

/* The points of a pair along a direction. docs/theory/displacement-bounds.md, lemma 2, has the errors: with
 * a scale 2^e above the extent of the pair, the heights are off by 2^-50 of the scale and `gap` is at most
 * the distance of the features. Any direction does; a bad one only gives a small gap. */
typedef struct pair_plane {
    double normal[3];     /* from b to a; its length is 1 up to 2^-50 */
    double height[4];     /* of the points along it, above the first point */
    double low_a, high_b; /* the least height of a's points, and the greatest of b's */
    double gap;           /* certainly lies between these; above 0, or the plane proves nothing */
    double distance;      /* at least that of the features */
} pair_plane;

/* Finds a plane across the nearest points. x: the points, as in an elementary_query. */
void pair_plane_find(cscd_contact_kind kind, const double x[4][3], pair_plane *out);

/* Does the same along a direction that is known, from b's nearest point to a's, for nearest points that these weights
 * name. False: the plane proves less than 0.985 of their distance, and *out is not that of pair_plane_find. */
bool pair_plane_along(cscd_contact_kind kind, const double x[4][3], const double weights[4],
                      const double direction[3], pair_plane *out);

/* Returns a number that is at most the distance of the features less the length, and at least 0.985 times
 * that; 0 if they are no farther apart, or by less than 2^-352. Planes prove most of it, integers the rest. */
double pair_gap(cscd_contact_kind kind, const double x[4][3], double length);

/* ---- a moving vertex and a half-space ------------------------------------------------------------------ */

/* The normal is fixed, and the plane moves with a point. Tests are exact at distance 0, and with a distance
 * by bounds, since the vertex's height above the plane is linear in time. */

/* x[0] is the vertex, x[1] the point of the plane; both move linearly from x0 (t = 0) to x1 (t = 1). */
typedef struct half_space_query {
    double x0[2][3], x1[2][3];
    double normal[3]; /* out of the half-space, of any length but 0 */
} half_space_query;

/* The height of the vertex above the plane in the positions x; below 0 inside. The height is off by at most
 * `error`, and `extent` is the largest difference of a coordinate of the two points. */
typedef struct plane_height {
    double value, error, extent;
} plane_height;

plane_height half_space_height(const double x[2][3], const double normal[3]);

/* Is the vertex ever on the plane or behind it? contact->toi is never after the first such moment, and less
 * than 1e-9 before it. u and v are 0, and the normal is that of the half-space. *contact is written only
 * with true. */
elementary_verdict half_space_touch(const half_space_query *query, elementary_contact *contact);

/* Does the vertex come within the distance of the plane? What separation_vf promises holds here; nothing is
 * bounded. */
bool half_space_within(const half_space_query *query, double distance, elementary_contact *contact);

/* Does the vertex keep its floor above the plane? See separation_floor_test. */
floor_verdict half_space_floor_test(const half_space_query *query, const floor_ladder *ladder,
                                    elementary_contact *contact);

/* Returns a number that is at most the vertex's height less the length, and at least 0.985 times that; see
 * pair_gap. */
double half_space_gap(const double x[2][3], const double normal[3], double length);

/* The plane of the half-space as one between a pair. Its normal is the half-space's times a power of two,
 * without any rounding, so that it is not of length 1: `gap` and heights are in units of it. Returns its
 * length, or a little more. */
double half_space_plane(const double x[2][3], const double normal[3], pair_plane *out);

/* ---- points of features at rest ------------------------------------------------------------------------ */

/* These write parameters as in cscd_contact and return the squared distance. Faces may have no area, and
 * edges no length. (Ericson, Real-Time Collision Detection, 5.1.5 and 5.1.9.) */
double closest_point_triangle(const double p[3], const double a[3], const double b[3], const double c[3],
                              double *u, double *v);
double closest_segments(const double a0[3], const double a1[3], const double b0[3], const double b1[3],
                        double *u, double *v);

/* Writes the vector from the second feature's point to the first one's. x: the vertices, of which the first
 * `own` belong to the first feature; its weights add up to 1, the others' to -1. Sums differences of
 * coordinates, so that the result is as exact as these are. */
void connection_between(const double *const x[4], const double weights[4], int own, double out[3]);

/* Returns the length of a vector of any size: nothing over- or underflows. */
double connection_length(const double vector[3]);

/* ---- kernels: pairs of features, eight at a time ------------------------------------------------------- */

/* The points, triangles and edges that pairs of features name. */
typedef struct feature_source {
    const double *x0, *x1; /* three per vertex */
    const uint32_t (*triangles)[3], (*edges)[2];
} feature_source;

/* Pairs of features: vertex a[i] and triangle b[i], or edges a[i] and b[i]. Kernels take eight at a time, so
 * the arrays go on for seven more readable and writable places after the last pair. */
typedef struct feature_pairs {
    uint32_t *a, *b;
    uint32_t count;
} feature_pairs;

/* The verdicts on eight pairs, and for each contact the begin of the first root interval in which it
 * touches. */
typedef struct root_outcomes {
    uint32_t apart, contacts; /* sets of lanes */
    double begin[LANES];
} root_outcomes;

typedef void root_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                         root_outcomes *out);

/* Eight pairs that touch, and for each the begin of the root interval in which it does. */
typedef struct found_pairs {
    uint32_t a[LANES], b[LANES];
    double begin[LANES];
} found_pairs;

/* Their contacts, with members as in elementary_contact. */
typedef struct described_contacts {
    double toi[LANES], u[LANES], v[LANES], point[3][LANES], normal[3][LANES];
} described_contacts;

typedef void describe_kernel(const feature_source *source, const found_pairs *pairs, described_contacts *out);

/* The limits of eight pairs; see separation. */
typedef struct separations_x8 {
    double distance[LANES], tolerance[LANES];
} separations_x8;

/* The outcomes for eight pairs. Pairs apart certainly stay farther apart than their limit's distance and
 * tolerance. Pairs within its distance are so for certain at the start. For them u, v and offset name the
 * nearest points at the start as parameters and as the offset from b's point to a's; distance is the
 * offset's length. */
typedef struct proximity_outcomes {
    uint32_t apart, within; /* sets of lanes */
    double u[LANES], v[LANES], offset[3][LANES], distance[LANES];
} proximity_outcomes;

typedef void proximity_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                              const separations_x8 *limits, proximity_outcomes *out);

/* The nearest points of eight pairs at the start, for pairs that the kernel above has found within their limits: u and v are
 * the same; the distance is connection_length of the connection between the points, and the normal is the offset's direction. */
typedef struct nearest_points_x8 {
    double u[LANES], v[LANES], normal[3][LANES], distance[LANES];
} nearest_points_x8;

typedef void nearest_kernel(const feature_source *source, const uint32_t *a, const uint32_t *b,
                            nearest_points_x8 *out);

typedef struct ccd_kernels {
    /* Keep the pairs that signs leave undecided, in their order. The same operations as separated_by_axes and
     * coplanarity_excluded, so the same verdicts. */
    void (*reject_by_signs_vf)(const feature_source *source, feature_pairs *pairs);
    void (*reject_by_signs_ee)(const feature_source *source, feature_pairs *pairs);

    /* Level two for pairs a[0], b[0] to a[7], b[7]. These decide pairs whose cubic certainly has one root, */
    root_kernel *roots_vf, *roots_ee;

    /* and these pairs whose cubic certainly has two roots, or none. */
    root_kernel *two_roots_vf, *two_roots_ee;

    /* The same bits as contact_frame_describe. */
    describe_kernel *describe_vf, *describe_ee;

    /* Distances of pairs a[0], b[0] to a[7], b[7]. */
    proximity_kernel *proximity_vf, *proximity_ee;

    /* Their nearest points. */
    nearest_kernel *nearest_vf, *nearest_ee;
} ccd_kernels;

DECLARE_KERNELS(ccd_kernels);

static inline const ccd_kernels *ccd_kernels_of(const cscd_context *context) {
    return KERNELS_OF(context, ccd_kernels);
}
