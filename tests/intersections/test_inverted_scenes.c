/* What is said of a random scene is said of it with some of its components turned inside out, too. */
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = NIGHTLY(15, 60) };

static body_rig rig, twin; /* large */

static double greatest_depth(const body_rig *r) {
    double most = -1.0;
    for (size_t i = 0; i < r->found.depths->count; i++) most = fmax(most, r->found.depths->items[i].depth);
    return most;
}

static void add_box(double size) {
    const double low[3] = {0, 0, 0}, sizes[3] = {size, size, size};
    body_rig_add_box(&rig, low, sizes);
}

/* The scenes differ in the order of corners alone, so vertices are the same ones. */
static void compare_answers(void) {
    const cscd_depths *a = rig.found.depths, *b = twin.found.depths;
    assert_int_equal(rig.found.count, twin.found.count);
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->vertex_count; i++) {
        assert_int_equal(a->items[i].vertex, b->items[i].vertex);
        assert_int_equal(a->items[i].body, b->items[i].body);
        assert_true(fabs(a->items[i].depth - b->items[i].depth) < 1e-12);
    }
    assert_true(fabs(greatest_depth(&rig) - greatest_depth(&twin)) <=
                0.01 * fabs(greatest_depth(&rig)) + 1e-5);
    assert_int_equal(rig.found.patches->count, twin.found.patches->count);
    for (uint32_t v = 0; v < rig.all.vertex_count; v++) {
        uint32_t p = rig.found.patches->vertex_patches[v], q = twin.found.patches->vertex_patches[v];
        assert_int_equal(p == UINT32_MAX, q == UINT32_MAX);
        if (p == UINT32_MAX) continue;
        assert_int_equal(rig.found.patches->items[p].own, twin.found.patches->items[q].own);
        assert_int_equal(rig.found.patches->items[p].winding_count,
                         twin.found.patches->items[q].winding_count);
    }
    assert_int_equal(rig.found.overlaps->count, twin.found.overlaps->count);
    for (size_t i = 0; i < rig.found.overlaps->count; i++) {
        const cscd_overlap *p = &rig.found.overlaps->items[i], *q = &twin.found.overlaps->items[i];
        assert_true(p->a == q->a && p->b == q->b && fabs(p->area_a - q->area_a) < 1e-10 &&
                    fabs(p->area_b - q->area_b) < 1e-10 && fabs(p->volume - q->volume) < 1e-10);
    }
}

/* Adds a ball, a box, a capsule or a body that passes through itself to what will be a body. */
static void add_any(random_stream *random) {
    uint32_t first = rig.all.vertex_count;
    double by[3];
    for (int k = 0; k < 3; k++) by[k] = stream_between(random, -0.7, 0.7);
    uint32_t shape = stream_below(random, first == 0 ? 4 : 3); /* one snake is long enough */
    switch (shape) {
    case 0:
        scene_add_sphere(&rig.all, (const double[3]){0, 0, 0}, stream_between(random, 0.2, 1), 4, 6);
        break;
    case 1:
        add_box(stream_between(random, 0.2, 1));
        break;
    case 2:
        scene_add_capsule(&rig.all, 2.0, 0.2, 5, 5);
        break;
    default:
        body_rig_add_snake(&rig);
        break;
    }
    double angle = stream_between(random, 0, 6), c = cos(angle), s = sin(angle);
    for (uint32_t v = first; v < rig.all.vertex_count; v++) {
        double *x = rig.all.x0 + (size_t)v * 3, given[3];
        memcpy(given, x, sizeof given);
        x[0] = c * given[0] - s * given[1] + by[0];
        x[1] = s * given[0] + c * given[1] + by[1];
        x[2] = given[2] + by[2];
    }
}

/* Each component is an object, or a part of one of two. */
TEST(inverted_scenes_have_the_same_answers) {
    for (uint32_t round = 0; round < ROUNDS; round++) {
        random_stream random = stream_start(round);
        bool parts = round % 2 == 1;
        static uint32_t labels[SCENE_TRIANGLES_MAX], begins[BODIES_MAX + 1];
        uint32_t count = 2 + stream_below(&random, 2);
        body_rig_begin(&rig);
        for (uint32_t i = 0; i < count; i++) {
            begins[i] = rig.all.triangle_count;
            add_any(&random);
            for (uint32_t t = begins[i]; t < rig.all.triangle_count; t++) labels[t] = i;
            if (!parts || i == 0 || i + 1 == count) body_rig_end_body(&rig);
        }
        begins[count] = rig.all.triangle_count;
        twin = rig;
        for (uint32_t i = 0; i < count; i++) {
            if (stream_below(&random, 2) == 1) body_rig_turn(&twin, begins[i], begins[i + 1] - begins[i]);
        }
        body_rig_create(&rig, NULL, 2);
        body_rig_create(&twin, NULL, 1);
        if (parts) {
            rig.orientation = twin.orientation = CSCD_ORIENTATION_BY_PART;
            expect_ok(cscd_detector_set_parts(rig.detector, labels, count));
            expect_ok(cscd_detector_set_parts(twin.detector, labels, count));
        }
        body_rig_find(&rig);
        body_rig_find(&twin);
        compare_answers();
        body_rig_free(&rig);
        body_rig_free(&twin);
    }
}

AROUND_EACH(NULL, body_rigs_free)
