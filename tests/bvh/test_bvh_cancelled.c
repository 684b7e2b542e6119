/* A call that is cancelled while it builds trees ends there, leaves none, and may be repeated. */
#include "runtime/detector/detector.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

static scene shape; /* large; one test at a time */

typedef struct place_counter {
    uint32_t asked, cancel_at; /* asked counts from 1; 0: never */
} place_counter;

static bool count_asked(void *user, const char *stage, double fraction) {
    place_counter *h = user;
    (void)stage, (void)fraction;
    return ++h->asked != h->cancel_at;
}

static cscd_context *create_context(place_counter *h) {
    cscd_context *context = NULL;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 1;
    options.progress = (cscd_progress){count_asked, h};
    assert_int_equal(cscd_context_create(&options, &context), CSCD_OK);
    context->progress.interval_ms = 0.0; /* asks whenever it can */
    return context;
}

static cscd_detector *create_detector(cscd_context *context, cscd_mesh **mesh) {
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    const cscd_object_desc desc =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, shape.triangles);
    options.method = CSCD_METHOD_SINGLE;
    assert_int_equal(cscd_mesh_create(context, &desc, 1, mesh), CSCD_OK);
    assert_int_equal(detector_create_here(*mesh, NULL, &options, &detector), CSCD_OK);
    return detector;
}

static void compare_lists(const cscd_contacts *found, const cscd_contacts *expected) {
    assert_int_equal(found->count, expected->count);
    if (found->count > 0)
        assert_memory_equal(found->items, expected->items, found->count * sizeof *found->items);
}

/* A pleated strip that is pulled flat: at first its layers lie on each other, so leaves hold triangles of several layers, and
 * some later step builds its trees again. */
enum { ROWS = 4, COLUMNS = 200, PLEAT = 8, STEPS = 40 };

static void make_strip(void) {
    scene_clear(&shape);
    shape.vertex_count = (ROWS + 1) * (COLUMNS + 1);
    for (uint32_t i = 0; i < COLUMNS * ROWS; i++) {
        const uint32_t corner = i / ROWS * (ROWS + 1) + i % ROWS, next = corner + ROWS + 1;
        const uint32_t made[6] = {corner, next, next + 1, corner, next + 1, corner + 1};
        memcpy(shape.triangles + 6 * i, made, sizeof made);
    }
    shape.triangle_count = 2 * COLUMNS * ROWS;
}

static void pull_strip(uint32_t step, double *out) {
    const double angle = 0.5 * acos(-1.0) * (1.0 - (double)step / STEPS) * 0.98;
    double x = 0.0, z = 0.0;
    for (uint32_t i = 0; i < shape.vertex_count; i++) {
        const uint32_t column = i / (ROWS + 1);
        out[3 * i] = x;
        out[3 * i + 1] = i % (ROWS + 1);
        out[3 * i + 2] = z;
        if (i % (ROWS + 1) != ROWS) continue;
        x += cos(angle);
        z += column / PLEAT % 2 == 0 ? sin(angle) : -sin(angle);
    }
}

/* A detector whose every step is cancelled at each place first finds what another one finds, also when trees are built again. */
TEST(rebuilds_may_be_cancelled_anywhere) {
    static double x[2][SCENE_VERTICES_MAX * 3];
    place_counter h = {0, 0};
    cscd_context *context = create_context(&h);
    cscd_mesh *mesh = NULL, *other = NULL;
    cscd_contacts expected, found;
    uint32_t rebuilds = 0;
    make_strip();
    cscd_detector *whole = create_detector(context, &mesh), *detector = create_detector(context, &other);
    for (uint32_t step = 0; step < STEPS; step++) {
        pull_strip(step, x[0]);
        pull_strip(step + 1, x[1]);
        h = (place_counter){0, 0};
        assert_int_equal(step_packed(whole, x[0], x[1], &expected), CSCD_OK);
        rebuilds += whole->rebuild.rebuilt;
        for (uint32_t at = 1; at < 8; at++) {
            h = (place_counter){0, at};
            cscd_status status = step_packed(detector, x[0], x[1], &found);
            assert_true(status == CSCD_CANCELLED || status == CSCD_OK);
            if (status == CSCD_OK) break;
        }
        h = (place_counter){0, 0};
        assert_int_equal(step_packed(detector, x[0], x[1], &found), CSCD_OK);
        compare_lists(&found, &expected);
    }
    print_message("  %u rebuilds\n", (unsigned)rebuilds);
    assert_true(rebuilds > 0);
    cscd_detector_destroy(whole);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_mesh_destroy(other);
    cscd_context_destroy(context);
}
