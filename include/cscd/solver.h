/* For solvers: what is near, how far a step may go, and both again along a line search. Part of cscd/cscd.h,
 * which says what holds for every function. */
#ifndef CSCD_SOLVER_API_H
#define CSCD_SOLVER_API_H

#include <cscd/detector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the vertices behind a pair ---------------------------------------------------------------------- */

/* The point that u and v name on a, minus the one on b, is the sum of weights[i] * x[vertices[i]].
 *   VF  a; the triangle's three vertices       1, -(1-u-v), -u, -v
 *   EE  a's two vertices, b's two vertices     1-u, u, -(1-v), -v */
typedef struct cscd_stencil {
    uint32_t vertices[4];
    double weights[4];
} cscd_stencil;

/* Of a contact's or proximity's kind, a, b, u, v. */
CSCD_API cscd_stencil cscd_mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                                        double u, double v);

/* ---- proximity at one moment -------------------------------------------------------------------------- */

/* Two features without a common vertex, and their nearest points, named by u and v as in cscd_contact. */
typedef struct cscd_proximity {
    cscd_contact_kind kind;
    uint32_t a, b;
    double distance;
    double u, v;
    double point[3];  /* midpoint of the nearest points */
    double normal[3]; /* unit, from b's nearest point to a's; where they touch, across both, or 0 */
} cscd_proximity;

/* Sorted by (kind, a, b). Owned by the detector, also if a line asked: valid until the next call of the
 * detector or of one of its lines. */
typedef struct cscd_proximities {
    const cscd_proximity *items;
    size_t count;
} cscd_proximities;

/* Every pair of features whose distance is at most `distance`, a length above 0; none whose distance is more
 * than (1 + 1e-6) times that (or, by rounding, 2^-42 of the pair's extent above it). What the options say of
 * pairs to leave out holds; min_separation takes no part. Where the nearest point lies on the boundary of a
 * feature, the features that share it are near, too, and in the list: u and v tell. Timings, counters and
 * guarantees of the last step stay as they are. */
CSCD_API cscd_status cscd_detector_near(cscd_detector *detector, const double *positions, double distance,
                                        cscd_proximities *out);

/* ---- a step that is free of contact ------------------------------------------------------------------ */

typedef struct cscd_free_step {
    double length;      /* in (0,1]; 1: the end is x1, bit for bit */
    bool limited;       /* below the longest asked for, because of: */
    cscd_contact limit; /* a first contact of the whole motion; length <= step_factor * limit.toi, but where
                         * that is 0, or so near it that rounding decides */
} cscd_free_step;

/* How far the vertices may go from x0 towards x1 without any contact (with min_separation: without coming
 * within it): a step in (0,1], certified. The positions reached, x0 + length (x1 - x0) rounded, are written
 * to `end`, vertex_count * 3 doubles (x1 itself will do; NULL: nowhere), and are what was verified: vertices
 * that move from x0 to these, each in a straight line, meet nothing on the way, at both ends included. So a
 * closed body that is free of self-contact at x0 is so at `end`, and the detector knows: the next step from
 * there needs no check of its start. IN_CONTACT: x0 touches itself already, or with min_separation is not
 * farther apart than that and its tolerance; the sentence names a pair, and nothing is written. Culls, as
 * _step does in mode EARLIEST; methods PUBLISHED and ICCD_PUBLISHED certify nothing and are refused. Timings
 * and counters are of the whole call, guarantees of the motion tried last, which is the one returned. */
CSCD_API cscd_status cscd_detector_max_step(cscd_detector *detector, const double *x0, const double *x1,
                                            double *end, cscd_free_step *out);

/* ---- a line search ----------------------------------------------------------------------------------- */

/* One motion, looked at more than once: the pairs that can come near each other anywhere on it, the
 * candidates, are collected once and serve every shorter step and every moment on the line. Nothing is
 * culled, so for a single step cscd_detector_max_step is the faster. It uses the detector's trees and
 * options: neither is called while the other runs, and the detector is destroyed after its lines. */
typedef struct cscd_line cscd_line;

CSCD_API cscd_status cscd_line_create(cscd_detector *detector, cscd_line **out);
CSCD_API void cscd_line_destroy(cscd_line *line);

/* Collects the candidates from x0 to x1, which are copied, and forgets those before. reach: 0, or the largest
 * distance that cscd_line_near will be asked for. */
CSCD_API cscd_status cscd_line_begin(cscd_line *line, const double *x0, const double *x1, double reach);

/* VF and EE pairs collected: those whose volumes come near each other. */
CSCD_API size_t cscd_line_candidate_count(const cscd_line *line);

/* Where the vertices are at `length` in [0,1]: x0 + length (x1 - x0), rounded; at 0 and 1 exactly. */
CSCD_API cscd_status cscd_line_positions(const cscd_line *line, double length, double *positions);

/* As cscd_detector_max_step, but no farther than `longest` in (0,1]. */
CSCD_API cscd_status cscd_line_max_step(cscd_line *line, double longest, double *end, cscd_free_step *out);

/* As cscd_detector_near, at cscd_line_positions of `length`; distance at most the line's reach. */
CSCD_API cscd_status cscd_line_near(cscd_line *line, double length, double distance, cscd_proximities *out);

#ifdef __cplusplus
}
#endif

#endif
