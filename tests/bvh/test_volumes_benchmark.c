/* The benchmark of bounding volumes, on a small recording: its pairs are those that volumes written out here leave. */
#include "tests/support/models/tiny_recording.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"
#include "tests/support/tool/json_reader.h"
#include "tests/support/tool/run_tool.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS = TINY_FRAMES - 1, KINDS = 5, METHODS = 3, DIRECTIONS = 13, ORIGIN_SAMPLES = 64 };

static temp_folder folder;
static body shape;

static int make_folder(void **state) {
    (void)state;
    folder = temp_folder_make();
    shape = tiny_recording_write(&folder);
    const char *program = getenv("CSCD_VOLUMES");
    return program != NULL && setenv("CSCD_TOOL", program, 1) == 0 ? 0 : -1;
}

static int remove_folder(void **state) {
    (void)state;
    body_free(&shape);
    temp_folder_remove(&folder);
    return 0;
}

/* ---- volumes ----------------------------------------------------------------------------------------- */

/* Axes, diagonals of the cube, diagonals of its faces. */
static const double directions[DIRECTIONS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1}, {1, 1, -1},
                                                 {1, -1, 1}, {-1, 1, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1},
                                                 {1, -1, 0}, {1, 0, -1}, {0, 1, -1}};

/* Which of them each kind has. */
static bool has_direction(int kind, int direction) {
    bool cube = direction >= 3 && direction < 7, face = direction >= 7;
    return direction < 3 || (cube && (kind == 2 || kind == 4)) || (face && kind >= 3);
}

/* What a triangle covers in an interval, relative to the mean of some vertices. */
typedef struct swept_triangle {
    double low[DIRECTIONS], high[DIRECTIONS], centre[3], radius;
} swept_triangle;

static void place_corners(uint32_t triangle, double *ends[2], double out[6][3]) {
    uint32_t samples = shape.vertex_count < ORIGIN_SAMPLES ? shape.vertex_count : ORIGIN_SAMPLES;
    for (int i = 0; i < 6; i++) {
        const double *positions = ends[i / 3];
        for (uint32_t k = 0; k < 3; k++) {
            double mean = 0.0;
            for (uint32_t s = 0; s < samples; s++)
                mean += positions[(size_t)s * shape.vertex_count / samples * 3 + k] / samples;
            out[i][k] = positions[shape.triangles[triangle * 3 + (uint32_t)i % 3] * 3 + k] - mean;
        }
    }
}

static swept_triangle sweep_triangle(uint32_t triangle, double *ends[2]) {
    swept_triangle out = {.radius = 0.0};
    double corners[6][3];
    place_corners(triangle, ends, corners);
    for (int d = 0; d < DIRECTIONS; d++) {
        out.low[d] = INFINITY;
        out.high[d] = -INFINITY;
        for (int i = 0; i < 6; i++) {
            double at = 0.0;
            for (int k = 0; k < 3; k++) at += directions[d][k] * corners[i][k];
            out.low[d] = fmin(out.low[d], at);
            out.high[d] = fmax(out.high[d], at);
        }
    }
    for (int k = 0; k < 3; k++) out.centre[k] = 0.5 * (out.low[k] + out.high[k]);
    for (int i = 0; i < 6; i++) {
        double square = 0.0;
        for (int k = 0; k < 3; k++) square += pow(corners[i][k] - out.centre[k], 2.0);
        out.radius = fmax(out.radius, sqrt(square));
    }
    return out;
}

static bool volumes_overlap(int kind, const swept_triangle *a, const swept_triangle *b, double margin) {
    if (kind == 0) {
        double square = 0.0;
        for (int k = 0; k < 3; k++) square += pow(a->centre[k] - b->centre[k], 2.0);
        return sqrt(square) <= a->radius + b->radius + margin;
    }
    for (int d = 0; d < DIRECTIONS; d++) {
        if (has_direction(kind, d) && (a->high[d] + margin < b->low[d] || b->high[d] + margin < a->low[d]))
            return false;
    }
    return true;
}

static bool share_vertex(uint32_t a, uint32_t b) {
    for (uint32_t i = 0; i < 9; i++) {
        if (shape.triangles[a * 3 + i / 3] == shape.triangles[b * 3 + i % 3]) return true;
    }
    return false;
}

/* How many pairs a kind must leave in an interval at least, and may leave at most. */
typedef struct pair_bounds {
    double least[KINDS], most[KINDS];
} pair_bounds;

