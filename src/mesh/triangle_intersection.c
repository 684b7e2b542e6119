/* Do two triangles of one mesh intersect, features that share a vertex aside? The test is exact. What it
 * tests for each number of shared vertices, and why that is enough, is in docs/theory/static-check.md, whose
 * lemmas are cited below. Vertices within a triangle have distinct indices; their positions may coincide or
 * lie on one line. */
#include "src/mesh/predicates.h"

#include "src/mesh/mesh.h"

#include <stddef.h>

struct triangle {
    const double *corner[3];
    bool shared[3]; /* the corner is also a corner of the other triangle */
};

static struct triangle load_triangle(const uint32_t triangle[3], const uint32_t other[3],
                                     const double *positions) {
    struct triangle t;

    for (int i = 0; i < 3; i++) {
        t.corner[i] = positions + 3 * (size_t)triangle[i];
        t.shared[i] = triangle_contains(other, triangle[i]);
    }
    return t;
}

static bool all_below(const double *const *points, int count, const double *const *others, int other_count,
                      int axis) {
    double highest = points[0][axis], lowest = others[0][axis];

    for (int i = 1; i < count; i++) {
        if (points[i][axis] > highest) highest = points[i][axis];
    }
    for (int i = 1; i < other_count; i++) {
        if (others[i][axis] < lowest) lowest = others[i][axis];
    }
    return highest < lowest;
}

static bool boxes_overlap(const double *const *a, int a_count, const double *const *b, int b_count) {
    for (int axis = 0; axis < 3; axis++) {
        if (all_below(a, a_count, b, b_count, axis) || all_below(b, b_count, a, a_count, axis)) return false;
    }
    return true;
}

/* The orientation of three points in the projection along an axis. */
static int orient_along(const double *a, const double *b, const double *c, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;

    return orient2d(a[x], a[y], b[x], b[y], c[x], c[y]);
}

/* Lemma 2: two closed segments, possibly points. */
static bool segments_intersect(const double *p, const double *q, const double *r, const double *s) {
    const double *const pq[2] = {p, q}, *const rs[2] = {r, s};

    if (!boxes_overlap(pq, 2, rs, 2)) return false;
    if (orient3d(p, q, r, s) != 0) return false;
    for (int axis = 0; axis < 3; axis++) {
        int r_side = orient_along(p, q, r, axis), s_side = orient_along(p, q, s, axis);
        int p_side = orient_along(r, s, p, axis), q_side = orient_along(r, s, q, axis);

        if (r_side != 0 || s_side != 0 || p_side != 0 || q_side != 0)
            return r_side * s_side <= 0 && p_side * q_side <= 0;
    }
    return true;
}

static bool same_sign_or_zero(int a, int b, int c) {
    return !((a > 0 || b > 0 || c > 0) && (a < 0 || b < 0 || c < 0));
}

/* Lies p, a point of the triangle's plane, in the triangle? A triangle without area is left to the test of
 * its edges. */
static bool within_coplanar_triangle(const double *p, const struct triangle *t) {
    const double *a = t->corner[0], *b = t->corner[1], *c = t->corner[2];

    for (int axis = 0; axis < 3; axis++) {
        if (orient_along(a, b, c, axis) != 0)
            return same_sign_or_zero(orient_along(a, b, p, axis), orient_along(b, c, p, axis),
                                     orient_along(c, a, p, axis));
    }
    return false;
}

static bool coplanar_segment_intersects_triangle(const double *p, const double *q, const struct triangle *t) {
    return segments_intersect(p, q, t->corner[0], t->corner[1]) ||
           segments_intersect(p, q, t->corner[1], t->corner[2]) ||
           segments_intersect(p, q, t->corner[2], t->corner[0]) || within_coplanar_triangle(p, t);
}

/* Does the line pq, which is not in the plane of the triangle, pass all edges in the same sense or through
 * them? */
static bool line_crosses_triangle(const double *p, const double *q, const struct triangle *t) {
    const double *a = t->corner[0], *b = t->corner[1], *c = t->corner[2];

    return same_sign_or_zero(orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a));
}

/* Lemma 3: a closed segment and a closed face. p_side and q_side are the sides of the face's plane on which p
 * and q lie, both 0 if the face has no area. */
static bool segment_intersects_triangle(const double *p, int p_side, const double *q, int q_side,
                                        const struct triangle *t) {
    if (p_side * q_side > 0) return false;
    if (p_side == 0 && q_side == 0) return coplanar_segment_intersects_triangle(p, q, t);
    return line_crosses_triangle(p, q, t);
}

static bool point_in_triangle(const double *p, const struct triangle *t) {
    int side = orient3d(t->corner[0], t->corner[1], t->corner[2], p);

    return segment_intersects_triangle(p, side, p, side, t);
}

/* The side of the face's plane on which each corner of t lies; shared corners lie in it. */
static void find_sides(const struct triangle *t, const struct triangle *face, int side[3]) {
    for (int i = 0; i < 3; i++) {
        side[i] =
            t->shared[i] ? 0 : orient3d(face->corner[0], face->corner[1], face->corner[2], t->corner[i]);
    }
}

