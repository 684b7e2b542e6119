/* Trees that decay over a long deformation are rebuilt once, with the same result for any number of
 * threads. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

/* A pleated strip that is pulled flat. At first its layers lie on each other, so leaves hold triangles of
 * several layers. */
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

/* Each column's step makes an angle with the previous one at the pleats: closed at 0, flat at 1. */
static void pose_at(double opened, double out[VERTICES][3]) {
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

typedef struct rebuild_run {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
} rebuild_run;

static void open_run_on(rebuild_run *r, uint32_t threads, cscd_object_desc desc) {
    cscd_context_options options = cscd_context_defaults();
    cscd_detector_options detector_options = cscd_detector_defaults();
    options.thread_count = threads;
    detector_options.method = CSCD_METHOD_NONE; /* so that boxes count what trees are like */
    assert_int_equal(cscd_context_create(&options, &r->context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r->context, &desc, 1, &r->mesh), CSCD_OK);
    assert_int_equal(detector_create_here(r->mesh, NULL, &detector_options, &r->detector), CSCD_OK);
}

static void open_run(rebuild_run *r, uint32_t threads) {
    open_run_on(r, threads, cscd_object_of_triangles(VERTICES, TRIANGLES, &triangles[0][0]));
}

static void close_run(rebuild_run *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static cscd_counters step_run(rebuild_run *r) {
    cscd_contacts found;
    assert_int_equal(step_packed(r->detector, &before[0][0], &after[0][0], &found), CSCD_OK);
    return cscd_detector_counters(r->detector);
}

TEST(pulled_flat) {
    rebuild_run one, three, rebuilt;
    cscd_counters last = {0};
    uint64_t rebuilds = 0;
    make_strip();
    open_run(&one, 1);
    open_run(&three, 3);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        pose_at((double)frame / FRAMES, before);
        pose_at((frame + 1.0) / FRAMES, after);
        last = step_run(&one);
        cscd_counters other = step_run(&three);
        assert_memory_equal(&last, &other, sizeof last);
        rebuilds += last.rebuilds;
    }
    open_run(&rebuilt, 1);
    cscd_counters best = step_run(&rebuilt);
    print_message("built anew %llu times; %llu boxes at the end, %llu with new trees\n",
                  (unsigned long long)rebuilds, (unsigned long long)last.boxes_tested,
                  (unsigned long long)best.boxes_tested);
    assert_in_range(rebuilds, 1, FRAMES / 16);
    assert_int_equal(best.pcp, last.pcp);
    assert_true(last.boxes_tested * 4 <= best.boxes_tested * 5);
    close_run(&one);
    close_run(&three);
    close_run(&rebuilt);
}

/* Line searches alone also rebuild the trees. */
TEST(lines_build_anew) {
    rebuild_run r, rebuilt;
    cscd_line_search *line = NULL;
    make_strip();
    open_run(&r, 1);
    assert_int_equal(cscd_line_search_create(r.detector, &line), CSCD_OK);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        pose_at((double)frame / FRAMES, before);
        pose_at((frame + 1.0) / FRAMES, after);
        assert_int_equal(line_begin_packed(line, &before[0][0], &after[0][0], 0.01), CSCD_OK);
    }
    cscd_counters last = step_run(&r);
    open_run(&rebuilt, 1);
    cscd_counters best = step_run(&rebuilt);
    print_message("%llu boxes, %llu with new trees\n", (unsigned long long)last.boxes_tested,
                  (unsigned long long)best.boxes_tested);
    assert_int_equal(last.rebuilds, 0);
    assert_true(last.boxes_tested * 4 <= best.boxes_tested * 5);
    cscd_line_search_destroy(line);
    close_run(&r);
    close_run(&rebuilt);
}

/* A motion that only moves and bends the strip keeps its trees. */
TEST(flat_stays) {
    rebuild_run r;
    make_strip();
    open_run(&r, 1);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        pose_at(0.5 + 0.3 * sin(0.2 * frame), before);
        pose_at(0.5 + 0.3 * sin(0.2 * (frame + 1.0)), after);
        assert_int_equal(step_run(&r).rebuilds, 0);
    }
    close_run(&r);
}

/* ---- many trees -------------------------------------------------------------------------------------- */

enum { BODIES = 400 };

static uint32_t faces[BODIES * 4][3], places[BODIES];
static double shapes[BODIES][4][3], centres[BODIES][3], rest[BODIES][4][3], moved[BODIES][4][3];

static double unit_noise(random_stream *random) {
    return (double)stream_below(random, 1u << 20) * 0x1p-20;
}

static void make_bodies(void) {
    static const uint32_t of_one[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    random_stream random = stream_start(17);
    for (uint32_t i = 0; i < BODIES; i++) {
        places[i] = i;
        for (int k = 0; k < 12; k++) shapes[i][k / 3][k % 3] = 0.5 * unit_noise(&random);
        for (int k = 0; k < 3; k++) centres[i][k] = 16.0 * unit_noise(&random);
        for (int k = 0; k < 12; k++) faces[4 * i + (uint32_t)k / 3][k % 3] = 4 * i + of_one[k / 3][k % 3];
    }
}

static void place_bodies(double flown, double out[BODIES][4][3]) {
    for (uint32_t i = 0; i < BODIES; i++) {
        for (int k = 0; k < 12; k++)
            out[i][k / 3][k % 3] =
                shapes[i][k / 3][k % 3] + centres[places[i]][k % 3] + (k % 3 == 2 ? flown : 0.0);
    }
}

static cscd_counters step_bodies(rebuild_run *r) {
    cscd_contacts found;
    assert_int_equal(step_packed(r->detector, &rest[0][0][0], &moved[0][0][0], &found), CSCD_OK);
    return cscd_detector_counters(r->detector);
}

/* Bodies that change places put the blocks of the trees into disorder, though no tree changes. */
TEST(bodies_change_places) {
    const cscd_object_desc desc = cscd_object_of_triangles(BODIES * 4, BODIES * 4, &faces[0][0]);
    rebuild_run r, rebuilt;
    make_bodies();
    place_bodies(0.0, rest);
    place_bodies(0.125, moved);
    open_run_on(&r, 1, desc);
    uint64_t at_first = step_bodies(&r).boxes_tested;
    place_bodies(2048.0, moved);
    assert_true(step_bodies(&r).boxes_tested <= at_first + at_first / 20); /* all fly on together */

    random_stream random = stream_start(18);
    for (uint32_t i = BODIES; i > 1; i--) {
        uint32_t j = stream_below(&random, i), place = places[i - 1];
        places[i - 1] = places[j];
        places[j] = place;
    }
    place_bodies(0.0, rest);
    place_bodies(0.125, moved);
    uint64_t in_disorder = step_bodies(&r).boxes_tested;
    for (int i = 0; i < 16; i++) step_bodies(&r);
    open_run_on(&rebuilt, 1, desc);
    uint64_t best = step_bodies(&rebuilt).boxes_tested, afterwards = step_bodies(&r).boxes_tested;
    print_message("%llu boxes, in disorder %llu, afterwards %llu, with new trees %llu\n",
                  (unsigned long long)at_first, (unsigned long long)in_disorder,
                  (unsigned long long)afterwards, (unsigned long long)best);
    assert_true(in_disorder > 2 * best && afterwards <= best + best / 4);
    close_run(&r);
    close_run(&rebuilt);
}
