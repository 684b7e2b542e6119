/* Trees that decay over a long deformation are built anew, once, and as the same for any number of threads.
 */
#include "cscd/cscd.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/* A pleated strip that is pulled flat: at first its layers lie on each other, so leaves hold triangles of
 * several of them. */
enum { ROWS = 12, COLUMNS = 320, PLEAT = 8, FRAMES = 80 };
enum { VERTICES = (ROWS + 1) * (COLUMNS + 1), TRIANGLES = ROWS * COLUMNS * 2 };

static uint32_t triangles[TRIANGLES][3];
static double before[VERTICES][3], after[VERTICES][3];

static void make_strip(void) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < COLUMNS * ROWS; i++) {
        uint32_t corner = i / ROWS * (ROWS + 1) + i % ROWS, next = corner + ROWS + 1;
        const uint32_t made[2][3] = {{corner, next, next + 1}, {corner, next + 1, corner + 1}};
        memcpy(triangles[count], made, sizeof made);
        count += 2;
    }
}

/* Each column's step makes an angle with the last one at the pleats: closed at 0, flat at 1. */
static void pose(double opened, double out[VERTICES][3]) {
    double angle = 0.5 * acos(-1.0) * (1.0 - opened) * 0.98, x = 0.0, z = 0.0;
    for (uint32_t column = 0; column <= COLUMNS; column++) {
        for (uint32_t row = 0; row <= ROWS; row++) {
            double *p = out[column * (ROWS + 1) + row];
            p[0] = x;
            p[1] = row;
            p[2] = z;
        }
        x += cos(angle);
        z += column / PLEAT % 2 == 0 ? sin(angle) : -sin(angle);
    }
}

typedef struct run {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} run;

static void open_run(run *r, uint32_t threads) {
    cscd_context_options options = cscd_context_defaults();
    cscd_mesh_desc desc = {VERTICES, TRIANGLES, &triangles[0][0]};
    options.thread_count = threads;
    assert_int_equal(cscd_context_create(&options, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, &desc, &r->mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(r->mesh, NULL, NULL, &r->detector), CSCD_OK);
}

static void close_run(run *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static cscd_counters step(run *r) {
    cscd_contacts found;
    assert_int_equal(cscd_detector_step(r->detector, &before[0][0], &after[0][0], &found), CSCD_OK);
    return cscd_detector_counters(r->detector);
}

static void pulled_flat(void **state) {
    run one, three, fresh;
    cscd_counters last = {0};
    uint64_t rebuilds = 0;
    (void)state;
    make_strip();
    open_run(&one, 1);
    open_run(&three, 3);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        pose((double)frame / FRAMES, before);
        pose((frame + 1.0) / FRAMES, after);
        last = step(&one);
        cscd_counters other = step(&three);
        assert_memory_equal(&last, &other, sizeof last);
        rebuilds += last.rebuilds;
    }
    open_run(&fresh, 1);
    cscd_counters best = step(&fresh);
    print_message("built anew %llu times; %llu boxes at the end, %llu with new trees\n",
                  (unsigned long long)rebuilds, (unsigned long long)last.boxes_tested,
                  (unsigned long long)best.boxes_tested);
    assert_in_range(rebuilds, 1, FRAMES / 16);
    assert_int_equal(best.pcp, last.pcp);
    assert_true(last.boxes_tested * 4 <= best.boxes_tested * 5);
    close_run(&one);
    close_run(&three);
    close_run(&fresh);
}

/* What only moves and bends keeps its trees. */
static void flat_stays(void **state) {
    run r;
    (void)state;
    make_strip();
    open_run(&r, 1);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        pose(0.5 + 0.3 * sin(0.2 * frame), before);
        pose(0.5 + 0.3 * sin(0.2 * (frame + 1.0)), after);
        assert_int_equal(step(&r).rebuilds, 0);
    }
    close_run(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulled_flat),
        cmocka_unit_test(flat_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
