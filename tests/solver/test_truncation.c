/* Truncated motions: what was apart stays apart on the way, by the exact tests of a step and by rational numbers. */
#include "runtime/solver/near_pairs.h"
#include "runtime/solver/solver.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/solver/exact_distance.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double points[4][3];

static scene interval; /* large; one test at a time */
static double end[SCENE_VERTICES_MAX * 3];
static bool stays[SCENE_VERTICES_MAX]; /* a pair at x0 holds the vertex */

static cscd_stencil stencil_of(const rig *r, const cscd_proximity *p) {
    return stencil_of_item(r->mesh, p);
}

static void load_points(const cscd_stencil *s, const double *x, points out) {
    for (int i = 0; i < 4; i++) memcpy(out[i], x + (size_t)s->vertices[i] * 3, sizeof out[i]);
}

/* ---- scenes -------------------------------------------------------------------------------------------- */

static void make_stored(cscd_scalar scalar, double offset) {
    for (size_t i = 0; i < (size_t)interval.vertex_count * 3; i++) {
        interval.x0[i] += offset;
        interval.x1[i] += offset;
        if (scalar == CSCD_SCALAR_DOUBLE) continue;
        interval.x0[i] = (double)(float)interval.x0[i];
        interval.x1[i] = (double)(float)interval.x1[i];
    }
}

/* Vertices that pairs without a plane hold stay in place. */
static size_t note_held(const rig *r, const cscd_truncation *out) {
    memset(stays, 0, sizeof stays);
    for (size_t i = 0; i < out->held_count; i++) {
        cscd_stencil s = stencil_of(r, &out->held[i]);
        for (int j = 0; j < 4; j++) stays[s.vertices[j]] = true;
        assert_true(out->held[i].count == 1 && out->held[i].weight == 1.0);
    }
    for (uint32_t v = 0; v < interval.vertex_count; v++)
        if (stays[v])
            assert_memory_equal(end + (size_t)v * 3, interval.x0 + (size_t)v * 3, sizeof(double[3]));
    return out->held_count;
}

/* Every vertex is stored, has gone straight on, and not too far. */
static void check_vertices(double radius, cscd_scalar scalar, const cscd_truncation *out) {
    bool moved = false;
    uint32_t reached = 0;
    for (uint32_t v = 0; v < interval.vertex_count; v++) {
        const double *x0 = interval.x0 + (size_t)v * 3, *x1 = interval.x1 + (size_t)v * 3,
                     *x = end + (size_t)v * 3;
        assert_true(points_within(x, x0, 0.5 * radius));
        double way = 0.0, gone = 0.0, size = 0.0, off = 0.0;
        for (int k = 0; k < 3; k++) {
            way += (x1[k] - x0[k]) * (x1[k] - x0[k]);
            gone += (x[k] - x0[k]) * (x1[k] - x0[k]);
            size = fmax(size, fabs(x0[k]) + fabs(x1[k]));
            if (scalar == CSCD_SCALAR_FLOAT) assert_true((double)(float)x[k] == x[k]);
            moved = moved || x[k] != x0[k];
        }
        double share = way > 0.0 ? gone / way : 0.0;
        for (int k = 0; k < 3; k++) off = fmax(off, fabs(x[k] - x0[k] - share * (x1[k] - x0[k])));
        assert_true(off <= size * (scalar == CSCD_SCALAR_FLOAT ? 0x1p-23 : 0x1p-50));
        reached += memcmp(x, x1, sizeof(double[3])) == 0;
    }
    assert_true(moved == out->moved);
    assert_true(out->shortened + reached >= interval.vertex_count);
}

/* Exact steps see contacts of pairs that touch at x0 and stay, and no others. */
static void check_no_contact(const cscd_truncation *out) {
    static scene way;
    way = interval;
    memcpy(way.x1, end, sizeof end);
    rig exact = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_contacts found = rig_step(&exact, &way);
    for (size_t i = 0; i < found.count; i++) {
        const cscd_contact *c = &found.items[i];
        cscd_stencil s = cscd_mesh_stencil(exact.mesh, c->kind, c->a, c->b, c->u, c->v);
        assert_true(out->held_count > 0 && c->toi == 0.0);
        for (int j = 0; j < 4; j++) assert_true(stays[s.vertices[j]]);
    }
    rig_destroy(&exact);
}

