/* Functions for solvers: near pairs at one moment, steps without contact, and both many times along one line.
 * docs/solver/line-search.md has a complete program. */
#ifndef CSCD_SOLVER_API_H
#define CSCD_SOLVER_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the vertices behind a pair ---------------------------------------------------------------------- */

/* The four vertices of a pair of features, with weights: the sum of weights[i] * x[vertices[i]] is the vector
 * to the point on a from the point on b.
 *   VF  the vertex a, then the triangle's three vertices; weights 1, -(1-u-v), -u, -v
 *   EE  the two vertices of a, then those of b; weights 1-u, u, -(1-v), -v
 *   VV  the vertex a, then b three times; weights 1, -1, 0, 0
 *   EV  the two vertices of a, then the vertex b twice; weights 1-u, u, -1, 0
 *   VH  the vertex a, then the half-space's point three times; weights 1, -1, 0, 0. The distance is the part
 *       of the sum along the normal
 * The gradient of the distance is weights[i] times the normal. */
typedef struct cscd_stencil {
    uint32_t vertices[4];
    double weights[4];
} cscd_stencil;

/* Writes the four weights of a pair of this kind. */
static inline void cscd_stencil_weights(cscd_contact_kind kind, double u, double v, double weights[4]) {
    const bool vf = kind == CSCD_CONTACT_VF, vh = kind == CSCD_CONTACT_VH;
    const bool vertex_a = vf || vh || kind == CSCD_CONTACT_VV;
    const bool vertex_b = vh || kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_EV;
    weights[0] = vertex_a ? 1.0 : 1.0 - u;
    weights[1] = vf ? u + v - 1.0 : vertex_a ? -1.0 : u;
    weights[2] = vf ? -u : vertex_a ? 0.0 : vertex_b ? -1.0 : v - 1.0;
    weights[3] = vertex_b ? 0.0 : -v;
}

/* Returns the stencil of a contact or a proximity. Contacts have its vertices already, and proximities its
 * weights, too. An example, in which each contact stops the approach of its points:
 *
 *     for (size_t i = 0; i < contacts.count; i++) {
 *         const cscd_contact *c = &contacts.items[i];
 *         double weights[4], approach = 0.0; // of a to b, along the normal
 *         cscd_stencil_weights(c->kind, c->u, c->v, weights);
 *         for (int k = 0; k < 4; k++) {
 *             for (int axis = 0; axis < 3; axis++)
 *                 approach -= weights[k] * velocities[3 * c->vertices[k] + axis] * c->normal[axis];
 *         }
 *         if (approach > 0.0) impulses[i] = approach;
 *     }
 */
CSCD_API cscd_stencil cscd_mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                                        double u, double v);

/* ---- proximity at one moment -------------------------------------------------------------------------- */

/* Two features without a common vertex that are near each other. In the form UNIQUE: all pairs with their
 * nearest points on the same two vertices, or on the same edge and vertex. */
typedef struct cscd_proximity {
    cscd_contact_kind kind;
    /* VF: vertex, triangle. EE: edges a < b. VV: vertices a < b. EV: edge, vertex. VH: vertex, object. */
    uint32_t a, b;
    uint32_t count;       /* the number of pairs of features */
    uint32_t vf_count;    /* those of a vertex and a face */
    uint32_t ee_count;    /* those of two edges; the others are of points with points or wires, or VH */
    uint32_t vertices[4]; /* and weights: see cscd_stencil. Exactly 0 or 1 on the border of a feature */
    double distance;      /* between the nearest points; VH: the height above the plane, below 0 behind it */
    double weights[4];
    double normal[3];  /* unit vector from b's nearest point to a's; if they touch, across both, or 0 */
    double threshold;  /* EE, after cscd_detector_set_rest: that of the mollifier (cscd_near_form); else 0 */
    double weight;     /* of its energy: `count`, or after cscd_detector_set_rest an area (see there) */
    double separation; /* the distance that the pair has to keep: min_separation, or that of the rules */
} cscd_proximity;

