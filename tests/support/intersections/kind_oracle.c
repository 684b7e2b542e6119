/* The intersection of two triangles is a polygon, perhaps only a segment, a point, or nothing: the one triangle is cut by
 * the plane of the other from both sides, and by the three planes that stand on its edges. By convexity the open
 * triangles meet if and only if the middle of this polygon's corners is inside both of them; and there it is on the
 * inner side of an edge if one of the corners is, because none is on the outer side. */
#include "tests/support/intersections/kind_oracle.h"

#include <stdio.h>
#include <stdlib.h>

/* The point (x, y, z) / w, w > 0, in lowest terms. */
typedef struct rational_point {
    int64_t x, y, z, w;
} rational_point;

/* The points p with n . p >= d. */
typedef struct half_plane {
    integer_vector n;
    int64_t d;
} half_plane;

enum { CORNERS_MAX = 16 };

typedef struct rational_polygon {
    rational_point corners[CORNERS_MAX];
    int count;
} rational_polygon;

static int64_t narrow_number(__int128 value) {
    if (value > INT64_MAX || value < -INT64_MAX) {
        fputs("kind_oracle: a number is too large\n", stderr);
        abort();
    }
    return (int64_t)value;
}

static __int128 common_divisor(__int128 a, __int128 b) {
    if (a < 0) a = -a;
    if (b < 0) b = -b;
    while (b != 0) {
        __int128 rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static rational_point lowest_terms(__int128 x, __int128 y, __int128 z, __int128 w) {
    __int128 divisor = common_divisor(common_divisor(x, y), common_divisor(z, w));
    return (rational_point){narrow_number(x / divisor), narrow_number(y / divisor),
                            narrow_number(z / divisor), narrow_number(w / divisor)};
}

/* w times how far the point is within the half plane, up to the length of n. */
static __int128 height_of(const half_plane *h, rational_point p) {
    return (__int128)h->n.x * p.x + (__int128)h->n.y * p.y + (__int128)h->n.z * p.z - (__int128)h->d * p.w;
}

/* The point between p, inside at height up / p.w, and q, outside at height -down / q.w, that lies on the border. */
static rational_point border_point(rational_point p, __int128 up, rational_point q, __int128 down) {
    return lowest_terms(down * p.x + up * q.x, down * p.y + up * q.y, down * p.z + up * q.z,
                        down * p.w + up * q.w);
}

/* Sutherland and Hodgman 1974. */
static rational_polygon cut_polygon(const rational_polygon *all, const half_plane *h) {
    rational_polygon rest = {.count = 0};
    for (int i = 0; i < all->count; i++) {
        rational_point p = all->corners[i], q = all->corners[(i + 1) % all->count];
        __int128 at_p = height_of(h, p), at_q = height_of(h, q);
        if (at_p >= 0) rest.corners[rest.count++] = p;
        if (at_p > 0 && at_q < 0) rest.corners[rest.count++] = border_point(p, at_p, q, -at_q);
        if (at_p < 0 && at_q > 0) rest.corners[rest.count++] = border_point(q, at_q, p, -at_p);
    }
    if (rest.count > CORNERS_MAX - 2) abort();
    return rest;
}

static integer_vector vector_to(integer_vector a, integer_vector b) {
    return (integer_vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static integer_vector normal_of(const uint32_t t[3], const integer_vector *points) {
    return integer_cross(vector_to(points[t[1]], points[t[0]]), vector_to(points[t[2]], points[t[0]]));
}

static bool is_null(integer_vector v) {
    return v.x == 0 && v.y == 0 && v.z == 0;
}

static half_plane plane_through(integer_vector n, integer_vector p) {
    return (half_plane){n, integer_dot(n, p)};
}

/* The plane that stands on an edge, with the triangle on its inner side. */
static half_plane inside_edge(const uint32_t t[3], int edge, const integer_vector *points) {
    integer_vector p = points[t[edge]], q = points[t[(edge + 1) % 3]];
    return plane_through(integer_cross(normal_of(t, points), vector_to(q, p)), p);
}

static rational_polygon intersect_triangles(const uint32_t a[3], const uint32_t b[3],
                                            const integer_vector *points) {
    integer_vector n = normal_of(b, points), m = {-n.x, -n.y, -n.z};
    half_plane front = plane_through(n, points[b[0]]), back = plane_through(m, points[b[0]]);
    rational_polygon p = {.count = 3};
    for (int i = 0; i < 3; i++)
        p.corners[i] = (rational_point){points[a[i]].x, points[a[i]].y, points[a[i]].z, 1};
    p = cut_polygon(&p, &front);
    p = cut_polygon(&p, &back);
    for (int edge = 0; edge < 3; edge++) {
        half_plane h = inside_edge(b, edge, points);
        p = cut_polygon(&p, &h);
    }
    return p;
}

static bool middle_is_inside(const rational_polygon *p, const uint32_t t[3], const integer_vector *points) {
    for (int edge = 0; edge < 3; edge++) {
        half_plane h = inside_edge(t, edge, points);
        bool inside = false;
        for (int i = 0; i < p->count; i++) inside |= height_of(&h, p->corners[i]) > 0;
        if (!inside) return false;
    }
    return true;
}

static uint32_t name_of(uint32_t vertex, const uint32_t *names) {
    return names != NULL ? names[vertex] : vertex;
}

uint32_t oracle_shared(const uint32_t a[3], const uint32_t b[3], const uint32_t *names) {
    uint32_t shared = 0;
    for (int k = 0; k < 9; k++) shared += name_of(a[k / 3], names) == name_of(b[k % 3], names);
    return shared;
}

/* Three shared vertices, each two at one place. */
static bool is_duplicate(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                         const integer_vector *points) {
    int equal = 0;
    for (int k = 0; k < 9; k++) {
        uint32_t v = a[k / 3], w = b[k % 3];
        equal += name_of(v, names) == name_of(w, names) && is_null(vector_to(points[v], points[w]));
    }
    return equal == 3 && !is_null(normal_of(a, points));
}

int oracle_kind(const uint32_t a[3], const uint32_t b[3], const uint32_t *names, bool by_index,
                const integer_vector *points) {
    if (is_duplicate(a, b, names, points)) return CSCD_INTERSECTION_DUPLICATE;
    if (!oracle_intersects(a, b, by_index ? NULL : names, points)) return -1;
    integer_vector n = normal_of(a, points), m = normal_of(b, points);
    if (is_null(n) || is_null(m)) return CSCD_INTERSECTION_TOUCHING;
    rational_polygon p = intersect_triangles(a, b, points);
    if (!middle_is_inside(&p, a, points) || !middle_is_inside(&p, b, points))
        return CSCD_INTERSECTION_TOUCHING;
    if (!is_null(integer_cross(n, m))) return CSCD_INTERSECTION_CROSSING;
    return oracle_shared(a, b, names) == 0 ? CSCD_INTERSECTION_COPLANAR : CSCD_INTERSECTION_FOLDED;
}
