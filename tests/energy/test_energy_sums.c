/* Sums of energies over lists of a detector: over both forms of a list, along motions on which pairs change their kinds, in
 * matrices, and by any number of threads. */
#include "cscd/cscd.h"
#include "tests/support/random.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene moment; /* large; one test at a time */

/* ---- sums ------------------------------------------------------------------------------------------------ */

/* The energy of a scene at its x0, with all that can be asked for. */
typedef struct whole_sum {
    cscd_energy_sum sum;
    cscd_energy_pattern pattern;
    item_list items;
    double gradient[SCENE_VERTICES_MAX * 3];
    double *blocks, *matrix;
} whole_sum;

static cscd_energy_options options_with(double reach) {
    cscd_energy_options options = cscd_energy_defaults();
    options.reach = reach;
    return options;
}

static void *zeroed_memory(size_t count, size_t size) {
    void *memory = calloc(count + 1, size);
    assert_non_null(memory);
    return memory;
}

static whole_sum *sum_wholly(const rig *r, cscd_energy *energy, const cscd_energy_options *options,
                             cscd_near_form form) {
    whole_sum *w = zeroed_memory(1, sizeof *w);
    w->items = find_items(r, moment.x0, options->reach, form);
    const cscd_proximities list = {w->items.items, w->items.count};
    expect_ok(cscd_energy_make_pattern(energy, &list, NULL, &w->pattern));
    w->blocks = zeroed_memory(144 * list.count, sizeof *w->blocks);
    w->matrix = zeroed_memory(9 * w->pattern.block_count, sizeof *w->matrix);
    const cscd_energy_targets targets = {
        .gradient = w->gradient, .blocks = w->blocks, .matrix = w->matrix, .pattern = &w->pattern};
    expect_ok(cscd_energy_evaluate(energy, &list, CSCD_DOUBLES(moment.x0, moment.vertex_count), options,
                                   &targets, &w->sum));
    return w;
}

static void free_sum(whole_sum *w) {
    free(w->items.items);
    free(w->blocks);
    free(w->matrix);
    free(w);
}

static cscd_energy *energy_of(const rig *r) {
    cscd_energy *energy;
    expect_ok(cscd_energy_create(r->context, r->mesh, &energy));
    return energy;
}

/* ---- both forms of a list ---------------------------------------------------------------------------------- */

/* A fan of eight triangles around vertex 0, folded up and down, and a small triangle above it, whose lowest corner is
 * vertex 9. */
static void make_fan(scene *s) {
    s->vertex_count = 12;
    s->triangle_count = 9;
    memset(s->x0, 0, sizeof s->x0);
    for (uint32_t i = 0; i < 8; i++) {
        double angle = 0.25 * 3.141592653589793 * i;
        const double rim[3] = {cos(angle), sin(angle), i % 2 == 0 ? 0.2 : -0.1};
        const uint32_t corners[3] = {0, 1 + i, 1 + (i + 1) % 8};
        memcpy(s->x0 + 3 + 3 * i, rim, sizeof rim);
        memcpy(s->triangles + 3 * i, corners, sizeof corners);
    }
    s->triangles[24] = 9, s->triangles[25] = 10, s->triangles[26] = 11;
    memcpy(s->x1, s->x0, sizeof s->x1);
}

/* The small triangle moves over the fan, along a circle and across the middle, and its upper edge turns. */
static void place_on_fan(scene *s, double time) {
    double angle = 6.3 * time, far = 0.7 * cos(3.0 * angle), turn = 5.0 * angle;
    const double low[3] = {far * cos(angle), far * sin(angle), 0.25};
    for (size_t k = 0; k < 3; k++) s->x0[27 + k] = s->x0[30 + k] = s->x0[33 + k] = low[k];
    s->x0[30] += 0.4 * cos(turn), s->x0[31] += 0.4 * sin(turn), s->x0[32] += 0.01;
    s->x0[33] -= 0.4 * sin(turn), s->x0[34] += 0.4 * cos(turn), s->x0[35] += 0.3;
}