/* Returns u and v of these weights, exactly, in [0,1] as in cscd_contact; EV: u names the point on the edge.
 * It undoes cscd_stencil_weights. */
static inline void cscd_stencil_parameters(cscd_contact_kind kind, const double weights[4], double *u,
                                           double *v) {
    const bool vf = kind == CSCD_CONTACT_VF, ee = kind == CSCD_CONTACT_EE;
    *u = vf ? -weights[2] : ee || kind == CSCD_CONTACT_EV ? weights[1] : 0.0;
    *v = vf || ee ? -weights[3] : 0.0;
}

/* Writes the middle between the nearest points. positions: x, y, z of all vertices, those of the list. */
static inline void cscd_proximity_point(const cscd_proximity *item, const double *positions,
                                        double point[3]) {
    for (size_t axis = 0; axis < 3; axis++) {
        point[axis] = -0.5 * item->distance * item->normal[axis];
        for (size_t i = 0; i < 4; i++) {
            if (item->weights[i] > 0.0)
                point[axis] += item->weights[i] * positions[3 * (size_t)item->vertices[i] + axis];
        }
    }
}

/* The form of a list of proximities, and BEYOND, which may be added to it by `|`.
 *
 * UNIQUE lists pairs with the same nearest points once, as VV or EV: the sum of count * energy(distance) is
 * that over all pairs, up to rounding. After cscd_detector_set_rest, two edges with c = |e_a x e_b|^2 below
 * threshold = 1e-3 |e_a|^2 |e_b|^2 (at rest) stay an item EE. There c / threshold * (2 - c / threshold) is
 * the mollifier of the energy (Li et al. 2020, eq. 24), and for all others 1. docs/solver/line-search.md says
 * why, and has a sum.
 *
 * BEYOND lists the pairs that are at most so much farther apart than they have to keep: the distance that is
 * asked for counts from `separation`, so that an energy of distance - separation has all its pairs, whatever
 * the thickness of their objects (Codimensional IPC, Li et al. 2021). */
typedef enum cscd_near_form {
    CSCD_NEAR_PAIRS,  /* every pair of features, also those of points and half-spaces; counts are 1 */
    CSCD_NEAR_UNIQUE, /* no two items with the same nearest features: VF, EE, VV, EV and VH */
    CSCD_NEAR_BEYOND, /* the distance counts beyond what each pair has to keep */
    CSCD_NEAR_FORM_MAX_ENUM = 0x7fffffff
} cscd_near_form;

/* Proximities, sorted by (kind, a, b). The list belongs to the detector, and lives until the next call of it
 * or of one of its line searches. */
typedef struct cscd_proximities {
    const cscd_proximity *items;
    size_t count;
} cscd_proximities;

/* Finds every pair of features that is at most `distance`, a length above 0, apart at `positions`. Listed
 * pairs are at most (1 + 1e-6) times that apart or, where rounding is coarser, 2^-42 of their extent beyond
 * it. Seams and pairs to leave out count; min_separation does only where `form` has BEYOND. Items beyond
 * `distance` need not count all of their pairs. Timings, counters and guarantees stay those of the last step.
 * CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_detector_find_near(cscd_detector *detector, const cscd_view *positions,
                                             double distance, cscd_near_form form, cscd_proximities *out);

/* Sets the thresholds of pairs of edges (cscd_near_form) and the weights of all pairs from the positions at
 * rest, from the next call on. They hold in lists of the detector and of its line searches. NULL forgets
 * them. INVALID_ARGUMENT also where an edge is longer than 2^250, or shorter than 2^-250 but not 0.
 *
 * The weights are the areas of convergent IPC (Li et al. 2023). A vertex, and an edge, has a third of the
 * areas of its triangles; of a wire an edge has its length, a vertex half of those of its edges; a point has
 * 1. VF weighs a quarter of its vertex, VH all of it, and others a quarter of both features together. Items
 * of UNIQUE have the sum over the pairs that they count, in the order of these. */
CSCD_API cscd_status cscd_detector_set_rest(cscd_detector *detector, const cscd_view *rest);

