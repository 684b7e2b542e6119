/* Do two triangles on small integers intersect, and how? Decided by definitions, in whole and rational numbers; and
 * random meshes with all their pairs. */
#include "tests/support/intersections/kind_oracle.h"

#include "tests/support/calls.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

integer_vector integer_cross(integer_vector a, integer_vector b) {
    return (integer_vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

int64_t integer_dot(integer_vector a, integer_vector b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static int64_t integer_determinant(integer_vector a, integer_vector b, integer_vector c) {
    return integer_dot(a, integer_cross(b, c));
}

/* Does 0 = wa a + wb b + wc c hold with positive weights for affinely independent a, b, c? The weights are
 * proportional to the areas of 0bc, 0ca and 0ab, so these triangles must all turn the same way. */
static bool inside_triangle(integer_vector a, integer_vector b, integer_vector c) {
    integer_vector bc = integer_cross(b, c), ca = integer_cross(c, a), ab = integer_cross(a, b);

    return integer_dot(a, bc) == 0 && integer_dot(bc, ca) > 0 && integer_dot(ca, ab) > 0 &&
           integer_dot(ab, bc) > 0;
}

/* Cramer's rule. */
static bool inside_tetrahedron(integer_vector a, integer_vector b, integer_vector c, integer_vector d) {
    int64_t wa = integer_determinant(b, c, d), wb = -integer_determinant(a, c, d);
    int64_t wc = integer_determinant(a, b, d), wd = -integer_determinant(a, b, c);

    return (wa > 0 && wb > 0 && wc > 0 && wd > 0) || (wa < 0 && wb < 0 && wc < 0 && wd < 0);
}

static bool inside_segment(integer_vector a, integer_vector b) {
    integer_vector n = integer_cross(a, b);

    return integer_dot(n, n) == 0 && integer_dot(a, b) < 0;
}

static bool hull_contains_origin(const integer_vector *d, int count) {
    for (int i = 0; i < count; i++) {
        if (integer_dot(d[i], d[i]) == 0) return true;
        for (int j = 0; j < i; j++) {
            if (inside_segment(d[i], d[j])) return true;
            for (int k = 0; k < j; k++) {
                if (inside_triangle(d[i], d[j], d[k])) return true;
                for (int l = 0; l < k; l++) {
                    if (inside_tetrahedron(d[i], d[j], d[k], d[l])) return true;
                }
            }
        }
    }
    return false;
}

/* A vertex, an edge or a face: some corners of a triangle. */
struct feature {
    uint32_t index[3];
    int count;
};

static uint32_t name_of(uint32_t vertex, const uint32_t *names) {
    return names != NULL ? names[vertex] : vertex;
}

static bool features_share(const struct feature *a, const struct feature *b, const uint32_t *names) {
    for (int i = 0; i < a->count; i++) {
        for (int j = 0; j < b->count; j++) {
            if (name_of(a->index[i], names) == name_of(b->index[j], names)) return true;
        }
    }
    return false;
}

static bool features_meet(const struct feature *a, const struct feature *b, const uint32_t *names,
                          const integer_vector *points) {
    integer_vector differences[9];
    int count = 0;

    if (features_share(a, b, names)) return false;
    for (int i = 0; i < a->count; i++) {
        for (int j = 0; j < b->count; j++) {
            integer_vector p = points[a->index[i]], q = points[b->index[j]];

            differences[count++] = (integer_vector){p.x - q.x, p.y - q.y, p.z - q.z};
        }
    }
    return hull_contains_origin(differences, count);
}

/* Three vertices, three edges, the face. */
static void list_features(const uint32_t triangle[3], struct feature features[7]) {
    for (int i = 0; i < 3; i++) {
        features[i] = (struct feature){{triangle[i]}, 1};
        features[3 + i] = (struct feature){{triangle[i], triangle[(i + 1) % 3]}, 2};
    }
    features[6] = (struct feature){{triangle[0], triangle[1], triangle[2]}, 3};
}

/* Counts a vertex or an edge with a face, either way, and an edge with an edge. */
static bool pair_counts(int a_count, int b_count) {
    return (a_count == 3) != (b_count == 3) || (a_count == 2 && b_count == 2);
}

bool oracle_intersects(const uint32_t a[3], const uint32_t b[3], const uint32_t *names,
                       const integer_vector *points) {
    struct feature a_features[7], b_features[7];

    list_features(a, a_features);
    list_features(b, b_features);
    for (int i = 0; i < 7; i++) {
        for (int j = 0; j < 7; j++) {
            if (!pair_counts(a_features[i].count, b_features[j].count)) continue;
            if (features_meet(&a_features[i], &b_features[j], names, points)) return true;
        }
    }
    return false;
}

/* ---- kinds of intersections ---------------------------------------------------------------------------- */

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

/* ---- meshes -------------------------------------------------------------------------------------------- */

static void make_points(random_stream *random, integer_scene *s) {
    int flat = (int)stream_below(random, 3);
    uint32_t range = 3 + stream_below(random, 4);
    for (uint32_t v = 0; v < ALL_VERTICES; v++) {
        integer_vector *p = &s->points[v];
        p->x = stream_below(random, range);
        p->y = stream_below(random, range);
        p->z = flat > 0 && stream_below(random, 2) == 0 ? 0 : stream_below(random, range);
        s->positions[3 * v] = (double)p->x;
        s->positions[3 * v + 1] = (double)p->y;
        s->positions[3 * v + 2] = (double)p->z;
    }
}

/* Some triangles repeat another one of their object, in another order of corners. */
static void make_triangles(random_stream *random, integer_scene *s) {
    for (uint32_t t = 0; t < ALL_TRIANGLES; t++) {
        uint32_t first = t - t % PART_TRIANGLES, *v = s->own[t];
        if (t > first && stream_below(random, 8) == 0) {
            const uint32_t *twin = s->own[first + stream_below(random, t - first)];
            for (int i = 0; i < 3; i++) v[i] = twin[(i + 1) % 3];
        } else {
            do {
                for (int i = 0; i < 3; i++) v[i] = stream_below(random, PART_VERTICES);
            } while (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]);
        }
        for (int i = 0; i < 3; i++) s->triangles[t][i] = v[i] + t / PART_TRIANGLES * PART_VERTICES;
    }
}

/* ---- what leaves pairs out ------------------------------------------------------------------------------- */

static void unite_names(integer_scene *s) {
    for (uint32_t v = 0; v < ALL_VERTICES; v++) s->names[v] = v;
    for (size_t i = 0; i < s->seam_count; i++) {
        uint32_t a = s->names[s->seams[i][0]], b = s->names[s->seams[i][1]];
        for (uint32_t v = 0; v < ALL_VERTICES; v++) {
            if (s->names[v] == b) s->names[v] = a;
        }
    }
}

static bool names_differ_in_triangles(const integer_scene *s) {
    for (uint32_t t = 0; t < ALL_TRIANGLES; t++) {
        const uint32_t *v = s->triangles[t], *names = s->names;
        if (names[v[0]] == names[v[1]] || names[v[1]] == names[v[2]] || names[v[2]] == names[v[0]])
            return false;
    }
    return true;
}

/* Sews single vertices, at one place or not, or a triangle to one of another object, at one place. */
static void make_seams(random_stream *random, integer_scene *s) {
    s->seam_count = stream_below(random, 2) == 0 ? 0 : stream_below(random, PAIRS_LEFT_OUT - 2);
    for (size_t i = 0; i < s->seam_count; i++) {
        do {
            s->seams[i][0] = stream_below(random, ALL_VERTICES);
            s->seams[i][1] = stream_below(random, ALL_VERTICES);
        } while (s->seams[i][0] == s->seams[i][1]);
    }
    if (s->seam_count >= 3) {
        uint32_t a = stream_below(random, PART_TRIANGLES),
                 b = PART_TRIANGLES + stream_below(random, PART_TRIANGLES);
        for (int i = 0; i < 3; i++) {
            uint32_t v = s->triangles[a][i], w = s->triangles[b][(i + 1) % 3];
            s->seams[i][0] = v;
            s->seams[i][1] = w;
            s->points[w] = s->points[v];
            memcpy(s->positions + 3 * (size_t)w, s->positions + 3 * (size_t)v, sizeof(double[3]));
        }
    }
    unite_names(s);
    if (names_differ_in_triangles(s)) return;
    s->seam_count = 0;
    unite_names(s);
}

static void make_rules(random_stream *random, integer_scene *s) {
    s->has_rules = stream_below(random, 3) == 0;
    for (int i = 0; i < SCENE_PARTS; i++) {
        s->obstacles[i] = stream_below(random, 5) == 0;
        s->rules[i] = cscd_object_rule_default();
        s->rules[i].category = 1 + stream_below(random, 3);
        s->rules[i].mask = 1 + stream_below(random, 3);
        s->rules[i].self = stream_below(random, 3) > 0;
        s->rules[i].obstacle_pairs = stream_below(random, 2) == 0;
    }
}

void integer_scene_make(uint64_t seed, integer_scene *out) {
    random_stream random = stream_start(seed);
    memset(out, 0, sizeof *out);
    make_points(&random, out);
    make_triangles(&random, out);
    make_seams(&random, out);
    make_rules(&random, out);
    out->ignored_count = stream_below(&random, 2) == 0 ? 0 : stream_below(&random, PAIRS_LEFT_OUT);
    for (size_t i = 0; i < out->ignored_count; i++) {
        out->ignored[i][0] = stream_below(&random, ALL_TRIANGLES);
        out->ignored[i][1] = stream_below(&random, ALL_TRIANGLES);
    }
    out->ignores = stream_below(&random, 4) == 0;
    if (stream_below(&random, 4) > 0) return;
    for (uint32_t v = 0; v < ALL_VERTICES; v++) {
        if (stream_below(&random, 5) == 0) out->active[out->active_count++] = v;
    }
}

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_TT && (a * 7 + b) % 5 == 0;
}

cscd_mesh *integer_scene_mesh(const integer_scene *s, cscd_context *context) {
    cscd_object_desc objects[SCENE_PARTS];
    cscd_mesh *mesh = NULL;
    for (int i = 0; i < SCENE_PARTS; i++) {
        objects[i] = cscd_object_of_triangles(PART_VERTICES, PART_TRIANGLES, s->own[i * PART_TRIANGLES]);
        objects[i].obstacle = s->obstacles[i];
    }
    expect_ok(cscd_mesh_create(context, objects, SCENE_PARTS, &mesh));
    return mesh;
}

cscd_detector *integer_scene_detector(const integer_scene *s, const cscd_mesh *mesh, cscd_method method) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    options.method = method;
    options.ours = ours_of_method(method);
    options.seams = s->seam_count > 0 ? s->seams[0] : NULL;
    options.seam_count = s->seam_count;
    options.seam_reach = INFINITY;
    options.ignored = s->ignored_count > 0 ? s->ignored[0] : NULL;
    options.ignored_count = s->ignored_count;
    options.rules = s->has_rules ? s->rules : NULL;
    options.rule_count = s->has_rules ? SCENE_PARTS : 0;
    options.ignore = s->ignores ? ignore_some : NULL;
    if (method == CSCD_METHOD_KMEANS) {
        cscd_plan_options plan_options = cscd_plan_defaults();
        plan_options.method = CSCD_METHOD_KMEANS;
        expect_ok(plan_create_packed(mesh, s->positions, &plan_options, &plan));
    }
    expect_ok(detector_create_here(mesh, plan, &options, &detector));
    cscd_plan_destroy(plan);
    if (s->active_count > 0) expect_ok(cscd_detector_set_active(detector, s->active, s->active_count));
    return detector;
}