static double largest_difference(const double *a, const double *b, size_t count) {
    double most = 0.0;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

/* The pairs pass from faces to edges and vertices some hundred times. Value and gradient of both forms are the same, and neither
 * jumps: over a step of 1/20000 of the path they change by a small share of their size. Differences of values along the path
 * are the gradient's. */
TEST(sums_go_on_over_every_switch) {
    enum { MOMENTS = PACED(20000, 5000) };
    make_fan(&moment);
    for (int with_rest = 0; with_rest < 2; with_rest++) {
        rig r = near_rig(&moment, 1);
        cscd_energy *energy = energy_of(&r);
        cscd_energy_options options = options_with(0.35);
        double before = 0.0, gradient[36] = {0.0}, x[36], jump = 0.0, turn = 0.0, error = 0.0, most = 0.0,
               steepest = 0.0;
        size_t switches = 0, count = 0;
        if (with_rest == 1) {
            place_on_fan(&moment, 0.1);
            set_rest(&r, moment.x0);
        }
        for (int i = 0; i <= MOMENTS; i++) {
            place_on_fan(&moment, i / (double)MOMENTS);
            whole_sum *pairs = sum_wholly(&r, energy, &options, CSCD_NEAR_PAIRS);
            whole_sum *items = sum_wholly(&r, energy, &options, CSCD_NEAR_UNIQUE);
            assert_true(fabs(pairs->sum.value - items->sum.value) <= 1e-11 * pairs->sum.value);
            steepest = fmax(steepest, largest_difference(items->gradient, (double[36]){0.0}, 36));
            assert_true(largest_difference(pairs->gradient, items->gradient, 36) <= 1e-10 * (steepest + 1.0));
            if (i > 0) {
                double expected = 0.0;
                for (int k = 0; k < 36; k++)
                    expected += 0.5 * (gradient[k] + items->gradient[k]) * (moment.x0[k] - x[k]);
                error = fmax(error, fabs(items->sum.value - before - expected));
                jump = fmax(jump, fabs(items->sum.value - before));
                turn = fmax(turn, largest_difference(gradient, items->gradient, 36));
                switches += count != items->sum.active;
            }
            count = items->sum.active;
            most = fmax(most, items->sum.value);
            before = items->sum.value;
            memcpy(gradient, items->gradient, sizeof gradient);
            memcpy(x, moment.x0, sizeof x);
            free_sum(pairs);
            free_sum(items);
        }
        print_message(
            "  %zu switches; at most %.3g, jumps by %.2g, off by %.2g; gradient at most %.3g, jumps by %.2g\n",
            switches, most, jump, error, steepest, turn);
        assert_true(switches > 100 && jump < PACED(0.02, 0.08) * most && turn < PACED(0.1, 0.4) * steepest &&
                    error < PACED(1e-4, 2e-3) * most);
        cscd_energy_destroy(energy);
        rig_destroy(&r);
    }
}

/* ---- matrices -------------------------------------------------------------------------------------------- */

/* Adds the blocks of the items to a full matrix. */
static double *full_matrix(const whole_sum *w, size_t rows) {
    double *full = zeroed_memory(rows * rows, sizeof *full);
    for (size_t i = 0; i < w->items.count; i++) {
        const uint32_t *v = w->items.items[i].vertices;
        for (size_t r = 0; r < 12; r++) {
            for (size_t c = 0; c < 12; c++)
                full[(3 * v[r / 3] + r % 3) * rows + 3 * v[c / 3] + c % 3] += w->blocks[144 * i + 12 * r + c];
        }
    }
    return full;
}

static double block_entry(const whole_sum *w, bool scalar_rows, uint32_t row, size_t block, size_t r,
                          size_t c) {
    size_t first = w->pattern.rows[row], length = w->pattern.rows[row + 1] - first;
    if (!scalar_rows) return w->matrix[9 * block + 3 * r + c];
    return w->matrix[9 * first + 3 * length * r + 3 * (block - first) + c];
}

static void compare_matrix(const whole_sum *w, const double *full, bool scalar_rows, double factor) {
    size_t rows = 3 * (size_t)moment.vertex_count;
    double *left = zeroed_memory(rows * rows, sizeof *left);
    memcpy(left, full, rows * rows * sizeof *left);
    for (uint32_t v = 0; v < moment.vertex_count; v++) {
        for (size_t b = w->pattern.rows[v]; b < w->pattern.rows[v + 1]; b++) {
            for (size_t i = 0; i < 9; i++) {
                double *entry = &left[(3 * v + i / 3) * rows + 3 * w->pattern.columns[b] + i % 3];
                assert_true(fabs(block_entry(w, scalar_rows, v, b, i / 3, i % 3) - factor * *entry) <=
                            1e-10 * (fabs(*entry) + 1.0));
                *entry = 0.0;
            }
        }
    }
    for (size_t i = 0; i < rows * rows; i++) assert_true(left[i] == 0.0);
    free(left);
}

TEST(matrices_are_sums_of_blocks) {
    static const scene_family families[] = {SCENE_FOLDED_SHEET, SCENE_TWO_SPHERES, SCENE_SOUP};
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        scene_make(families[f], 5, &moment);
        rig r = near_rig(&moment, 1);
        cscd_energy *energy = energy_of(&r);
        cscd_energy_options options = options_with(0.4);
        options.law = CSCD_ENERGY_QUADRATIC;
        whole_sum *w = sum_wholly(&r, energy, &options, CSCD_NEAR_UNIQUE);
        double *full = full_matrix(w, 3 * (size_t)moment.vertex_count),
               once[2] = {w->gradient[0], w->sum.value};
        assert_true(w->sum.active > 10 && w->sum.infinite == 0 && w->sum.first == SIZE_MAX);
        compare_matrix(w, full, false, 1.0);

        const cscd_proximities list = {w->items.items, w->items.count};
        cscd_energy_targets targets = {
            .gradient = w->gradient, .matrix = w->matrix, .pattern = &w->pattern, .add = true};
        expect_ok(cscd_energy_evaluate(energy, &list, CSCD_DOUBLES(moment.x0, moment.vertex_count), &options,
                                       &targets, &w->sum));
        compare_matrix(w, full, false, 2.0);
        assert_true(fabs(w->gradient[0] - 2.0 * once[0]) <= 1e-12 * fabs(once[0]) && w->sum.value == once[1]);
        targets.add = false;
        targets.scalar_rows = true;
        expect_ok(cscd_energy_evaluate(energy, &list, CSCD_DOUBLES(moment.x0, moment.vertex_count), &options,
                                       &targets, &w->sum));
        compare_matrix(w, full, true, 1.0);
        free(full);
        free_sum(w);
        cscd_energy_destroy(energy);
        rig_destroy(&r);
    }
}