/* ---- a step that is free of contact ------------------------------------------------------------------ */

/* The way that a motion may go without contact. */
typedef struct cscd_free_step {
    double fraction; /* in (0,1]; with 1 the end is x1, in the scalar of `reached` */
    bool limited;    /* the contact `limit` keeps it below the longest that was asked for */
    bool moved;      /* false: `reached` is x0 in every bit */
    /* A first contact of the whole motion. fraction <= step_factor * limit.toi, unless toi is 0 or so small
     * that rounding decides. */
    cscd_contact limit;
} cscd_free_step;

/* Finds how far the vertices may go from x0 towards x1 without contact, and certifies it. It writes x0 +
 * fraction (x1 - x0), rounded, to `reached`, which may be x1 itself, or NULL; then the scalar is that of x0.
 * Nothing touches on the motion to these very numbers, both ends included. With min_separation no pair sinks
 * below its floor, and one that starts nearer may part. docs/solver/guarantees.md has all promises. A pair
 * that rests exactly on its distance stops every motion that brings it nearer by a rounding error: keep a
 * little more, or move what touches together by one translation.
 *
 * Timings and counters are those of the whole call, guarantees those of the certified motion, in mode
 * EARLIEST. IN_CONTACT: two features touch at x0, or would where x0 is rounded to floats; the sentence and
 * `limit` name them, and nothing else is written. INVALID_ARGUMENT also for the methods PUBLISHED and
 * ICCD_PUBLISHED, and for coordinates that are infinite as floats. CANCELLED: see cscd_progress.
 * docs/solver/first-contact.md shows a call. */
CSCD_API cscd_status cscd_detector_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                            const cscd_mutable_view *reached, cscd_free_step *out);

/* ---- how far vertices may go on any path ---------------------------------------------------------------- */

/* The findings besides the bounds. The list lives as cscd_proximities. */
typedef struct cscd_displacement_bounds {
    /* The pairs that are not apart at x0, sorted by (kind, a, b). Their vertices have a bound of 0, and so
     * have those of a seam with them; no others have. */
    const cscd_proximity *blocked;
    size_t blocked_count;
    size_t near_count; /* the number of pairs that were looked at */
    double least;      /* of all bounds */
    uint32_t vertex;   /* the first that has it */
    uint32_t limited;  /* the number of vertices with less than half of search_radius */
} cscd_displacement_bounds;

/* Finds how far each vertex v may go from x0 on any path: bounds[v] (Offset Geometric Contact, Chen et al.
 * 2025). While all positions, as stored, keep to their bounds, obstacles included, pairs without a common
 * vertex that are apart at x0 stay apart; with min_separation, farther apart than that. Neighbours may still
 * fold onto each other. A bound is at least 0.49 times the distance of the nearest pair less min_separation,
 * or half of search_radius, a length above 0, whichever is less. Vertices of a seam have one bound.
 * docs/theory/displacement-bounds.md has the proof.
 *
 * bounds: vertex_count numbers, floats or doubles as scalar says, in `size` bytes, rounded down. You may
 * compare rounded distances with them. Seams, pairs to leave out, timings, counters, guarantees and CANCELLED
 * are as for cscd_detector_find_near. An example, in which no vertex exceeds its bound:
 *
 *     double *bounds = malloc(n * sizeof *bounds);
 *     cscd_displacement_bounds found;
 *     cscd_status status = cscd_detector_displacement_bounds(
 *         detector, CSCD_DOUBLES(x0, n), 0.5, CSCD_SCALAR_DOUBLE, bounds, n * sizeof *bounds, &found);
 *     for (uint32_t v = 0; status == CSCD_OK && v < n; v++) {
 *         double way[3], length = 0.0, share = 1.0;
 *         for (int c = 0; c < 3; c++) {
 *             way[c] = x1[3 * v + c] - x0[3 * v + c];
 *             length += way[c] * way[c];
 *         }
 *         if (sqrt(length) > bounds[v]) share = (1.0 - 1e-12) * bounds[v] / sqrt(length);
 *         for (int c = 0; c < 3; c++) reached[3 * v + c] = x0[3 * v + c] + share * way[c];
 *     }
 *     free(bounds);
 */
