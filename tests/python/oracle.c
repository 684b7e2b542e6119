/* Brute force and scenes for the tests of the Python package (python/tests/oracle.py), as a library that these load: contacts
 * and proximities by oracle.c, kinds of intersections of each pair of triangles by themselves. There is one scene at a time,
 * and one list. A scene that does not fit is refused; whatever else fails ends the process. */
#include "tests/support/oracle.h"
#include "runtime/intersections/static_check.h"
#include "tests/support/intersections/kind_oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Python finds these functions by name, so there is nobody to declare them for. */
#define ORACLE_API __attribute__((visibility("default")))
#pragma GCC diagnostic ignored "-Wmissing-prototypes"

typedef struct oracle_pair {
    uint32_t a, b, kind, shared;
} oracle_pair;

static scene now;
static oracle_list found;
static oracle_pair *pairs;
static size_t pair_count, pair_capacity;

/* ---- scenes ---------------------------------------------------------------------------------------------- */

ORACLE_API uint32_t oracle_python_families(void) {
    return SCENE_FAMILY_COUNT;
}

ORACLE_API const char *oracle_python_family_name(uint32_t family) {
    return scene_family_name((scene_family)family);
}

/* Makes a scene; sizes: its vertices and triangles. */
ORACLE_API void oracle_python_make(uint32_t family, uint64_t seed, uint32_t sizes[2]) {
    scene_make((scene_family)family, seed, &now);
    sizes[0] = now.vertex_count;
    sizes[1] = now.triangle_count;
}

ORACLE_API void oracle_python_copy_scene(double *x0, double *x1, uint32_t *triangles) {
    memcpy(x0, now.x0, (size_t)now.vertex_count * sizeof(double[3]));
    memcpy(x1, now.x1, (size_t)now.vertex_count * sizeof(double[3]));
    memcpy(triangles, now.triangles, (size_t)now.triangle_count * sizeof(uint32_t[3]));
}

/* Takes a scene of the caller, whose triangles have indices below its vertex_count. */
ORACLE_API bool oracle_python_set(uint32_t vertex_count, uint32_t triangle_count, const double *x0,
                                  const double *x1, const uint32_t *triangles) {
    if (vertex_count > SCENE_VERTICES_MAX || triangle_count > SCENE_TRIANGLES_MAX) return false;
    now.vertex_count = vertex_count;
    now.triangle_count = triangle_count;
    memcpy(now.x0, x0, (size_t)vertex_count * sizeof(double[3]));
    memcpy(now.x1, x1, (size_t)vertex_count * sizeof(double[3]));
    memcpy(now.triangles, triangles, (size_t)triangle_count * sizeof(uint32_t[3]));
    return true;
}

/* ---- what moves ------------------------------------------------------------------------------------------ */

/* Finds contacts; distance above 0: what comes within it, up to the tolerance. Returns how many there are. */
ORACLE_API size_t oracle_python_contacts(double distance, double tolerance) {
    const separation limit = {distance, tolerance};
    oracle_find_within(&now, distance > 0.0 ? &limit : NULL, &found);
    return found.count;
}

/* The same for objects that have distances of their own: see oracle_rules. */
ORACLE_API size_t oracle_python_contacts_by_rules(const uint32_t *vertex_objects, uint32_t object_count,
                                                  const double *distances) {
    const oracle_rules rules = {vertex_objects, object_count, distances};
    oracle_find_by_rules(&now, &rules, &found);
    return found.count;
}

/* Rows of (kind, a, b), and times. */
ORACLE_API void oracle_python_copy_contacts(uint32_t *names, double *toi) {
    for (size_t i = 0; i < found.count; i++) {
        const oracle_contact *c = &found.items[i];
        memcpy(names + 3 * i, (uint32_t[3]){(uint32_t)c->kind, c->a, c->b}, sizeof(uint32_t[3]));
        toi[i] = c->toi;
    }
}

/* ---- one moment ------------------------------------------------------------------------------------------ */

static void add_kind(oracle_pair pair) {
    if (pair_count == pair_capacity) {
        pair_capacity = pair_capacity * 2 + 64;
        pairs = realloc(pairs, pair_capacity * sizeof *pairs);
        if (pairs == NULL) abort();
    }
    pairs[pair_count++] = pair;
}

static void add_pair_of_numbers(const uint32_t *first, const uint32_t *second, uint32_t a, uint32_t b) {
    pair_kind kind;
    if (pair_kind_find(first, second, NULL, now.x0, &kind))
        add_kind((oracle_pair){a, b, (uint32_t)kind.kind, kind.shared});
}

static void add_pair_of_integers(const uint32_t *first, const uint32_t *second,
                                 const integer_vector points[SCENE_VERTICES_MAX], uint32_t a, uint32_t b) {
    int kind = oracle_kind(first, second, NULL, false, points);
    if (kind >= 0) add_kind((oracle_pair){a, b, (uint32_t)kind, oracle_shared(first, second, NULL)});
}

/* How each two triangles intersect at x0; returns how many pairs do. integers: all coordinates are whole numbers up to 100, and
 * the pairs are decided by kind_oracle.c, which has no code of the library. */
ORACLE_API size_t oracle_python_kinds(bool integers) {
    static integer_vector points[SCENE_VERTICES_MAX];
    for (size_t v = 0; integers && v < now.vertex_count; v++) {
        const double *p = now.x0 + 3 * v;
        points[v] = (integer_vector){(int64_t)p[0], (int64_t)p[1], (int64_t)p[2]};
    }
    pair_count = 0;
    for (uint32_t a = 0; a < now.triangle_count; a++) {
        for (uint32_t b = a + 1; b < now.triangle_count; b++) {
            const uint32_t *first = now.triangles + (size_t)a * 3, *second = now.triangles + (size_t)b * 3;
            if (integers)
                add_pair_of_integers(first, second, points, a, b);
            else
                add_pair_of_numbers(first, second, a, b);
        }
    }
    return pair_count;
}

/* Rows of (a, b, kind, shared vertices), sorted. */
ORACLE_API void oracle_python_copy_kinds(uint32_t *rows) {
    if (pair_count > 0) memcpy(rows, pairs, pair_count * sizeof *pairs);
}