/* Lemma 4: do all corners that are not shared lie strictly on one side? */
static bool strictly_on_one_side(const struct triangle *t, const int side[3]) {
    int positive = 0, negative = 0, shared = 0;

    for (int i = 0; i < 3; i++) {
        positive += side[i] > 0;
        negative += side[i] < 0;
        shared += t->shared[i];
    }
    return positive + shared == 3 || negative + shared == 3;
}

/* Does an edge of t without a shared vertex intersect the face? */
static bool unshared_edge_intersects(const struct triangle *t, const int side[3],
                                     const struct triangle *face) {
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;

        if (t->shared[i] || t->shared[j]) continue;
        if (segment_intersects_triangle(t->corner[i], side[i], t->corner[j], side[j], face)) return true;
    }
    return false;
}

/* Lemma 1, for at most one shared vertex. */
static bool edges_intersect_faces(const struct triangle *a, const struct triangle *b) {
    int a_side[3], b_side[3];

    if (!boxes_overlap(a->corner, 3, b->corner, 3)) return false;
    find_sides(b, a, b_side);
    if (strictly_on_one_side(b, b_side)) return false;
    find_sides(a, b, a_side);
    if (strictly_on_one_side(a, a_side)) return false;
    return unshared_edge_intersects(a, a_side, b) || unshared_edge_intersects(b, b_side, a);
}

static int apex_of(const struct triangle *t) {
    return !t->shared[0] ? 0 : !t->shared[1] ? 1 : 2;
}

/* Lemma 5: with two shared vertices, only triangles of one plane that are folded onto each other can
 * intersect. */
static bool pair_sharing_edge_intersects(const struct triangle *a, const struct triangle *b) {
    int apex = apex_of(a);
    const double *p = a->corner[(apex + 1) % 3], *q = a->corner[(apex + 2) % 3];
    const double *c = a->corner[apex], *d = b->corner[apex_of(b)];

    if (orient3d(p, q, c, d) != 0) return false;
    return point_in_triangle(c, b) || point_in_triangle(d, a) || segments_intersect(p, c, q, d) ||
           segments_intersect(q, c, p, d);
}

bool triangles_intersect(const uint32_t a[3], const uint32_t b[3], const double *positions) {
    struct triangle ta = load_triangle(a, b, positions), tb = load_triangle(b, a, positions);
    int shared_count = ta.shared[0] + ta.shared[1] + ta.shared[2];

    if (shared_count == 3) return false;
    if (shared_count == 2) return pair_sharing_edge_intersects(&ta, &tb);
    return edges_intersect_faces(&ta, &tb);
}

/* ---- vertices that names unite ------------------------------------------------------------------------- */

static bool same_name_in(const uint32_t *list, int count, uint32_t vertex, const uint32_t *names) {
    for (int i = 0; i < count; i++) {
        if (names[list[i]] == names[vertex]) return true;
    }
    return false;
}

static struct triangle load_by_names(const uint32_t triangle[3], const uint32_t other[3],
                                     const uint32_t *names, const double *positions) {
    struct triangle t;

    for (int i = 0; i < 3; i++) {
        t.corner[i] = positions + 3 * (size_t)triangle[i];
        t.shared[i] = same_name_in(other, 3, triangle[i], names);
    }
    return t;
}

/* Does a corner or an edge of t that shares no name with the face intersect it? A corner of the same name
 * need not lie in the plane of the face. */
static bool unshared_part_intersects(const struct triangle *t, const struct triangle *face) {
    int side[3];

    for (int i = 0; i < 3; i++)
        side[i] = orient3d(face->corner[0], face->corner[1], face->corner[2], t->corner[i]);
    for (int i = 0; i < 3; i++) {
        if (!t->shared[i] && point_in_triangle(t->corner[i], face)) return true;
    }
    return unshared_edge_intersects(t, side, face);
}

static bool unshared_edges_intersect(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                                     const double *positions) {
    for (int k = 0; k < 9; k++) {
        const uint32_t p[2] = {a[k / 3], a[(k / 3 + 1) % 3]}, q[2] = {b[k % 3], b[(k % 3 + 1) % 3]};

        if (same_name_in(q, 2, p[0], names) || same_name_in(q, 2, p[1], names)) continue;
        if (segments_intersect(positions + 3 * (size_t)p[0], positions + 3 * (size_t)p[1],
                               positions + 3 * (size_t)q[0], positions + 3 * (size_t)q[1]))
            return true;
    }
    return false;
}

bool triangles_intersect_by_names(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                                  const double *positions) {
    struct triangle ta = load_by_names(a, b, names, positions), tb = load_by_names(b, a, names, positions);

    return unshared_part_intersects(&ta, &tb) || unshared_part_intersects(&tb, &ta) ||
           unshared_edges_intersect(a, b, names, positions);
}