CSCD_API cscd_status cscd_detector_displacement_bounds(cscd_detector *detector, const cscd_view *x0,
                                                       double search_radius, cscd_scalar scalar, void *bounds,
                                                       size_t size, cscd_displacement_bounds *out);

/* The findings of cscd_detector_truncate. The list lives as that of cscd_displacement_bounds. */
typedef struct cscd_truncation {
    double fraction;          /* the least share of its motion that a vertex went; 1 if none wanted to move */
    double obstacle_fraction; /* the same of the vertices of obstacles; 1 without obstacles */
    /* The pairs that touch at x0, or nearly, sorted by (kind, a, b). Their vertices stay. */
    const cscd_proximity *held;
    size_t held_count;
    size_t near_count;  /* the number of pairs that were looked at */
    bool moved;         /* some vertex is not where it was, bit for bit */
    uint32_t shortened; /* the number of vertices that did not reach x1 */
} cscd_truncation;

/* Moves each vertex from x0 towards x1 as far as planes between near pairs allow (Divide and Truncate, Chen
 * et al. 2026). Pairs at most search_radius, a length above 0, farther apart than min_separation have a
 * plane where their motions could bring them together, and their vertices keep to their sides. No vertex goes
 * farther than half of search_radius; twice the longest motion stops none. Obstacles come first. The
 * vertices of a seam go the same share. Motions are shortened, not turned.
 *
 * Pairs without a common vertex that are apart at x0 stay apart: farther than min_separation if they are that
 * at x0, else at 0.985 of their distance or more. This holds for the positions as stored in `reached`, which
 * may be x1 itself, or NULL, and is of floats only where x0 is. A component known to be free of contact at x0
 * is so there. All else is as for cscd_detector_displacement_bounds. An example, rounds until the motion is
 * done or stopped:
 *
 *     cscd_truncation cut;
 *     for (int round = 0; round < 10; round++) {
 *         if (cscd_detector_truncate(detector, CSCD_DOUBLES(reached, n), CSCD_DOUBLES(x1, n), 0.2,
 *                                    CSCD_MUTABLE_DOUBLES(reached, n), &cut) != CSCD_OK)
 *             break;
 *         if (cut.shortened == 0 || !cut.moved) break; // all is done, or nothing has a way on
 *     }
 */
CSCD_API cscd_status cscd_detector_truncate(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                            double search_radius, const cscd_mutable_view *reached,
                                            cscd_truncation *out);

/* ---- a motion made safe ------------------------------------------------------------------------------ */

/* The strongest means that a vertex needed to keep its motion free of contact. */
typedef enum cscd_response {
    CSCD_RESPONSE_FREE,      /* none: it went where it wanted */
    CSCD_RESPONSE_STOPPED,   /* contacts took away what approaches, and friction some of what slides */
    CSCD_RESPONSE_TRUNCATED, /* planes shortened its motion, or all wanted half of it */
    CSCD_RESPONSE_HELD,      /* it stayed, because it touches something at x0 */
    CSCD_RESPONSE_COUNT,
    CSCD_RESPONSE_MAX_ENUM = 0x7fffffff
} cscd_response;

/* Options of cscd_detector_make_safe. The arrays are read during the call. */
typedef struct cscd_response_options {
    uint32_t struct_size; /* set by cscd_response_defaults */
    uint32_t reserved;    /* 0 */
    /* vertex_count finite numbers, 0 or more, in any unit; 0, or less than 2^-100 of the largest one: no impulse
     * moves the vertex. NULL, the default: 1 each. Obstacles, half-spaces and vertices that are not active
     * count as 0 anyway. */
    const double *inverse_masses;
    /* Coulomb's coefficient for each object, 0 or more; two objects have the geometric mean. NULL, the
     * default: no friction. */
    const double *friction;
} cscd_response_options;