/* A pair that was farther apart than the separation is so at the end; one that was not has come no nearer. */
static void check_separation(const rig *r, double apart, double radius) {
    cscd_proximities near;
    expect_ok(find_near_packed(r->detector, interval.x0, radius + apart, &near));
    for (size_t i = 0; i < near.count; i++) {
        const cscd_proximity *p = &near.items[i];
        cscd_stencil s = stencil_of(r, p);
        points x0, x1;
        load_points(&s, interval.x0, x0);
        load_points(&s, end, x1);
        if (distance_sign_of_sum(p->kind, (const double(*)[3])x0, apart, 0.0, 1.0) > 0)
            assert_true(distance_sign_of_sum(p->kind, (const double(*)[3])x1, apart, 0.0, 1.0) > 0);
        else
            assert_true(distance_sign_of_sum(p->kind, (const double(*)[3])x1, p->distance * (1.0 - 1e-6), 0.0,
                                             1.0) >= 0);
    }
}

TEST(truncated_motions_keep_pairs_apart) {
    static const double radii[] = {0.03, 0.1, 0.3};
    size_t held = 0, shortened = 0, moved = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 6; seed++) {
            scene_make((scene_family)family, seed, &interval);
            cscd_scalar scalar = seed % 2 == 0 ? CSCD_SCALAR_DOUBLE : CSCD_SCALAR_FLOAT;
            make_stored(scalar, seed == 5 ? 1000.0 : 0.0);
            double radius = radii[seed / 2], apart = seed % 3 == 0 ? 0.0 : 0.1 * radius;
            rig r = rig_apart(&interval, apart, CSCD_METHOD_NONE, 1);
            cscd_truncation out = truncate_scene(&r, &interval, radius, scalar, end);
            held += note_held(&r, &out);
            check_vertices(radius, scalar, &out);
            check_no_contact(&out);
            if (seed < 4) check_separation(&r, apart, radius);
            shortened += out.shortened;
            moved += out.moved;
            rig_destroy(&r);
        }
    }
    assert_true(held > 20 && shortened > 3000 && moved > 60);
}

/* Random motions, again and again from where the last one ended: nothing ever touches, and nothing gets stuck. */
TEST(a_march_never_touches) {
    random_seed(3);
    for (int scalar_of = 0; scalar_of < 2; scalar_of++) {
        cscd_scalar scalar = (cscd_scalar)scalar_of;
        scene_make(SCENE_BENT_CAPSULE, 7, &interval);
        make_stored(scalar, scalar == CSCD_SCALAR_FLOAT ? 1000.0 : 0.0);
        rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
        size_t size = (size_t)interval.vertex_count * 3;
        double travelled = 0.0;
        for (int step = 0; step < 60; step++) {
            for (size_t i = 0; i < size; i++) {
                interval.x1[i] = interval.x0[i] + 0.03 * random_unit();
                if (scalar == CSCD_SCALAR_FLOAT) interval.x1[i] = (double)(float)interval.x1[i];
            }
            cscd_truncation out = truncate_scene(&r, &interval, 0.1, scalar, end);
            note_held(&r, &out);
            assert_int_equal(out.held_count, 0);
            check_no_contact(&out);
            for (size_t i = 0; i < size; i++) travelled += fabs(end[i] - interval.x0[i]);
            memcpy(interval.x0, end, size * sizeof *end);
        }
        assert_true(travelled > 0.9 * 60.0 * (double)size * 0.015);
        rig_destroy(&r);
    }
}

/* Lemma 4: where each vertex goes as far as it may, a's lie above b's by more than the separation or, where they were not,
 * by no less than they did. */
