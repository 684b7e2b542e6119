/* Features that do not move: whether they touch, by the signs of a few determinants.
 *
 * Their cubic is constant. If it is not 0, the points are never in one plane, and the features are apart. If it is 0, the
 * features touch all the time or never, so the first touch is at 0. No approximation can tell 0 from a number that is nearly
 * so: without these signs bodies that rest on each other would go to polynomials of integers, pair by pair, in every step.
 *
 * A projection along an axis is one-to-one on the plane of the points if it keeps three of them from being collinear. There
 *     a vertex is in the face if it is beyond none of the sides, as seen from within;
 *     two edges meet if neither has both ends strictly on one side of the other.
 * If no projection does so, the face, or both edges together, are on one line or in one point. Then any two sides of the face
 * cover it, and a vertex is in it if it is on one of them. Edges meet if an end of the first is on the second, or if the first
 * reaches beyond the second on both sides: then either end of the second is on the first. */
#include "runtime/ccd/ccd.h"
#include "runtime/narrow_phase/feature_queue.h"
#include "src/mesh/predicates.h"

static bool nothing_moves(const elementary_query *query) {
    const double *start = query->x0[0], *end = query->x1[0];
    for (int i = 0; i < 12; i++) {
        if (start[i] != end[i]) return false;
    }
    return true;
}

/* Returns the turn of three of the points, as seen along an axis. */
static int turn_along(const double x[4][3], int axis, int a, int b, int c) {
    int y = (axis + 1) % 3, z = (axis + 2) % 3;
    return orient2d(x[a][y], x[a][z], x[b][y], x[b][z], x[c][y], x[c][z]);
}

typedef enum planar_verdict { PLANAR_UNKNOWN, PLANAR_APART, PLANAR_TOUCHING } planar_verdict;

static planar_verdict vertex_in_face(const double x[4][3], int axis) {
    int turn = turn_along(x, axis, 1, 2, 3);
    if (turn == 0) return PLANAR_UNKNOWN;
    for (int i = 0; i < 3; i++) {
        if (turn_along(x, axis, 1 + i, 1 + (i + 1) % 3, 0) == -turn) return PLANAR_APART;
    }
    return PLANAR_TOUCHING;
}

static planar_verdict edges_meet(const double x[4][3], int axis) {
    int a0 = turn_along(x, axis, 2, 3, 0), a1 = turn_along(x, axis, 2, 3, 1);
    int b0 = turn_along(x, axis, 0, 1, 2), b1 = turn_along(x, axis, 0, 1, 3);
    if (a0 == 0 && a1 == 0 && b0 == 0 && b1 == 0) return PLANAR_UNKNOWN;
    return a0 * a1 > 0 || b0 * b1 > 0 ? PLANAR_APART : PLANAR_TOUCHING;
}

static bool on_segment(const double point[3], const double from[3], const double to[3]) {
    for (int k = 0; k < 3; k++) {
        if ((point[k] < from[k] && point[k] < to[k]) || (point[k] > from[k] && point[k] > to[k]))
            return false;
    }
    return collinear(point, from, to);
}

static bool collapsed_touch(const double x[4][3], cscd_contact_kind kind) {
    if (kind == CSCD_CONTACT_VF) return on_segment(x[0], x[1], x[2]) || on_segment(x[0], x[2], x[3]);
    return on_segment(x[0], x[2], x[3]) || on_segment(x[1], x[2], x[3]) || on_segment(x[2], x[0], x[1]);
}

/* For points in one plane. */
static bool touch_in_plane(const double x[4][3], cscd_contact_kind kind) {
    for (int axis = 0; axis < 3; axis++) {
        planar_verdict verdict = kind == CSCD_CONTACT_VF ? vertex_in_face(x, axis) : edges_meet(x, axis);
        if (verdict != PLANAR_UNKNOWN) return verdict == PLANAR_TOUCHING;
    }
    return collapsed_touch(x, kind);
}

static void describe_at_start(const elementary_query *query, cscd_contact_kind kind,
                              elementary_contact *contact) {
    point_vectors vectors;
    point_vectors_from(query, kind, &vectors);
    coplanarity f = coplanarity_cubic(&vectors);
    contact_frame_describe(query, kind, &f, 0.0, contact);
}

bool still_pair_decide(const elementary_query *query, cscd_contact_kind kind, elementary_verdict *verdict,
                       elementary_contact *contact) {
    const double(*x)[3] = query->x0;
    if (!nothing_moves(query)) return false;
    bool touching = orient3d(x[0], x[1], x[2], x[3]) == 0 && touch_in_plane(x, kind);
    *verdict = (elementary_verdict){touching, ELEMENTARY_EXACT};
    if (touching) describe_at_start(query, kind, contact);
    return true;
}
