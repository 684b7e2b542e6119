/* What solvers ask beside contacts: which features are close at one moment, how far a step may go without
 * contact, and both again many times along one line. Part of cscd/cscd.h, which says what holds for every
 * function. docs/tutorials/line-search.md has a complete program. */
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
 *   EE  the two vertices of a, then those of b; weights 1-u, u, -(1-v), -v */
typedef struct cscd_stencil {
    uint32_t vertices[4];
    double weights[4];
} cscd_stencil;

/* The stencil of a contact or a proximity with this kind, a, b, u and v. */
CSCD_API cscd_stencil cscd_mesh_stencil(const cscd_mesh *mesh, cscd_contact_kind kind, uint32_t a, uint32_t b,
                                        double u, double v);

/* ---- proximity at one moment -------------------------------------------------------------------------- */

/* Two features without a common vertex that are close at one moment, and their nearest points, which u and
 * v name as in cscd_contact. */
typedef struct cscd_proximity {
    cscd_contact_kind kind;
    uint32_t a, b;    /* vertex and triangle, or two edges a < b */
    double distance;  /* between the nearest points */
    double u, v;      /* in [0,1]; exactly 0 or 1 where a nearest point lies on the border of a feature */
    double point[3];  /* the middle between the nearest points */
    double normal[3]; /* unit vector from b's nearest point to a's; if they touch, across both features, or
                       * 0 */
} cscd_proximity;

/* Proximities, sorted by (kind, a, b). The list belongs to the detector, also when one of its lines was
 * asked, and lives until the next call of the detector or of one of its lines. */
typedef struct cscd_proximities {
    const cscd_proximity *items;
    size_t count;
} cscd_proximities;

/* Finds every pair of features whose distance at `positions` is at most `distance`, a length above 0. No
 * listed pair is farther apart than (1 + 1e-6) times that or, where rounding is coarser, than 2^-42 of the
 * pair's extent beyond it. Seams and pairs to leave out count as in the options; min_separation has no
 * part in it. Where a nearest point lies on the border of a feature, the features that share this border
 * are listed, too; u and v show it. CANCELLED: see cscd_progress. Timings, counters and guarantees stay
 * those of the last step. */
CSCD_API cscd_status cscd_detector_near(cscd_detector *detector, const double *positions, double distance,
                                        cscd_proximities *out);

/* ---- a step that is free of contact ------------------------------------------------------------------ */

/* How far a motion may go without contact. */
typedef struct cscd_free_step {
    double length;      /* in (0,1]; with 1 the end is x1, bit for bit */
    bool limited;       /* the length is below the longest that was asked for, because of this contact: */
    cscd_contact limit; /* a first contact of the whole motion; length <= step_factor * limit.toi, unless
                         * toi is 0 or so small that rounding decides */
} cscd_free_step;

/* Finds how far the vertices may go from x0 towards x1 without any contact (with min_separation: without
 * coming within it), and certifies it. The positions reached, x0 + length (x1 - x0), rounded, are written
 * to `end`: vertex_count * 3 doubles, which may be x1 itself, or NULL if they are not wanted. It is the
 * motion to these very doubles that was searched: there is no contact on the way, both ends included. A
 * component that is embedded at x0 is therefore embedded at `end`, and the next step from there need not
 * prove its start. IN_CONTACT: the features of a pair, which the sentence names, touch at x0 or, with
 * min_separation, are not farther apart than that and its tolerance; nothing is written. INVALID_ARGUMENT
 * also for the methods PUBLISHED and ICCD_PUBLISHED, which certify nothing. CANCELLED: see cscd_progress.
 * Culls as cscd_detector_step does in mode EARLIEST. Timings and counters are those of the whole call,
 * guarantees those of the motion that was certified. */
CSCD_API cscd_status cscd_detector_max_step(cscd_detector *detector, const double *x0, const double *x1,
                                            double *end, cscd_free_step *out);

/* ---- a line search ----------------------------------------------------------------------------------- */

/* One motion that is asked about many times, as in the line search of an implicit solver (Li et al. 2020).
 * The feature pairs that can come near each other anywhere on it, the candidates, are collected once;
 * every shorter step and every moment on the line is then answered from them. Nothing is culled, so for a
 * single step cscd_detector_max_step is faster. A line uses the trees and options of its detector, so the
 * two are never called at the same time. */
typedef struct cscd_line cscd_line;

/* Creates a line. The detector must live as long. */
CSCD_API cscd_status cscd_line_create(cscd_detector *detector, cscd_line **out);

/* Frees the line. */
CSCD_API void cscd_line_destroy(cscd_line *line);

/* Collects the candidates of the motion from x0 to x1, which are copied, in place of those before. reach:
 * the largest distance that cscd_line_near will be asked for, or 0. CANCELLED: see cscd_progress. */
CSCD_API cscd_status cscd_line_begin(cscd_line *line, const double *x0, const double *x1, double reach);

/* The number of candidates: VF and EE pairs whose volumes come near each other. */
CSCD_API size_t cscd_line_candidate_count(const cscd_line *line);

/* Writes the positions at `length` in [0,1], vertex_count * 3 doubles: x0 + length (x1 - x0), rounded; x0
 * and x1 themselves at 0 and 1. */
CSCD_API cscd_status cscd_line_positions(const cscd_line *line, double length, double *positions);

/* Does what cscd_detector_max_step does, for the motion of the line and no farther than `longest` in
 * (0,1]. end may be NULL. */
CSCD_API cscd_status cscd_line_max_step(cscd_line *line, double longest, double *end, cscd_free_step *out);

/* Does what cscd_detector_near does, at the positions that cscd_line_positions gives for `length`.
 * distance: above 0, and at most the reach of the line. */
CSCD_API cscd_status cscd_line_near(cscd_line *line, double length, double distance, cscd_proximities *out);

#ifdef __cplusplus
}
#endif

#endif
