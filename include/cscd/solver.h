/* What solvers ask beside contacts: which features are close at one moment, how far a step may go without
 * contact, and both again many times along one line. docs/solver/line-search.md has a complete program. */
#ifndef CSCD_SOLVER_API_H
#define CSCD_SOLVER_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the vertices behind a pair ---------------------------------------------------------------------- */

/* The four vertices of a pair of features, with weights: the sum of weights[i] * x[vertices[i]] is the
 * vector to the point that u and v name on a from the one on b.
 *   VF  the vertex a, then the triangle's three vertices; weights 1, -(1-u-v), -u, -v
 *   EE  the two vertices of a, then those of b; weights 1-u, u, -(1-v), -v
 *   VV  the vertex a, then b three times; weights 1, -1, 0, 0
 *   EV  the two vertices of a, then the vertex b twice; weights 1-u, u, -1, 0
 *   VH  the vertex a, then the half-space's point three times; weights 1, -1, 0, 0. The sum is the vector from
 *       this point; its part along the normal is the distance, so the gradient is that of the others: weights
 *       times normal */
typedef struct cscd_stencil {
    uint32_t vertices[4];
    double weights[4];
} cscd_stencil;

/* Writes the four weights of a pair with this kind, u and v. */
static inline void cscd_stencil_weights(cscd_contact_kind kind, double u, double v, double weights[4]) {
    const bool vf = kind == CSCD_CONTACT_VF, vh = kind == CSCD_CONTACT_VH;
    const bool vertex_a = vf || vh || kind == CSCD_CONTACT_VV;
    const bool vertex_b = vh || kind == CSCD_CONTACT_VV || kind == CSCD_CONTACT_EV;
    weights[0] = vertex_a ? 1.0 : 1.0 - u;
    weights[1] = vf ? u + v - 1.0 : vertex_a ? -1.0 : u;
    weights[2] = vf ? -u : vertex_a ? 0.0 : vertex_b ? -1.0 : v - 1.0;
    weights[3] = vertex_b ? 0.0 : -v;
}

/* The stencil of a contact or a proximity with this kind, a, b, u and v. Contacts have its vertices already, and
 * proximities its vertices and weights. An example, in which each contact stops the approach of its points:
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

/* Two features without a common vertex that are close at one moment, or, in the form UNIQUE, all pairs of
 * features whose nearest points lie on the same two vertices, or on the same edge and vertex; and the nearest
 * points. */
typedef struct cscd_proximity {
    cscd_contact_kind kind;
    uint32_t a, b;        /* VF: vertex and triangle. EE: edges a < b. VV: vertices a < b. EV: edge, vertex.
                           * VH: vertex, object */
    uint32_t count;       /* how many pairs of features it stands for: */
    uint32_t vf_count;    /* so many of a vertex and a face */
    uint32_t ee_count;    /* and so many of two edges; the others are of points with points or wires, or VH */
    uint32_t vertices[4]; /* and weights: see cscd_stencil */
    double distance;      /* between the nearest points; VH: the height above the plane, below 0 behind it */
    double u, v;          /* in [0,1], as in cscd_contact; EV: u names the point on the edge. Exactly 0 or 1
                           * where a nearest point lies on the border of a feature */
    double weights[4];
    double point[3];  /* the middle between the nearest points */
    double normal[3]; /* unit vector from b's nearest point to a's; if they touch, across both features, or
                       * 0 */
    double threshold; /* EE, after cscd_detector_set_rest: where the squared length of the cross product of
                       * the two edges is below this, a barrier's energy fades. Else 0 */
} cscd_proximity;

/* The form of a list of proximities. Later versions may add values.
 *
 * Many pairs of features have the same nearest points: a vertex over an inner edge of a mesh is as far from
 * both triangles at the edge. A sum of energies that depend on the distance needs all of them, or else it
 * jumps where a nearest point passes from a face to its edge. UNIQUE lists them once, as VV or EV, with their
 * number. So the sum of count * energy(distance) over the list is the sum over all pairs, up to rounding.
 *
 * The energy of two edges may have a mollifier besides, which fades it where they are nearly parallel and
 * their nearest points jump (Li et al. 2020, eq. 24): with c = |e_a x e_b|^2, it is c / threshold *
 * (2 - c / threshold) below the threshold, and 1 above, where threshold = 1e-3 |e_a|^2 |e_b|^2 at rest. It
 * depends on both edges, so edges below their threshold stay an item EE of their own, also where their
 * nearest points are ends; edges above it, whose factor is 1, may be part of a VV or an EV. Where a pair
 * passes from one to the other, its factor is 1 on both sides, so the sum goes on without a jump. Without
 * cscd_detector_set_rest every threshold is 0, and no pair has a mollifier. An example, for either form:
 *
 *     double energy = 0.0;
 *     for (size_t i = 0; i < proximities.count; i++) {
 *         const cscd_proximity *p = &proximities.items[i];
 *         energy += p->count * mollifier(p->vertices, p->threshold) * barrier(p->distance);
 *     } // its gradient has count * mollifier * barrier'(distance) * weights[k] * normal at vertices[k]
 */
