/* Answers about surfaces in general position: scaled, moved and renumbered scenes have the same ones, curves run as their
 * normals say, patches have the numbers that solid angles give them, and volumes add up. */
#include "src/core/vec3.h"
#include "src/mesh/surface.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static body_rig rig, other; /* large; one test at a time */

/* Coordinates are multiples of 2^-30 below 8, so that they can be moved and scaled without rounding. */
static void add_scene(body_rig *r, uint64_t seed) {
    static const double origin[3] = {0, 0, 0}, centre[3] = {0.9, 0.2, 0.1}, beside[3] = {-0.9, 0.1, 0.2};
    random_stream random = stream_start(seed);
    body_rig_begin(r);
    body_rig_add_snake(r);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, centre, 0.6, 9, 14);
    body_rig_end_body(r);
    scene_add_torus(&r->all, origin, 1.0, 0.35, 24, 12, true);
    body_rig_end_body(r);
    scene_add_sphere(&r->all, beside, 0.5, 7, 10);
    body_rig_end_body(r);
    for (uint32_t i = 0; i < 3 * r->all.vertex_count; i++)
        r->all.x0[i] = rint((r->all.x0[i] + stream_between(&random, -0x1p-9, 0x1p-9)) * 0x1p30) * 0x1p-30;
}

/* ---- scales and places ----------------------------------------------------------------------------------- */

static void expect_scaled(const double *a, const double *b, int count, double scale) {
    for (int i = 0; i < count; i++) assert_true(a[i] * scale == b[i]);
}

static void compare_curves(const cscd_curves *a, const cscd_curves *b, double scale, const double move[3]) {
    assert_int_equal(a->count, b->count);
    assert_int_equal(a->piece_count, b->piece_count);
    assert_memory_equal(a->pieces, b->pieces, a->piece_count * sizeof *a->pieces);
    for (size_t i = 0; i < a->count && move == NULL; i++)
        expect_scaled(&a->items[i].length, &b->items[i].length, 1, scale);
    for (size_t i = 0; i < a->point_count; i++) {
        const cscd_curve_point *p = &a->points[i], *q = &b->points[i];
        assert_true(p->edge == q->edge && p->triangle == q->triangle);
        assert_true(p->s == q->s && p->u == q->u && p->v == q->v);
        if (move == NULL) expect_scaled(p->x, q->x, 3, scale);
        for (int k = 0; move != NULL && k < 3; k++) assert_true(fabs(p->x[k] + move[k] - q->x[k]) <= 0x1p-40);
    }
}

static void compare_patches(const cscd_patches *a, const cscd_patches *b) {
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->items, b->items, a->count * sizeof *a->items);
    assert_int_equal(a->winding_count, b->winding_count);
    assert_memory_equal(a->windings, b->windings, a->winding_count * sizeof *a->windings);
}

/* Down to where squares of lengths vanish and up to where they overflow, let alone squares of areas. */
TEST(scales_change_no_bit) {
    static const int exponents[] = {-269, -200, -130, 40, 250, 297};
    add_scene(&rig, 1);
    body_rig_create(&rig, NULL, 2);
    body_rig_find(&rig);
    const cscd_intersections *a = &rig.found, *b = &other.found;
    assert_true(a->curves->count > 4 && a->depths->count > 100 && a->depths->count > a->depths->vertex_count);
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        double scale = ldexp(1.0, exponents[i]);
        add_scene(&other, 1);
        for (uint32_t k = 0; k < 3 * other.all.vertex_count; k++) other.all.x0[k] *= scale;
        body_rig_create(&other, NULL, 1);
        body_rig_find(&other);
        compare_curves(a->curves, b->curves, scale, NULL);
        compare_patches(a->patches, b->patches);
        assert_int_equal(a->overlaps->count, b->overlaps->count);
        for (size_t k = 0; k < a->overlaps->count; k++) {
            const cscd_overlap *p = &a->overlaps->items[k], *q = &b->overlaps->items[k];
            expect_scaled(&p->area_a, &q->area_a, 1, scale * scale);
            expect_scaled(&p->area_b, &q->area_b, 1, scale * scale);
            expect_scaled(&p->volume, &q->volume, 1, scale * scale * scale);
        }
        assert_int_equal(a->depths->count, b->depths->count);
        for (size_t k = 0; k < a->depths->count; k++) {
            const cscd_depth *p = &a->depths->items[k], *q = &b->depths->items[k];
            assert_true(p->vertex == q->vertex && p->edge == q->edge && p->body == q->body);
            assert_true(p->triangle == q->triangle && p->s == q->s);
            expect_scaled(&p->depth, &q->depth, 1, scale);
            expect_scaled(p->direction, q->direction, 3, 1.0);
        }
    }
}

