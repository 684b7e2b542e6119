/* Stars that are called clear do not intersect themselves, whatever mesh they are in; smooth ones are called clear; and the
 * others give all their pairs, each of them once. */
#include "runtime/intersections/static_check.h"
#include "src/mesh/predicates.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene s; /* large; one test at a time */

static int seed_random(void **state) {
    (void)state;
    random_seed(20261126);
    return 0;
}

/* ---- what is marked ------------------------------------------------------------------------------------- */

static const uint32_t *corners_of(uint32_t triangle) {
    return s.triangles + (size_t)triangle * 3;
}

static int count_common(const uint32_t *a, const uint32_t *b) {
    return triangle_contains(b, a[0]) + triangle_contains(b, a[1]) + triangle_contains(b, a[2]);
}

static bool common_vertex_is_clear(const vertex_stars *stars, const uint32_t *a, const uint32_t *b) {
    for (int i = 0; i < 3; i++) {
        if (triangle_contains(b, a[i]) && stars->clear[a[i]]) return true;
    }
    return false;
}

/* Triangles that share a clear vertex are no duplicates, and do not intersect. */
static void check_clear_pairs(const vertex_stars *stars) {
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        const uint32_t *star = stars->mesh->vertex_stars + stars->mesh->vertex_star_offsets[v];
        uint32_t size = stars->mesh->vertex_star_offsets[v + 1] - stars->mesh->vertex_star_offsets[v];
        for (uint32_t i = 0; stars->clear[v] && i < size; i++) {
            for (uint32_t j = i + 1; j < size; j++) {
                const uint32_t *a = corners_of(star[i]), *b = corners_of(star[j]);
                assert_true(count_common(a, b) < 3);
                assert_false(triangles_intersect(a, b, s.x0));
            }
        }
    }
}

/* Asks two cursors, each for a part of the vertices. */
static void check_listed_pairs(const vertex_stars *stars) {
    size_t all = s.triangle_count;
    uint8_t *listed = calloc(all * all, 1);
    uint32_t middle = (uint32_t)random_integer(0, (int)s.vertex_count), pair[2];
    assert_non_null(listed);
    for (int part = 0; part < 2; part++) {
        star_cursor cursor = star_cursor_over(part == 0 ? 0 : middle, part == 0 ? middle : s.vertex_count);
        while (vertex_stars_next_pair(stars, &cursor, pair)) {
            assert_true(pair[0] < pair[1] && pair[1] < all);
            listed[pair[0] * all + pair[1]]++;
        }
        assert_false(vertex_stars_next_pair(stars, &cursor, pair));
    }
    for (uint32_t a = 0; a < all; a++) {
        for (uint32_t b = a + 1; b < all; b++) {
            bool wanted = count_common(corners_of(a), corners_of(b)) > 0 &&
                          !common_vertex_is_clear(stars, corners_of(a), corners_of(b));
            assert_int_equal(listed[a * all + b], wanted);
        }
    }
    free(listed);
}

/* Returns how many vertices are clear; first: the first vertex is. */
static uint32_t check_scene(bool *first) {
    cscd_mesh *mesh;
    vertex_stars stars;
    uint32_t clear = 0, *list = calloc(s.triangle_count, sizeof *list);
    cscd_object_desc desc = cscd_object_of_triangles(s.vertex_count, s.triangle_count, s.triangles);
    assert_non_null(list);
    for (uint32_t t = 0; t < s.triangle_count; t++) list[t] = t;
    expect_ok(cscd_mesh_create(contexts[0], &desc, 1, &mesh));
    expect_ok(vertex_stars_create(mesh, &stars));
    intersection_kernels_of(contexts[0])
        ->sign_normals((const uint32_t(*)[3])mesh->triangles, s.x0, list, s.triangle_count, stars.normals,
                       stars.rises);
    vertex_stars_mark_clear(&stars, 0, s.vertex_count / 2);
    vertex_stars_mark_clear(&stars, s.vertex_count / 2, s.vertex_count);
    check_clear_pairs(&stars);
    check_listed_pairs(&stars);
    for (uint32_t v = 0; v < s.vertex_count; v++) clear += stars.clear[v];
    if (first != NULL) *first = stars.clear[0];
    vertex_stars_destroy(&stars);
    cscd_mesh_destroy(mesh);
    free(list);
    return clear;
}