/* A pattern that is united with another one has the blocks of both. */
TEST(patterns_are_united) {
    make_fan(&moment);
    place_on_fan(&moment, 0.1);
    rig r = near_rig(&moment, 1);
    cscd_energy *energy = energy_of(&r);
    const size_t rows[13] = {0, 0, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2};
    const uint32_t columns[2] = {5, 8};
    const cscd_energy_pattern others = {rows, columns, 2};
    const cscd_proximities none = {NULL, 0};
    cscd_energy_pattern pattern;
    expect_ok(cscd_energy_make_pattern(energy, &none, &others, &pattern));
    assert_int_equal(pattern.block_count, 14);
    assert_true(pattern.rows[1] == 1 && pattern.rows[2] == 4 && pattern.rows[12] == 14);
    assert_true(pattern.columns[1] == 1 && pattern.columns[2] == 5 && pattern.columns[3] == 8);
    cscd_energy_destroy(energy);
    rig_destroy(&r);
}

/* ---- threads ----------------------------------------------------------------------------------------------- */

TEST(sums_are_the_same_for_any_number_of_threads) {
    scene_make(SCENE_NOISY_SPHERE, 3, &moment);
    whole_sum *first = NULL;
    cscd_energy_options options = options_with(0.5);
    for (uint32_t threads = 1; threads <= 7; threads += 3) {
        rig r = near_rig(&moment, threads);
        cscd_energy *energy = energy_of(&r);
        whole_sum *w = sum_wholly(&r, energy, &options, CSCD_NEAR_PAIRS);
        assert_true(w->items.count > 2000); /* several rounds */
        if (first != NULL) {
            assert_memory_equal(&first->sum, &w->sum, sizeof w->sum);
            assert_memory_equal(first->gradient, w->gradient, sizeof w->gradient);
            assert_memory_equal(first->matrix, w->matrix, 9 * w->pattern.block_count * sizeof *w->matrix);
            free_sum(w);
        } else {
            first = w;
        }
        cscd_energy_destroy(energy);
        rig_destroy(&r);
    }
    free_sum(first);
}