TEST(places_change_nothing) {
    static const double move[3] = {1024, -2048, 512};
    add_scene(&rig, 2);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    add_scene(&other, 2);
    for (uint32_t k = 0; k < 3 * other.all.vertex_count; k++) other.all.x0[k] += move[k % 3];
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    compare_curves(rig.found.curves, other.found.curves, 1.0, move);
    compare_patches(rig.found.patches, other.found.patches);
    for (size_t k = 0; k < rig.found.overlaps->count; k++)
        assert_true(fabs(rig.found.overlaps->items[k].volume - other.found.overlaps->items[k].volume) <
                    1e-11);
    const cscd_depths *depths = rig.found.depths;
    assert_int_equal(depths->count, other.found.depths->count);
    for (size_t k = 0; k < depths->count;
         k++) { /* those of faces are found up to a hundredth, or a billionth of the place */
        const double room =
            k < depths->vertex_count + depths->edge_count ? 0.0 : 0.01 * depths->items[k].bound + 2e-6;
        assert_true(fabs(depths->items[k].depth - other.found.depths->items[k].depth) < 1e-11 + room);
    }
}

/* ---- numbering ------------------------------------------------------------------------------------------- */

static void shuffle_numbers(random_stream *random, uint32_t *out, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = stream_below(random, i + 1);
        out[i] = out[j];
        out[j] = i;
    }
}

static uint32_t new_vertex[SCENE_VERTICES_MAX]; /* of `rig` in `other` */

/* Adds a body of `rig` to `other`, with its triangles and vertices in another order, and its corners turned. */
static void add_shuffled(random_stream *random, uint32_t body) {
    static uint32_t order[SCENE_TRIANGLES_MAX];
    const body_part *b = &rig.bodies[body];
    scene *out = &other.all;
    shuffle_numbers(random, order, b->vertex_count);
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        new_vertex[b->first_vertex + v] = out->vertex_count + order[v];
        memcpy(out->x0 + (size_t)new_vertex[b->first_vertex + v] * 3,
               rig.all.x0 + (size_t)(b->first_vertex + v) * 3, sizeof(double[3]));
    }
    out->vertex_count += b->vertex_count;
    shuffle_numbers(random, order, b->triangle_count);
    for (uint32_t t = 0; t < b->triangle_count; t++) {
        const uint32_t *corners = rig.all.triangles + (size_t)(b->first_triangle + order[t]) * 3;
        uint32_t turn = stream_below(random, 3);
        for (uint32_t i = 0; i < 3; i++)
            out->triangles[out->triangle_count * 3 + i] = new_vertex[corners[(i + turn) % 3]];
        out->triangle_count++;
    }
    body_rig_end_body(&other);
}

static int compare_places(const void *a, const void *b) {
    const cscd_curve_point *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->x[k] != q->x[k]) return p->x[k] < q->x[k] ? -1 : 1;
    return 0;
}