typedef enum cscd_near_form {
    CSCD_NEAR_PAIRS,  /* every pair of features, also those of points and half-spaces; counts are 1 */
    CSCD_NEAR_UNIQUE, /* no two items with the same nearest features: VF, EE, VV, EV and VH */
    CSCD_NEAR_FORM_MAX_ENUM = 0x7fffffff
} cscd_near_form;

/* Proximities, sorted by (kind, a, b). The list belongs to the detector, also when one of its line
 * searches was asked, and lives until the next call of the detector or of one of its line searches. */
typedef struct cscd_proximities {
    const cscd_proximity *items;
    size_t count;
    size_t waiting; /* so many pairs of features wait, and are left out: see cscd_detector_set_seams */
} cscd_proximities;

/* Finds every pair of features whose distance at `positions` is at most `distance`, a length above 0, and
 * lists them in this form. No listed pair is farther apart than (1 + 1e-6) times that or, where rounding is
 * coarser, than 2^-42 of the pair's extent beyond it. Seams and pairs to leave out count as in the options;
 * min_separation has no part in it. Items beyond `distance` need not count all of their pairs. CANCELLED: see
 * cscd_progress. Timings, counters and guarantees stay those of the last step. */
CSCD_API cscd_status cscd_detector_find_near(cscd_detector *detector, const cscd_view *positions,
                                             double distance, cscd_near_form form, cscd_proximities *out);

/* Takes from `rest`, positions of the mesh at rest, the lengths by which proximities of two edges get their
 * threshold, in lists of the detector and of its line searches from the next call on. NULL forgets them.
 * INVALID_ARGUMENT also where an edge is shorter than 2^-250, but not 0, or longer than 2^250, because of
 * the fourth power. */
CSCD_API cscd_status cscd_detector_set_rest(cscd_detector *detector, const cscd_view *rest);

/* ---- a step that is free of contact ------------------------------------------------------------------ */

/* How far a motion may go without contact. */
typedef struct cscd_free_step {
    double fraction; /* in (0,1]; with 1 the end is x1, in the scalar of `reached` */
    bool limited; /* the fraction is below the longest that was asked for, because of the contact `limit` */
    bool moved;   /* false: no coordinate is another than in x0, and `reached` is x0 in every bit */
    cscd_contact limit; /* a first contact of the whole motion; fraction <= step_factor * limit.toi, unless
                         * toi is 0 or so small that rounding decides */
    size_t waiting;     /* so many pairs of features wait, and limit nothing: see cscd_detector_set_seams */
} cscd_free_step;

/* Finds how far the vertices may go from x0 towards x1 without any contact, and certifies it. The positions
 * x0 + fraction (x1 - x0), rounded to the scalar of `reached`, are written to it; it may be x1 itself, or NULL
 * if they are not wanted, and then the scalar is that of x0. It is the motion to these very numbers that was
 * searched: nothing touches on the way, both ends included. A component that is embedded at x0 is therefore
 * embedded at `reached`, and the next step from there need not prove its start.
 * With min_separation d every pair keeps a floor: the greatest of d, s d, s^2 d, ... (s: floor_ratio) that its
 * distance at x0 surely exceeds, or touching, where that is below 2^-40 of its extent. So a pair above d stays
 * above d over any number of steps, and one below it may part, and sinks no farther than its floor.
 * A solver that presses into contact leaves no room: what rests on its distance lets no motion pass that would come
 * nearer by a rounding error. Keep a little distance, or move what touches together by one translation.
 * IN_CONTACT: two features touch at x0, or would where x0 in doubles is rounded to floats; the sentence names them, *out has them as its limit, and nothing else
 * is written. INVALID_ARGUMENT also for the methods PUBLISHED and ICCD_PUBLISHED, which certify nothing, and
 * for coordinates that are infinite as floats. CANCELLED: see cscd_progress.
 * Culls as cscd_detector_step does in mode EARLIEST. Timings and counters are those of the whole call,
 * guarantees those of the motion that was certified. An example, a motion in floats that ends before two sheets
 * meet half way, which prints "0.4 of the way":
 *
 *     cscd_free_step step;
 *     cscd_status status = cscd_detector_max_step(detector, CSCD_FLOATS(now, n), CSCD_FLOATS(wanted, n),
 *                                                 CSCD_MUTABLE_FLOATS(wanted, n), &step);
 *     if (status == CSCD_IN_CONTACT) // nothing was written; the caller moves this pair apart first
 *         printf("features %u and %u touch at the start\n", step.limit.a, step.limit.b);
 *     if (status == CSCD_OK && step.limited) // wanted is now what was reached, in every bit
 *         printf("%.1f of the way\n", step.fraction);
 *     if (status == CSCD_OK && !step.moved) // the caller takes the approach of step.limit out of the motion
 *         printf("no way\n");
 */
