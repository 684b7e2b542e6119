/* Two simplices meet when 0 is a convex combination of the differences of their corners, and then, by Caratheodory's
 * theorem, one with positive weights of at most four affinely independent differences. */
#include "tests/support/intersections/feature_oracle.h"

#include <stddef.h>

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