static void check_plane(const division_plane *plane, double apart) {
    long double low = INFINITY, high = -INFINITY, low_before = INFINITY, high_before = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const double *x = interval.x0 + (size_t)plane->vertices[i] * 3;
        const double *origin = interval.x0 + (size_t)plane->vertices[0] * 3;
        long double height = 0.0L;
        for (int k = 0; k < 3; k++)
            height += (long double)plane->normal[k] * ((long double)x[k] - (long double)origin[k]);
        assert_true(plane->room[i] >= 0.0);
        bool of_a = division_sign(plane, i) < 0.0;
        if (of_a) low = fminl(low, height - plane->room[i]), low_before = fminl(low_before, height);
        if (!of_a) high = fmaxl(high, height + plane->room[i]), high_before = fmaxl(high_before, height);
    }
    bool pressed = low_before - high_before <= apart + 0x1p-40L;
    assert_true(pressed ? low - high >= low_before - high_before - 0x1p-44L : low - high > apart);
    assert_true(low > high);
}

TEST(planes_divide_near_pairs) {
    static size_t first[SCENE_VERTICES_MAX];
    size_t divided = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 1, &interval);
        rig r = rig_apart(&interval, 0.01, CSCD_METHOD_NONE, 1);
        cscd_proximities near;
        expect_ok(proximity_find(r.detector, interval.x0, 0.26, CSCD_NEAR_PAIRS, &near));
        const near_rules rules = {r.mesh, &r.detector->config};
        const division_quest quest = {interval.x0, interval.x1, 0.125, &near};
        division_planes planes = {.planes = calloc(near.count + 1, sizeof *planes.planes), .first = first};
        division_planes_find(&rules, &quest, &planes);
        for (size_t i = 0; i < planes.count; i++) {
            if (planes.planes[i].room[0] < 0.0) continue;
            check_plane(&planes.planes[i], 0.01);
            divided++;
        }
        free(planes.planes);
        rig_destroy(&r);
    }
    assert_true(divided > 1000);
}

/* ---- how much may move --------------------------------------------------------------------------------- */

static void move_triangle(uint32_t which, double by) {
    for (uint32_t i = 3 * which; i < 3 * which + 3; i++) interval.x1[3 * i + 2] = interval.x0[3 * i + 2] + by;
}

/* The room between two sides goes to whoever needs it, down to the separation. */
TEST(room_goes_to_whoever_needs_it) {
    static const double wanted[][2] = {{0.0, -1.0}, {1.0, 0.0}, {0.2, -0.6}, {-0.5, -0.4}, {0.05, -0.02}};
    static const double gone[][2] = {
        {0.0, -0.15}, {0.15, 0.0}, {0.0375, -0.1125}, {-0.5, -0.15}, {0.05, -0.02}};
    for (int i = 0; i < 5; i++) {
        scene_two_triangles(&interval, 0.25);
        move_triangle(0, wanted[i][0]);
        move_triangle(1, wanted[i][1]);
        rig r = rig_apart(&interval, 0.1, CSCD_METHOD_NONE, 1);
        cscd_truncation out = truncate_scene(&r, &interval, 2.0, CSCD_SCALAR_DOUBLE, end);
        for (uint32_t v = 0; v < 6; v++)
            assert_true(fabs(end[3 * v + 2] - interval.x0[3 * v + 2] - gone[i][v / 3]) <= 1e-6);
        assert_int_equal(out.shortened, i < 2 ? 3 : i == 2 ? 6 : i == 3 ? 3 : 0);
        if (i == 4) assert_memory_equal(end, interval.x1, 18 * sizeof *end);
        rig_destroy(&r);
    }
}

/* Pairs within the separation may part, and come no nearer. */
TEST(pressed_pairs_may_part) {
    for (int i = 0; i < 2; i++) {
        scene_two_triangles(&interval, 0.05);
        move_triangle(1, i == 0 ? 0.5 : -0.01);
        rig r = rig_apart(&interval, 0.1, CSCD_METHOD_NONE, 1);
        cscd_truncation out = truncate_scene(&r, &interval, 2.0, CSCD_SCALAR_DOUBLE, end);
        assert_int_equal(out.held_count, 0);
        assert_true(out.moved == (i == 0));
        assert_memory_equal(end, i == 0 ? interval.x1 : interval.x0, 18 * sizeof *end);
        rig_destroy(&r);
    }
}

