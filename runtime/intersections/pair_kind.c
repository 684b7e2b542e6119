/* The kind of an intersection of two triangles: crossing, in one plane, or touching only. An open triangle is
 * one without its edges; docs/theory/static-check.md proves the lemmas that are cited. */
#include "runtime/intersections/static_check.h"

#include "src/mesh/mesh.h"
#include "src/mesh/predicates.h"

/* Corners point into the positions of the mesh, so two of them are equal if they are one vertex. */
typedef struct corner_list {
    const double *at[3];
} corner_list;

/* APART: the closed triangles have no point in common. TOUCHING: the open ones have none. Either is said only where it
 * follows from signs that are known anyway. */
typedef enum pair_meeting {
    MEETING_UNKNOWN,
    MEETING_APART,
    MEETING_TOUCHING,
    MEETING_ACROSS,
    MEETING_IN_PLANE
} pair_meeting;

static corner_list corners_of(const uint32_t triangle[3], const double *positions) {
    corner_list list;
    for (int i = 0; i < 3; i++) list.at[i] = positions + (size_t)triangle[i] * 3;
    return list;
}

static bool is_corner(const corner_list *list, const double *p) {
    return p == list->at[0] || p == list->at[1] || p == list->at[2];
}

/* ---- across -------------------------------------------------------------------------------------------- */

/* The sides of the face's plane on which the corners of t lie. Most are told without determinants where corners are
 * shared, which would be 0 and so take exact arithmetic. */
static void find_sides(const corner_list *face, const corner_list *t, int sides[3]) {
    for (int i = 0; i < 3; i++) {
        const double *p = t->at[i];
        sides[i] = is_corner(face, p) ? 0 : orient3d(face->at[0], face->at[1], face->at[2], p);
    }
}

static bool all_zero(const int sides[3]) {
    return sides[0] == 0 && sides[1] == 0 && sides[2] == 0;
}

/* The corner that lies strictly on one side while no other one does; 3: no open edge passes through the plane. */
static int lone_corner(const int sides[3]) {
    bool above = sides[0] > 0 || sides[1] > 0 || sides[2] > 0,
         below = sides[0] < 0 || sides[1] < 0 || sides[2] < 0;
    if (!above || !below) return 3;
    for (int i = 0; i < 3; i++) {
        if (sides[i] != 0 && sides[(i + 1) % 3] != sides[i] && sides[(i + 2) % 3] != sides[i]) return i;
    }
    return 3;
}

/* The corners in cyclic order from the lone one on, or in the other order, which turns the face over. */
static corner_list from_lone(const corner_list *t, int lone, bool turn_over) {
    int next = turn_over ? 2 : 1;
    return (corner_list){{t->at[lone], t->at[(lone + next) % 3], t->at[(lone + 3 - next) % 3]}};
}

/* Lemma 12. Neither are all corners of one in the plane of the other. */
static pair_meeting meet_across(const corner_list *a, const int a_sides[3], const corner_list *b,
                                const int b_sides[3]) {
    int lone_a = lone_corner(a_sides), lone_b = lone_corner(b_sides);
    if (lone_a == 3 || lone_b == 3) return MEETING_UNKNOWN;
    corner_list p = from_lone(a, lone_a, b_sides[lone_b] < 0), q = from_lone(b, lone_b, a_sides[lone_a] < 0);
    int before = orient3d(p.at[0], p.at[1], q.at[0], q.at[1]);
    if (before > 0) return MEETING_APART;
    int behind = orient3d(p.at[0], p.at[2], q.at[2], q.at[0]);
    if (behind > 0) return MEETING_APART;
    return before < 0 && behind < 0 ? MEETING_ACROSS : MEETING_TOUCHING;
}

/* ---- in one plane -------------------------------------------------------------------------------------- */

static int turn_along(const double *a, const double *b, const double *c, int axis) {
    int x = (axis + 1) % 3, y = (axis + 2) % 3;
    if ((a[x] == c[x] && a[y] == c[y]) || (b[x] == c[x] && b[y] == c[y])) return 0;
    return orient2d(a[x], a[y], b[x], b[y], c[x], c[y]);
}

static int own_turn(const corner_list *t, int axis) {
    return turn_along(t->at[0], t->at[1], t->at[2], axis);
}