static void compare_points(const cscd_curves *a, const cscd_curves *b) {
    assert_int_equal(a->point_count, b->point_count);
    size_t size = a->point_count * sizeof *a->points;
    cscd_curve_point *p = malloc(size), *q = malloc(size);
    assert_true(p != NULL && q != NULL);
    memcpy(p, a->points, size);
    memcpy(q, b->points, size);
    qsort(p, a->point_count, sizeof *p, compare_places);
    qsort(q, a->point_count, sizeof *q, compare_places);
    for (size_t i = 0; i < a->point_count; i++) assert_int_equal(compare_places(&p[i], &q[i]), 0);
    free(p);
    free(q);
}

static const cscd_depth *find_depth(const cscd_depths *depths, uint32_t vertex, uint32_t object) {
    for (size_t i = 0; i < depths->vertex_count; i++) {
        if (depths->items[i].vertex == vertex && depths->items[i].body == object) return &depths->items[i];
    }
    fail();
    return NULL;
}

static void compare_overlap(cscd_overlap a, cscd_overlap b, bool turned) {
    assert_true(fabs(a.volume - b.volume) < 1e-12);
    assert_true(fabs(a.area_a - (turned ? b.area_b : b.area_a)) < 1e-12);
    assert_true(fabs(a.area_b - (turned ? b.area_a : b.area_b)) < 1e-12);
}

/* Objects, triangles and vertices in another order have the same points, and the same numbers to go with them. */
TEST(numbers_mean_nothing) {
    static const uint32_t objects[4] = {2, 0, 3, 1}, places[4] = {1, 3, 0, 2};
    random_stream random = stream_start(3);
    add_scene(&rig, 3);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
    body_rig_begin(&other);
    for (int i = 0; i < 4; i++) add_shuffled(&random, objects[i]);
    body_rig_create(&other, NULL, 1);
    body_rig_find(&other);
    const cscd_intersections *a = &rig.found, *b = &other.found;
    assert_int_equal(a->curves->count, b->curves->count);
    assert_int_equal(a->patches->count, b->patches->count);
    compare_points(a->curves, b->curves);
    assert_int_equal(a->overlaps->count, b->overlaps->count);
    for (size_t i = 0; i < a->overlaps->count; i++) {
        cscd_overlap p = a->overlaps->items[i];
        uint32_t q[2] = {places[p.a], places[p.b]};
        bool turned = q[0] > q[1];
        compare_overlap(p, body_rig_overlap(&other, q[turned], q[!turned]), turned);
    }
    assert_int_equal(a->depths->count, b->depths->count);
    for (size_t i = 0; i < a->depths->vertex_count; i++) {
        const cscd_depth *p = &a->depths->items[i];
        const cscd_depth *q = find_depth(b->depths, new_vertex[p->vertex], places[p->body]);
        assert_true(fabs(p->depth - q->depth) < 1e-12);
    }
}

/* ---- what the answers say ---------------------------------------------------------------------------------- */

static void find_scene(uint64_t seed) {
    add_scene(&rig, seed);
    body_rig_create(&rig, NULL, 1);
    body_rig_find(&rig);
}

/* From point to point a curve goes as normal a times normal b. */
TEST(curves_run_as_normals_say) {
    size_t compared = 0;
    find_scene(4);
    const cscd_curves *c = rig.found.curves;
    for (size_t i = 0; i < c->count; i++) {
        const cscd_curve *curve = &c->items[i];
        for (size_t k = 0; k < curve->piece_count; k++) {
            const cscd_curve_piece *piece = &c->pieces[curve->first_piece + k];
            const double *from = c->points[curve->first_point + k].x;
            const double *to = c->points[curve->first_point + (k + 1) % curve->point_count].x;
            double a[3], b[3], along[3], way[3];
            surface_normal(rig.mesh, rig.all.x0, piece->a, a);
            surface_normal(rig.mesh, rig.all.x0, piece->b, b);
            vec3_cross(a, b, along);
            vec3_subtract(to, from, way);
            double length = surface_norm(way), norm = surface_norm(along);
            if (length < 1e-9) continue;
            assert_true(vec3_dot(along, way) > 0.999 * length * norm);
            compared++;
        }
    }
    assert_true(compared > 500);
}