/* Pairs that touch stay, and are listed. */
TEST(touching_pairs_are_held) {
    scene_two_triangles(&interval, 0.0);
    move_triangle(1, 0.5);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_truncation out = truncate_scene(&r, &interval, 2.0, CSCD_SCALAR_DOUBLE, end);
    assert_true(out.held_count > 0 && !out.moved && out.fraction == 0.0 && out.shortened == 3);
    assert_memory_equal(end, interval.x0, 18 * sizeof *end);
    rig_destroy(&r);
}

/* An obstacle gets its way as far as the gap allows; cloth has the rest. */
TEST(obstacles_come_first) {
    static const uint32_t triangle[] = {0, 1, 2};
    for (uint32_t obstacle = 0; obstacle < 2; obstacle++) {
        scene_two_triangles(&interval, 0.25);
        move_triangle(0, 0.2);
        move_triangle(1, -0.2);
        cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                       cscd_object_of_triangles(3, 1, triangle)};
        objects[obstacle].obstacle = true;
        rig r = rig_of_objects(context_of(0, NULL), objects, 2, NULL, NULL);
        cscd_truncation out = truncate_scene(&r, &interval, 1.0, CSCD_SCALAR_DOUBLE, end);
        assert_true(out.obstacle_fraction == 1.0 && fabs(out.fraction - 0.25) < 1e-5);
        assert_int_equal(out.shortened, 3);
        assert_memory_equal(end + obstacle * 9, interval.x1 + obstacle * 9, 9 * sizeof *end);
        rig_destroy(&r);
    }
}

/* Nothing is near, but what is farther away has not been looked for. */
TEST(alone_it_goes_half_of_the_radius) {
    scene_two_triangles(&interval, 5.0);
    move_triangle(1, 1.5);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_truncation out = truncate_scene(&r, &interval, 1.0, CSCD_SCALAR_DOUBLE, end);
    assert_true(out.near_count == 0 && out.shortened == 3 && fabs(out.fraction - 1.0 / 3.0) < 1e-9);
    for (uint32_t v = 3; v < 6; v++) assert_true(fabs(end[3 * v + 2] - interval.x0[3 * v + 2] - 0.5) < 1e-9);
    rig_destroy(&r);
}

/* Two sewn triangles fall, and only one of them onto something: sewn vertices stay on each other, bit for bit. */
TEST(sewn_vertices_stay_together) {
    static const uint32_t seams[] = {4, 1, 2, 3};
    static const double corners[9][3] = {{0.0, 1.0, 0.1},   {-1.0, 0.3, 0.4}, {1.0, 0.1, 0.2},
                                         {1.0, 0.1, 0.2},   {-1.0, 0.3, 0.4}, {0.1, -1.0, 0.1},
                                         {-3.0, -0.9, 0.0}, {3.0, -0.9, 0.0}, {0.0, -4.0, 0.0}};
    interval.vertex_count = 9;
    interval.triangle_count = 3;
    random_seed(5);
    for (int i = 0; i < 200; i++) {
        cscd_scalar scalar = (cscd_scalar)(i % 2);
        for (uint32_t v = 0; v < 9; v++) {
            interval.triangles[v] = v;
            for (uint32_t k = 0; k < 3; k++) {
                double step = v < 6 ? 0.3 * random_unit() : 0.0;
                bool mirrored = v >= 6 && k == 1 && i / 2 % 2 == 1; /* below the other triangle */
                interval.x0[3 * v + k] = mirrored ? -corners[v][k] : corners[v][k];
                interval.x1[3 * v + k] = interval.x0[3 * v + k] + step - (k == 2 && v < 6 ? 0.4 : 0.0);
            }
        }
        memcpy(interval.x1 + 9, interval.x1 + 6, sizeof(double[3]));
        memcpy(interval.x1 + 12, interval.x1 + 3, sizeof(double[3]));
        make_stored(scalar, 0.0);
        cscd_detector_options options = cscd_detector_defaults();
        options.seams = seams;
        options.seam_count = 2;
        rig r = rig_create(&interval, 1, &options);
        cscd_truncation out = truncate_scene(&r, &interval, 3.0, scalar, end);
        assert_true(out.moved && out.held_count == 0 && out.shortened > 0);
        assert_memory_equal(end + 9, end + 6, sizeof(double[3]));
        assert_memory_equal(end + 12, end + 3, sizeof(double[3]));
        rig_destroy(&r);
    }
}