CSCD_API cscd_status cscd_detector_max_step(cscd_detector *detector, const cscd_view *x0, const cscd_view *x1,
                                            const cscd_mutable_view *reached, cscd_free_step *out);

/* ---- how far vertices may go on any path ---------------------------------------------------------------- */

/* What cscd_detector_displacement_bounds found beside the bounds. The list belongs to the detector and
 * lives until the next call of the detector or of one of its line searches. */
typedef struct cscd_displacement_bounds {
    const cscd_proximity
        *blocked; /* the pairs that are not apart at x0: each of their vertices has a bound of
                                    * 0, and so have no others; sorted by (kind, a, b) */
    size_t blocked_count;
    size_t near_count; /* the number of pairs that were looked at */
    double least;      /* of all bounds */
    uint32_t vertex;   /* the first that has it */
    uint32_t limited;  /* the number of vertices that have less than half the search radius */
    size_t waiting;    /* so many pairs of features wait, and bound nothing: see cscd_detector_set_seams */
} cscd_displacement_bounds;

/* Finds how far each vertex may go from x0, as Offset Geometric Contact (Chen et al. 2025) uses it. Every
 * motion, straight or not, all of whose positions, as stored, stay within bounds[v] of x0 for each vertex
 * v, keeps all pairs of features without a common vertex apart that are apart at x0; with min_separation,
 * farther apart than that. Seams, pairs to leave out and obstacles count as in cscd_detector_find_near, and
 * vertices of a seam have one bound in common. Obstacles have bounds, too: a motion of theirs that exceeds
 * these is not covered. A bound is at least 0.49 times the distance of the vertex's nearest pair less
 * min_separation, or half of search_radius, a length above 0, whichever is less. Neighbours may still fold
 * onto each other at their common vertices.
 *
 * bounds: vertex_count numbers, floats or doubles as scalar says, in `size` bytes; they are rounded down.
 * Comparing rounded distances with them is safe: a share of 2^-20 of each is left for that. What counts is
 * where a vertex is after its position was rounded. CANCELLED: see cscd_progress. Timings, counters and
 * guarantees stay those of the last step. docs/theory/displacement-bounds.md has the proof. An example, in
 * which each vertex goes no farther than its bound, on whatever path:
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
 *         if (sqrt(length) > bounds[v]) share = (1.0 - 1e-12) * bounds[v] / sqrt(length); // and never beyond it
 *         for (int c = 0; c < 3; c++) reached[3 * v + c] = x0[3 * v + c] + share * way[c];
 *     }
 *     free(bounds);
 */
CSCD_API cscd_status cscd_detector_displacement_bounds(cscd_detector *detector, const cscd_view *x0,
                                                       double search_radius, cscd_scalar scalar, void *bounds,
                                                       size_t size, cscd_displacement_bounds *out);

/* What cscd_detector_truncate did. The list lives as that of cscd_displacement_bounds. */
typedef struct cscd_truncation {
    double fraction; /* the least share of its motion that a vertex went; 1 if it did not want to move */
    double obstacle_fraction; /* the same of the vertices of obstacles; 1 without obstacles */
    const cscd_proximity
        *held; /* pairs that touch at x0, or nearly: their vertices stay; sorted by (kind, a, b) */
    size_t held_count;
    size_t near_count;  /* the number of pairs that were looked at */
    bool moved;         /* some vertex is not where it was, bit for bit */
    uint32_t shortened; /* the number of vertices that did not reach x1 */
    size_t waiting;     /* so many pairs of features wait, and hold nothing: see cscd_detector_set_seams */
} cscd_truncation;