/* Returns the default options. */
CSCD_API void cscd_response_defaults_sized(cscd_response_options *out, size_t size);
static inline cscd_response_options cscd_response_defaults(void) {
    cscd_response_options options;
    cscd_response_defaults_sized(&options, sizeof options);
    return options;
}

/* The findings of cscd_detector_make_safe. The lists live as cscd_proximities. */
typedef struct cscd_safe_motion {
    const uint8_t *responses;                      /* one cscd_response per vertex */
    uint32_t response_counts[CSCD_RESPONSE_COUNT]; /* the numbers of vertices */
    uint32_t rounds;                               /* of the search for contacts */
    uint32_t truncations;                          /* rounds after which planes shortened motions */
    size_t pushed;                                 /* pairs of points on which an impulse acts */
    /* The share of its motion that a vertex made, along it, from 0 to 1: the mean, and the least. Those of
     * obstacles, and those that did not want to move, do not count. */
    double mean_share, least_share;
    double obstacle_share; /* the least by which an obstacle, or all, went as a whole; mostly 1 */
    /* The pairs that touch at x0, sorted by (kind, a, b), with toi 0. Their vertices stay. */
    const cscd_contact *held;
    size_t held_count;
    bool moved; /* some vertex is not where it was, bit for bit */
    uint8_t reserved[7];
} cscd_safe_motion;

/* Finds a motion near the one from x0 to x1 that is certified free of contact and goes on moving, and writes
 * its end to `reached`, which may be x1 or x0 itself, or NULL. A contact stops the approach of its points by
 * impulses, which keep momentum, and Coulomb friction slows what slides. The features of pairs that then come
 * into contact elsewhere stop before a plane between them. What this leaves after some rounds is shortened to
 * such planes, as in cscd_detector_truncate; where that comes to no end, all wants half of its motion, and so
 * on. Obstacles go where they want unless something is caught between them, and then stop as a whole. The
 * vertices of a seam are shifted by the same. Pairs that are nearer than min_separation at x0 part by a share of
 * what is missing.
 *
 * The certificate is for the positions as stored: nothing touches on the motion but what is `held`. As in
 * cscd_detector_max_step no pair sinks below its floor (docs/solver/guarantees.md). A velocity follows from
 * reached - x0. The result is the same for any number of threads. Timings and counters are those of the
 * whole call. options: NULL for the defaults. INVALID_ARGUMENT also for the methods PUBLISHED and
 * ICCD_PUBLISHED, where no vertex can move, and for doubles in x0 with floats in `reached`. CANCELLED: see
 * cscd_progress. docs/solver/first-contact.md shows a call. */
CSCD_API cscd_status cscd_detector_make_safe(cscd_detector *detector, const cscd_view *x0,
                                             const cscd_view *x1, const cscd_response_options *options,
                                             const cscd_mutable_view *reached, cscd_safe_motion *out);

/* ---- a line search ----------------------------------------------------------------------------------- */

/* One motion about which a solver asks many times (Li et al. 2020). All answers come from the candidates, the
 * pairs that can come near each other on it, which are collected once. Nothing is culled: for a single step
 * cscd_detector_max_step is faster. A line search uses the trees and options of its detector, so never call
 * the two at the same time. */
typedef struct cscd_line_search cscd_line_search;

/* Creates a line search, which keeps its detector. The page docs/solver/line-search.md shows its use. */
CSCD_API cscd_status cscd_line_search_create(cscd_detector *detector, cscd_line_search **out);

/* Frees the line search. */
CSCD_API void cscd_line_search_destroy(cscd_line_search *search);

/* Collects the candidates of the motion from x0 to x1 in place of those before. Both positions are copied.
 * reach: the largest distance for cscd_line_search_find_near, with BEYOND or without, or 0. CANCELLED: see
 * cscd_progress. */
CSCD_API cscd_status cscd_line_search_begin(cscd_line_search *search, const cscd_view *x0,
                                            const cscd_view *x1, double reach);