/* ---- the oracle ---------------------------------------------------------------------------------------- */

static bool objects_look(const integer_scene *s, uint32_t i, uint32_t j) {
    const cscd_object_rule *p = &s->rules[i], *q = &s->rules[j];
    if (s->obstacles[i] && s->obstacles[j]) {
        if (i == j || !s->has_rules || !p->obstacle_pairs || !q->obstacle_pairs) return false;
    }
    if (!s->has_rules) return true;
    return i == j ? p->self : (p->category & q->mask) != 0 && (q->category & p->mask) != 0;
}

static bool is_active(const integer_scene *s, uint32_t triangle) {
    for (size_t i = 0; i < s->active_count; i++) {
        for (int k = 0; k < 3; k++) {
            if (s->triangles[triangle][k] == s->active[i]) return true;
        }
    }
    return s->active_count == 0;
}

static bool is_left_out(const integer_scene *s, uint32_t a, uint32_t b) {
    if (!is_active(s, a) && !is_active(s, b)) return true;
    if (!objects_look(s, a / PART_TRIANGLES, b / PART_TRIANGLES)) return true;
    if (s->ignores && ignore_some(NULL, CSCD_CONTACT_TT, a, b)) return true;
    for (size_t i = 0; i < s->ignored_count; i++) {
        uint32_t p = s->ignored[i][0], q = s->ignored[i][1];
        if ((p == a && q == b) || (p == b && q == a)) return true;
    }
    return false;
}

/* The component of a triangle, as it is in the mesh, is asked of the mesh; the object is known. */
size_t integer_scene_pairs(const integer_scene *s, uint64_t kinds, cscd_intersection out[PAIRS_MAX]) {
    size_t count = 0;
    for (uint32_t a = 0; a < ALL_TRIANGLES; a++) {
        for (uint32_t b = a + 1; b < ALL_TRIANGLES; b++) {
            if (is_left_out(s, a, b)) continue;
            int kind = oracle_kind(s->triangles[a], s->triangles[b], s->names, false, s->points);
            if (kind < 0 || (kinds >> kind & 1) == 0) continue;
            out[count++] =
                (cscd_intersection){.a = a,
                                    .b = b,
                                    .kind = (cscd_intersection_kind)kind,
                                    .shared = oracle_shared(s->triangles[a], s->triangles[b], s->names),
                                    .objects = {a / PART_TRIANGLES, b / PART_TRIANGLES}};
        }
    }
    return count;
}