/* Lets every vertex go from x0 towards x1 on its own straight line as far as planes between near pairs
 * allow, as Divide and Truncate (Chen et al. 2026) does. Each pair of features whose distance at x0 is at
 * most search_radius, or that beyond min_separation, has a plane across its nearest points, and its
 * vertices keep to their sides of it; what lies between them is shared by what both want, and obstacles
 * come first. No vertex goes farther than half of search_radius. So pairs without a common vertex stay
 * apart that are apart at x0: farther than min_separation, if they are that at x0, and otherwise they keep
 * all of their distance but what planes cannot prove, 0.985 of it at least. All of this holds for the positions as they are stored: `reached`, which may be x1 itself, or
 * NULL, is rounded before it is compared with the planes. It is of floats only where x0 is. The vertices of
 * a seam go the same share.
 *
 * A component that is known to be free of contact at x0 is so at `reached`, and the next step from there
 * need not prove its start. Neighbours may still fold onto each other at their common vertices. Motions are
 * shortened, not turned: a motion that goes on along a plane must not go towards it. search_radius is a
 * length above 0; twice the longest motion stops none. Otherwise as cscd_detector_displacement_bounds. An
 * example, rounds that each go a part of a motion, until it is done or stopped:
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

/* ---- a line search ----------------------------------------------------------------------------------- */

/* One motion that is asked about many times, as in the line search of an implicit solver (Li et al. 2020).
 * The feature pairs that can come near each other anywhere on it, the candidates, are collected once;
 * every shorter step and every moment on the line is then answered from them. Nothing is culled, so for a
 * single step cscd_detector_max_step is faster. A line search uses the trees and options of its detector, so the
 * two are never called at the same time. */
typedef struct cscd_line_search cscd_line_search;

/* Creates a line search, which keeps its detector. An example, one search of an implicit solver, along the line to
 * x1, whose energy has a barrier for each pair nearer than 0.3:
 *
 *     cscd_line_search *search = NULL;
 *     cscd_free_step step = {0};
 *     cscd_status status = cscd_line_search_create(detector, &search);
 *     if (status == CSCD_OK)
 *         status = cscd_line_search_begin(search, CSCD_DOUBLES(x0, n), CSCD_DOUBLES(x1, n), 0.3);
 *     for (double f = 1.0; status == CSCD_OK && f > 1e-6; f = 0.5 * step.fraction) {
 *         status = cscd_line_search_max_step(search, f, CSCD_MUTABLE_DOUBLES(reached, n), &step);
 *         if (status == CSCD_OK) // `reached` is certified as it is stored: rounding may take a shorter step elsewhere
 *             status = cscd_line_search_find_near(search, step.fraction, 0.3, CSCD_NEAR_UNIQUE, &proximities);
 *         if (status == CSCD_OK && energy_at(reached, &proximities) < energy_before) break;
 *     }
 *     cscd_line_search_destroy(search);
 */
CSCD_API cscd_status cscd_line_search_create(cscd_detector *detector, cscd_line_search **out);

/* Frees the line search. */
CSCD_API void cscd_line_search_destroy(cscd_line_search *search);

/* Collects the candidates of the motion from x0 to x1, which are copied, in place of those before. reach:
 * the largest distance that cscd_line_search_find_near will be asked for, or 0. CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_line_search_begin(cscd_line_search *search, const cscd_view *x0,
                                            const cscd_view *x1, double reach);

/* The number of candidates: pairs of features whose volumes come near each other. Half-spaces have none: every
 * vertex is tested with them each time. */
CSCD_API size_t cscd_line_search_candidate_count(const cscd_line_search *search);

/* Writes the positions at `fraction` in [0,1]: x0 + fraction (x1 - x0), rounded; x0 and x1 themselves at 0
 * and 1. */
CSCD_API cscd_status cscd_line_search_positions(cscd_line_search *search, double fraction,
                                                const cscd_mutable_view *positions);

/* Does what cscd_detector_max_step does, for the motion of the line and no farther than `longest` in
 * (0,1]. reached may be NULL. */
CSCD_API cscd_status cscd_line_search_max_step(cscd_line_search *search, double longest,
                                               const cscd_mutable_view *reached, cscd_free_step *out);

/* Does what cscd_detector_find_near does, at the positions that cscd_line_search_positions gives for `fraction`.
 * distance: above 0, and at most the reach of the line. */
CSCD_API cscd_status cscd_line_search_find_near(cscd_line_search *search, double fraction, double distance,
                                                cscd_near_form form, cscd_proximities *out);

/* ==== Single pairs ========================================================================================== */

/* Single pairs: the elementary tests of a step by themselves, on four points each, for hosts that find their
 * pairs in another way. A batch of pairs goes through the kernels of a step, eight at a time, and is shared
 * by the threads of the context. Every result is that of cscd_detector_step, or of cscd_detector_find_near,
 * on a mesh with just these features, bit for bit. Its structs never grow. */

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