/* Returns the number of candidates. Half-spaces have none: every vertex is tested with them. */
CSCD_API size_t cscd_line_search_candidate_count(const cscd_line_search *search);

/* Two features that may come near each other on the way. */
typedef struct cscd_candidate {
    cscd_contact_kind kind; /* VF, EE, VV or EV */
    uint32_t a, b;          /* as in cscd_contact */
} cscd_candidate;

/* Candidates, sorted by (kind, a, b). The list lives as cscd_proximities. */
typedef struct cscd_candidates {
    const cscd_candidate *items;
    size_t count;
} cscd_candidates;

/* Lists the candidates, for solvers that have energies or tests of their own. Every pair of features that
 * comes within reach, or min_separation, between x0 and x1 is in the list, except pairs with a vertex in
 * common and those that are left out (ignored, seams); so it may be shorter than the count. INVALID_ARGUMENT:
 * the line has no motion, or the rules have changed since. */
CSCD_API cscd_status cscd_line_search_candidates(cscd_line_search *search, cscd_candidates *out);

/* Writes the positions x0 + fraction (x1 - x0), rounded, for a fraction in [0,1]. At 0 and 1 they are x0 and
 * x1 themselves. */
CSCD_API cscd_status cscd_line_search_positions(cscd_line_search *search, double fraction,
                                                const cscd_mutable_view *positions);

/* Does what cscd_detector_max_step does, for the motion of the line and no farther than `longest` in (0,1].
 * Here, too, reached may be NULL. */
CSCD_API cscd_status cscd_line_search_max_step(cscd_line_search *search, double longest,
                                               const cscd_mutable_view *reached, cscd_free_step *out);

/* Does what cscd_detector_find_near does, at the positions of cscd_line_search_positions. The distance is
 * above 0, and at most the reach of the line. */
CSCD_API cscd_status cscd_line_search_find_near(cscd_line_search *search, double fraction, double distance,
                                                cscd_near_form form, cscd_proximities *out);

/* ==== Single pairs ========================================================================================== */

/* The tests of single pairs, four points each, for hosts that find their pairs in another way. The threads of
 * the context share a batch. Results are those of cscd_detector_step and cscd_detector_find_near on a mesh
 * with just these features, bit for bit. */

/* Pairs of features of one kind. Features with a common point touch there all the time, so they do not belong
 * here. Of the four points of a pair,
 *   VF  the first is the vertex a, the others are those of the triangle b;
 *   EE  the first two are the ends of the edge a, the others those of b. */
typedef struct cscd_pairs {
    cscd_contact_kind kind; /* VF or EE */
    uint32_t point_count;   /* of the positions, 1 or more */
    size_t pair_count;      /* 0 is allowed */
    const uint32_t *points; /* pair_count * 4 numbers below point_count; NULL: pair i has 4 i to 4 i + 3 */
} cscd_pairs;

/* The contact of a pair; the members are those of cscd_contact. */
typedef struct cscd_pair_contact {
    double toi; /* INFINITY: no contact, and all other members are 0 */
    bool contact, bounded;
    double u, v;
    double point[3], normal[3];
} cscd_pair_contact;

/* Tests each pair for contact while its points move in straight lines from x0 to x1. Where x1 is NULL, they
 * rest. It writes pair_count results. Each view holds all points; object_count is 0. min_separation and
 * tolerance are those of cscd_detector_options. An example, a vertex that falls through a triangle, which
 * prints "at 0.500":
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

/* The nearest points of a pair; distance and normal are those of cscd_proximity, u and v as in cscd_contact. */
typedef struct cscd_pair_distance {
    double distance; /* INFINITY: farther apart than `distance`, and all other members are 0 */
    double u, v;
    double point[3]; /* the middle between the nearest points */
    double normal[3];
} cscd_pair_distance;

/* Measures each pair at rest, and writes pair_count results. Pairs count up to `distance`, a length above 0
 * or INFINITY, with the rounding of cscd_detector_find_near. An example, two pairs of edges of six points,
 * which prints "1.0 1.5":
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