/* Returns how far the lines of the edges of a part it from b: 1, strictly; 0, b reaches such a line; -1, not at all. */
static int parted_by_edges(const corner_list *a, const corner_list *b, int axis) {
    int own = own_turn(a, axis), best = -1;
    for (int i = 0; i < 3 && best < 1; i++) {
        int nearest = 1;
        for (int j = 0; j < 3 && nearest > best; j++) {
            int beyond = -turn_along(a->at[i], a->at[(i + 1) % 3], b->at[j], axis) * own;
            if (beyond < nearest) nearest = beyond;
        }
        if (nearest > best) best = nearest;
    }
    return best;
}

/* Lemma 13. All corners of each lie in the plane of the other, if it has an area. */
static pair_meeting meet_in_plane(const corner_list *a, const corner_list *b) {
    int axis = 0;
    while (axis < 3 && own_turn(a, axis) == 0) axis++;
    if (axis == 3 || own_turn(b, axis) == 0) return MEETING_UNKNOWN;
    int by_a = parted_by_edges(a, b, axis);
    int by_b = by_a < 1 ? parted_by_edges(b, a, axis) : -1;
    int parted = by_a > by_b ? by_a : by_b;
    return parted > 0 ? MEETING_APART : parted == 0 ? MEETING_TOUCHING : MEETING_IN_PLANE;
}

/* Lemma 11. */
static pair_meeting how_triangles_meet(const corner_list *a, const corner_list *b) {
    int a_sides[3], b_sides[3];
    find_sides(a, b, b_sides);
    find_sides(b, a, a_sides);
    bool b_in_plane = all_zero(b_sides), a_in_plane = all_zero(a_sides);
    if (a_in_plane && b_in_plane) return meet_in_plane(a, b);
    if (a_in_plane || b_in_plane) return MEETING_UNKNOWN; /* one has no area */
    return meet_across(a, a_sides, b, b_sides);
}

/* Closed triangles with a common corner meet there at least, which does not count. */
static bool have_common_corner(const corner_list *a, const corner_list *b) {
    return is_corner(b, a->at[0]) || is_corner(b, a->at[1]) || is_corner(b, a->at[2]);
}

/* ---- names --------------------------------------------------------------------------------------------- */

static uint32_t name_of(const uint32_t *names, uint32_t vertex) {
    return names != NULL ? names[vertex] : vertex;
}

/* Returns the number of corners of a with a name that b has. */
static uint32_t count_named(const uint32_t a[3], const uint32_t b[3], const uint32_t *names) {
    uint32_t count = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t name = name_of(names, a[i]);
        count += name == name_of(names, b[0]) || name == name_of(names, b[1]) || name == name_of(names, b[2]);
    }
    return count;
}

/* The two counts differ where a seam unites two corners of one triangle. */
uint32_t pair_kind_count_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names) {
    uint32_t of_a = count_named(a, b, names), of_b = count_named(b, a, names);
    return of_a < of_b ? of_a : of_b;
}

static bool same_place(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* Has each corner of a one of b at its place, with its name? */
static bool at_same_places(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                           const double *positions) {
    for (int i = 0; i < 3; i++) {
        bool found = false;
        for (int j = 0; j < 3; j++) {
            uint32_t v = a[i], w = b[j];
            found |= name_of(names, v) == name_of(names, w) &&
                     same_place(positions + (size_t)v * 3, positions + (size_t)w * 3);
        }
        if (!found) return false;
    }
    return true;
}

static bool has_area(const uint32_t triangle[3], const double *positions) {
    corner_list t = corners_of(triangle, positions);
    return !collinear(t.at[0], t.at[1], t.at[2]);
}

bool pair_kind_find(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, const double *positions,
                    pair_kind *out) {
    uint32_t shared = pair_kind_count_shared(a, b, names);
    if (shared == 3 && at_same_places(a, b, names, positions) && has_area(a, positions)) {
        *out = (pair_kind){CSCD_INTERSECTION_DUPLICATE, shared};
        return true;
    }
    const corner_list corners_a = corners_of(a, positions), corners_b = corners_of(b, positions);
    pair_meeting how = how_triangles_meet(&corners_a, &corners_b);
    cscd_intersection_kind kind = CSCD_INTERSECTION_TOUCHING;
    if (how == MEETING_ACROSS) {
        kind = CSCD_INTERSECTION_CROSSING;
    } else if (how == MEETING_IN_PLANE) {
        kind = shared == 0 ? CSCD_INTERSECTION_COPLANAR : CSCD_INTERSECTION_FOLDED;
    } else if (how == MEETING_UNKNOWN || have_common_corner(&corners_a, &corners_b)) {
        if (!triangles_intersect(a, b, positions)) return false;
    } else if (how == MEETING_APART) {
        return false;
    }
    *out = (pair_kind){kind, shared};
    return true;
}