TEST(any_mesh) {
    uint64_t clear = 0, all = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < (family == SCENE_GRID ? 100 : 5); seed++) {
            scene_make((scene_family)family, 7000 + seed, &s);
            clear += check_scene(NULL);
            all += s.vertex_count;
        }
    }
    print_message("  %llu of %llu vertices are clear\n", (unsigned long long)clear, (unsigned long long)all);
    assert_true(clear * 3 > all);
}

TEST(spheres_are_clear) {
    scene_clear(&s);
    scene_add_sphere(&s, (double[3]){0, 0, 0}, 1.0, 16, 24);
    assert_int_equal(check_scene(NULL), s.vertex_count);
}

/* ---- one star ------------------------------------------------------------------------------------------- */

typedef enum fan_family {
    FAN_AROUND,     /* convex: the rim goes around once */
    FAN_TWICE,      /* the rim goes around twice */
    FAN_TWO_CONES,  /* two rims, both seen from above */
    FAN_ONE_TURNED, /* around once, but one triangle runs the other way */
    FAN_RANDOM,     /* rim points on a small grid */
    FAN_COUNT
} fan_family;

static void set_point(uint32_t vertex, int axis, double x, double y, double z) {
    double *p = s.x0 + (size_t)vertex * 3;
    p[(axis + 1) % 3] = x;
    p[(axis + 2) % 3] = y;
    p[axis] = z;
}

static void set_rim_point(uint32_t vertex, fan_family f, int axis, double angle) {
    double radius = random_between(0.5, 1.0), height = random_between(-0.3, 0.3);
    if (f == FAN_RANDOM)
        set_point(vertex, axis, random_integer(-2, 2), random_integer(-2, 2), random_integer(-1, 1));
    else
        set_point(vertex, axis, radius * cos(angle), radius * sin(angle), height);
}

static void add_triangle(uint32_t a, uint32_t b, uint32_t c, bool turned) {
    const uint32_t corners[3] = {a, turned ? c : b, turned ? b : c};
    int first = random_integer(0, 2);
    for (int i = 0; i < 3; i++) s.triangles[s.triangle_count * 3 + (uint32_t)i] = corners[(first + i) % 3];
    s.triangle_count++;
}

/* Vertex 0 is the tip. */
static void add_rim(fan_family f, int axis, uint32_t size, bool mirrored) {
    uint32_t first = s.vertex_count;
    double turns = f == FAN_TWICE ? 2.0 : 1.0, start = random_between(0.0, 6.0);
    for (uint32_t i = 0; i < size; i++) {
        set_rim_point(first + i, f, axis, start + 6.283185307179586 * turns * i / size);
        add_triangle(0, first + i, first + (i + 1) % size, mirrored != (f == FAN_ONE_TURNED && i == 1));
    }
    s.vertex_count += size;
}

static void make_fan(fan_family f) {
    int axis = random_integer(0, 2);
    bool mirrored = random_integer(0, 1) == 1;
    scene_clear(&s);
    s.vertex_count = 1;
    set_point(0, axis, 0.0, 0.0, f == FAN_RANDOM ? 0.0 : random_between(-0.2, 0.2));
    add_rim(f, axis, (uint32_t)random_integer(f == FAN_TWICE ? 5 : 4, 9), mirrored);
    if (f == FAN_TWO_CONES) add_rim(f, axis, (uint32_t)random_integer(4, 9), mirrored);
}

/* A star that winds twice around its tip intersects itself, although all of its triangles face one way. */
TEST(fans_around_a_tip) {
    uint32_t clear[FAN_COUNT] = {0};
    for (int i = 0; i < 2000; i++) {
        for (fan_family f = FAN_AROUND; f < FAN_COUNT; f++) {
            bool first;
            make_fan(f);
            check_scene(&first);
            clear[f] += first;
        }
    }
    print_message("  clear of 2000: %u around, %u random\n", clear[FAN_AROUND], clear[FAN_RANDOM]);
    assert_true(clear[FAN_AROUND] > 1000 && clear[FAN_RANDOM] > 50);
    assert_int_equal(clear[FAN_TWICE] + clear[FAN_TWO_CONES] + clear[FAN_ONE_TURNED], 0);
}

AROUND_EACH(seed_random, NULL)
AROUND_ALL(open_levels, close_levels)