static void add_interval(int interval, pair_bounds *bounds) {
    double *ends[2];
    swept_triangle *swept = malloc(shape.triangle_count * sizeof *swept);
    for (int e = 0; e < 2; e++) {
        ends[e] = malloc(shape.vertex_count * sizeof(double[3]));
        assert_non_null(ends[e]);
        tiny_recording_place(&shape, interval + e, ends[e]);
    }
    assert_non_null(swept);
    for (uint32_t i = 0; i < shape.triangle_count; i++) swept[i] = sweep_triangle(i, ends);
    for (uint32_t a = 0; a < shape.triangle_count; a++) {
        for (uint32_t b = a + 1; b < shape.triangle_count; b++) {
            if (share_vertex(a, b)) continue;
            for (int kind = 0; kind < KINDS; kind++) {
                bounds->least[kind] += volumes_overlap(kind, &swept[a], &swept[b], 0.0) ? 1.0 : 0.0;
                bounds->most[kind] += volumes_overlap(kind, &swept[a], &swept[b], 1e-5) ? 1.0 : 0.0;
            }
        }
    }
    for (int e = 0; e < 2; e++) free(ends[e]);
    free(swept);
}

/* ---- tests ------------------------------------------------------------------------------------------- */

static json_node *run_program(void) {
    temp_path path = temp_file_path(&folder, "rows.json");
    EXPECT_TOOL(0, "tiny", "--data", folder.path, "--cache", folder.path, "--json", path.text);
    return json_node_read_file(path.text);
}

TEST(pairs_are_those_of_the_volumes) {
    pair_bounds bounds = {{0}, {0}};
    for (int i = 0; i < INTERVALS; i++) add_interval(i, &bounds);
    json_node *json = run_program();
    const json_node *rows = json_node_member(json, "rows");
    for (size_t kind = 0; kind < KINDS; kind++) {
        const json_node *row = json_node_item(rows, kind);
        double pairs = json_node_number(row, "pairs") * INTERVALS;
        assert_string_equal(json_node_string(row, "method"), "none");
        if (pairs < bounds.least[kind] - 1e-3 || pairs > bounds.most[kind] + 1e-3)
            fail_msg("%s: %g pairs, expected %g to %g", json_node_string(row, "volume"), pairs,
                     bounds.least[kind], bounds.most[kind]);
    }
    json_node_free(json);
}

TEST(rows_have_all_columns) {
    static const char *const names[KINDS] = {"sphere", "box", "14-DOP", "18-DOP", "26-DOP"};
    static const char *const methods[METHODS] = {"none", "single", "charge"};
    static const char *const numbers[] = {"tests",     "pairs",       "refit_ms",
                                          "search_ms", "filtered_ms", "direct_ms"};
    json_node *json = run_program();
    const json_node *rows = json_node_member(json, "rows");
    assert_int_equal(rows->count, METHODS * KINDS);
    for (size_t i = 0; i < rows->count; i++) {
        const json_node *row = json_node_item(rows, i), *none = json_node_item(rows, i % KINDS);
        assert_string_equal(json_node_string(row, "method"), methods[i / KINDS]);
        assert_string_equal(json_node_string(row, "volume"), names[i % KINDS]);
        assert_true(json_node_number(row, "contacts") > 0.0);
        assert_true(json_node_number(row, "contacts") == json_node_number(none, "contacts"));
        assert_true(json_node_number(row, "adjacent") <= json_node_number(none, "adjacent"));
        assert_true(json_node_number(row, "tests") <= json_node_number(none, "tests"));
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
            assert_true(json_node_number(row, numbers[k]) > 0.0);
    }
    assert_true(strlen(json_node_string(json_node_member(json, "provenance"), "commit")) > 0);
    json_node_free(json);
}

TEST(wrong_arguments_are_named) {
    static const char *const wrong[][3] = {{"--no-such-option", NULL, "--no-such-option is no option"},
                                           {"--threads", "2", "--threads is no option"},
                                           {"--simd", NULL, "--simd wants a value"},
                                           {"--simd", "mmx", "mmx is no level of instructions"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tool_run run = RUN_TOOL(wrong[i][0], wrong[i][1]);
        assert_int_equal(run.code, 2);
        assert_non_null(strstr(run.error, wrong[i][2]));
        assert_non_null(strstr(run.error, "usage: volumes"));
        tool_run_free(&run);
    }
}

AROUND_ALL(make_folder, remove_folder)