/* ---- what is infinite --------------------------------------------------------------------------------------- */

/* Two triangles that touch: the barrier is infinite and counts no derivatives; a penalty goes on. */
TEST(a_touch_is_infinite_for_barriers_alone) {
    scene_two_triangles(&moment, 0.0);
    rig r = near_rig(&moment, 1);
    cscd_energy *energy = energy_of(&r);
    cscd_energy_options options = options_with(0.1);
    whole_sum *w = sum_wholly(&r, energy, &options, CSCD_NEAR_UNIQUE);
    assert_true(w->sum.value == INFINITY && w->sum.infinite > 0 && w->sum.first < w->items.count);
    assert_true(w->sum.least == 0.0);
    for (uint32_t i = 0; i < 18; i++) assert_true(w->gradient[i] == 0.0);
    free_sum(w);
    options.law = CSCD_ENERGY_QUADRATIC;
    w = sum_wholly(&r, energy, &options, CSCD_NEAR_UNIQUE);
    assert_true(w->sum.value > 0.0 && w->sum.value < INFINITY && w->sum.infinite == 0);
    for (uint32_t i = 0; i < 18; i++) assert_true(isfinite(w->gradient[i]));
    free_sum(w);
    cscd_energy_destroy(energy);
    rig_destroy(&r);
}

/* A vertex above a half-space, and one behind it: the height counts. */
TEST(half_spaces_push_along_their_normals) {
    const double normal[3] = {0.0, 0.0, 2.0};
    const cscd_object_desc objects[2] = {cscd_object_of_points(2), cscd_object_half_space(normal)};
    const double x[9] = {0.3, 0.1, 0.25, -1.0, 2.0, -0.5, 0.0, 0.0, 0.0};
    rig r = rig_of_objects(context_of(1, NULL), objects, 2, NULL, NULL);
    cscd_energy *energy = energy_of(&r);
    cscd_energy_options options = options_with(1.0);
    options.law = CSCD_ENERGY_QUADRATIC;
    cscd_proximities near;
    cscd_energy_sum sum;
    double gradient[9], blocks[2 * 144];
    cscd_energy_targets targets = {.gradient = gradient, .blocks = blocks};
    expect_ok(cscd_detector_find_near(r.detector, CSCD_DOUBLES(x, 3), 1.0, CSCD_NEAR_UNIQUE, &near));
    assert_int_equal(near.count, 2);
    expect_ok(cscd_energy_evaluate(energy, &near, CSCD_DOUBLES(x, 3), &options, &targets, &sum));
    assert_true(fabs(sum.value - 0.5 * (0.75 * 0.75 + 1.5 * 1.5)) < 1e-14 && sum.least == -0.5);
    assert_true(gradient[2] == -0.75 && gradient[5] == -1.5 && gradient[8] == 2.25);
    assert_true(blocks[2 * 12 + 2] == 1.0 && blocks[2 * 12 + 5] == -1.0 && blocks[0] == 0.0);
    cscd_energy_destroy(energy);
    rig_destroy(&r);
}