/* How often a body winds around a point, by solid angles (van Oosterom, Strackee 1983). */
static double angle_number(uint32_t body, const double x[3]) {
    const body_part *b = &rig.bodies[body];
    double sum = 0.0;
    for (uint32_t t = b->first_triangle; t < b->first_triangle + b->triangle_count; t++) {
        double p[3][3], length[3], cross[3];
        for (uint32_t i = 0; i < 3; i++) {
            vec3_subtract(surface_corner(rig.mesh, rig.all.x0, t, i), x, p[i]);
            length[i] = surface_norm(p[i]);
        }
        vec3_cross(p[1], p[2], cross);
        double bottom = length[0] * length[1] * length[2] + vec3_dot(p[0], p[1]) * length[2] +
                        vec3_dot(p[1], p[2]) * length[0] + vec3_dot(p[2], p[0]) * length[1];
        sum += 2.0 * atan2(vec3_dot(p[0], cross), bottom);
    }
    return sum / (4.0 * acos(-1.0));
}

static int number_of(const cscd_patch *patch, uint32_t object) {
    for (uint32_t i = 0; i < patch->winding_count; i++) {
        const cscd_winding *w = &rig.found.patches->windings[patch->first_winding + i];
        if (w->body == object) return w->number;
    }
    return 0;
}

/* Above the middle of each whole triangle. */
TEST(numbers_are_solid_angles) {
    size_t wound = 0;
    find_scene(5);
    for (uint32_t t = 0; t < rig.all.triangle_count; t += 3) {
        uint32_t patch = rig.found.patches->triangle_patches[t];
        if (patch == UINT32_MAX) continue;
        double x[3], normal[3];
        surface_normal(rig.mesh, rig.all.x0, t, normal);
        for (int k = 0; k < 3; k++)
            x[k] = (surface_corner(rig.mesh, rig.all.x0, t, 0)[k] +
                    surface_corner(rig.mesh, rig.all.x0, t, 1)[k] +
                    surface_corner(rig.mesh, rig.all.x0, t, 2)[k]) /
                   3.0;
        vec3_add_scaled(x, 1e-7 / surface_norm(normal), normal, x);
        for (uint32_t body = 0; body < rig.body_count; body++) {
            int number = number_of(&rig.found.patches->items[patch], body);
            assert_true(fabs(angle_number(body, x) - number) < 1e-3);
            wound += number != 0;
        }
    }
    assert_true(wound > 50);
}

/* What a body shares with two bodies that are apart it shares with the object of both. */
TEST(volumes_add_up) {
    static const double origin[3] = {0, 0, 0}, centres[2][3] = {{0.91, 0.21, 0.13}, {-0.93, 0.14, 0.22}};
    double sums[2] = {0.0, 0.0}, areas[2] = {0.0, 0.0};
    for (int joined = 0; joined < 2; joined++) {
        body_rig_begin(&rig);
        scene_add_torus(&rig.all, origin, 1.0, 0.35, 24, 12, true);
        body_rig_end_body(&rig);
        for (int i = 0; i < 2; i++) {
            scene_add_sphere(&rig.all, centres[i], 0.5, 9, 14);
            if (i == 1 || joined == 0) body_rig_end_body(&rig);
        }
        body_rig_create(&rig, NULL, 1);
        body_rig_find(&rig);
        assert_int_equal(rig.found.overlaps->count, 2 - joined);
        for (size_t i = 0; i < rig.found.overlaps->count; i++) {
            sums[joined] += rig.found.overlaps->items[i].volume;
            areas[joined] += rig.found.overlaps->items[i].area_a;
        }
    }
    assert_true(sums[0] > 0.1 && fabs(sums[0] - sums[1]) < 1e-13);
    assert_true(areas[0] > 0.1 && fabs(areas[0] - areas[1]) < 1e-12);
}

AROUND_EACH(NULL, body_rigs_free)
